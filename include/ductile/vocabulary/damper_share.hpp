// SPDX-License-Identifier: MIT
//
// A damper in a step: which of the velocities before and after it has.
//
//   m (u' - u) = -d h (θ u' + (1 - θ) u)
//
// θ = 1/2 is of second order. Where d h > 2 m it would turn the velocity round, and two of them do
// so to and fro from step to step: θ = 1 - m/(d h), with which u' = 0.
#pragma once

#include <concepts>

namespace ductile {

/// θ [-]; `damps`: d h, `mass`: m, 0 where it is not known [kg | kg m²].
template <std::floating_point S>
[[nodiscard]] constexpr S damper_share(S damps, S mass) noexcept {
    return damps > 2 * mass ? 1 - mass / damps : S(0.5);
}

} // namespace ductile
