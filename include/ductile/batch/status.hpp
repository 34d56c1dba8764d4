// SPDX-License-Identifier: MIT
//
// One byte per joint of a batch: the outcome of its last step and whether it ended at a bound. It
// is both an output of the step and the two flags of the state, because a joint is broken exactly
// where its outcome says so.
//
//   bits 0, 1   Outcome of the last step
//   bit 2       the last step ended at a bound (OneAxisState::flowing)
//
// Zero is a joint that has not moved yet.
#pragma once

#include <cstdint>

#include "ductile/vocabulary/row.hpp"

namespace ductile {

using BatchStatus = std::uint8_t;

inline constexpr unsigned outcome_bits = 3;
inline constexpr unsigned flowing_bit = 4;

[[nodiscard]] constexpr BatchStatus batch_status(Outcome outcome, bool flowing) noexcept {
    return BatchStatus(unsigned(outcome) | (flowing ? flowing_bit : 0u));
}
[[nodiscard]] constexpr Outcome outcome_of(BatchStatus status) noexcept {
    return Outcome(status & outcome_bits);
}
[[nodiscard]] constexpr bool is_flowing(BatchStatus status) noexcept {
    return (status & flowing_bit) != 0;
}
[[nodiscard]] constexpr bool is_broken(BatchStatus status) noexcept {
    return outcome_of(status) == Outcome::broken;
}

static_assert(unsigned(Outcome::unreliable) <= outcome_bits &&
              batch_status(Outcome::elastic, false) == 0);
static_assert(is_broken(batch_status(Outcome::broken, true)));

} // namespace ductile
