// SPDX-License-Identifier: MIT
//
// The inverse of a law's work: how far a law flows for a given energy. It lets a joint count
// plastic travel by the work done on it, so that energy and travel agree whatever the step, also
// where the strength fades to zero.
//
//   work(p0, travel_after(law, p0, W)) = W     0 <= W <= work(p0, p_f)
#pragma once

#include <algorithm>
#include <limits>

#include "ductile/law/law.hpp"
#include "ductile/law/root.hpp"

namespace ductile {

/// Travel after the law has taken the work `energy` [J] from the travel `from` >= 0 [m | rad].
/// Never below `from`, never beyond the exhaustion: what does not fit is not taken. One division
/// for a law that is perfect there, else a few Newton steps. [m | rad]
template <StrengthLaw Law>
[[nodiscard]] typename Law::Scalar travel_after(const Law& law, typename Law::Scalar from,
                                                typename Law::Scalar energy) noexcept {
    using S = typename Law::Scalar;
    const S end = exhaustion(law);
    if (!(energy > 0) || from >= end) return from;
    if (end < std::numeric_limits<S>::infinity() && energy >= law.work(from, end)) return end;

    const S guess = energy / law.value(from);
    S distance = guess;
    constexpr int most = 100; // doublings: more than any strength that is not zero can need
    for (int i = 0; i < most && law.work(from, from + distance) < energy; ++i) distance *= 2;
    const S high = std::min(from + distance, end);
    return newton_root(from, high, std::min(from + guess, high), [&](S travel) noexcept {
        return ValueAndSlope<S>{energy - law.work(from, travel), -law.value(travel)};
    });
}

} // namespace ductile
