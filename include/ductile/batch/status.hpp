// SPDX-License-Identifier: MIT
//
// One byte per joint of a batch: the outcome of its last step, whether it ended at a bound, and
// what happened in it for the first time. It is both an output of the step and the two flags of the
// state, because a joint is broken exactly where its outcome says so.
//
//   bits 0, 1   Outcome of the last step
//   bit 2       the last step ended at a bound (OneAxisState::flowing)
//   bit 3       the joint began to yield in the last step (Step::first_yield)
//   bit 4       it broke in the last step (Step::fracture)
//
// Zero is a joint that has not moved yet.
#pragma once

#include <cstdint>

#include "ductile/vocabulary/row.hpp"

namespace ductile {

using BatchStatus = std::uint8_t;

inline constexpr unsigned outcome_bits = 3;
inline constexpr unsigned flowing_bit = 4;
inline constexpr unsigned first_yield_bit = 8;
inline constexpr unsigned fracture_bit = 16;

[[nodiscard]] constexpr BatchStatus batch_status(Outcome outcome, bool flowing) noexcept {
    return BatchStatus(unsigned(outcome) | (flowing ? flowing_bit : 0u));
}
[[nodiscard]] constexpr Outcome outcome_of(BatchStatus status) noexcept {
    return Outcome(status & outcome_bits);
}
[[nodiscard]] constexpr bool is_flowing(BatchStatus status) noexcept {
    return (status & flowing_bit) != 0;
}
[[nodiscard]] constexpr bool began_to_yield(BatchStatus status) noexcept {
    return (status & first_yield_bit) != 0;
}
[[nodiscard]] constexpr bool has_just_broken(BatchStatus status) noexcept {
    return (status & fracture_bit) != 0;
}
[[nodiscard]] constexpr bool is_broken(BatchStatus status) noexcept {
    return outcome_of(status) == Outcome::broken;
}

static_assert(unsigned(Outcome::unreliable) <= outcome_bits &&
              batch_status(Outcome::elastic, false) == 0);
static_assert(is_broken(batch_status(Outcome::broken, true)));

} // namespace ductile
