// SPDX-License-Identifier: MIT
//
// Numbers that are not finite, for who decides by them: NaN is never larger than a limit, and
// std::max drops a NaN that comes second.
#pragma once

#include <concepts>

namespace ductile {

/// True where every number is finite, without a branch.
template <std::floating_point... S>
[[nodiscard]] constexpr bool are_finite(S... numbers) noexcept {
    return ((numbers * 0) + ...) == 0;
}

/// The larger of two residuals; NaN where either is.
template <std::floating_point S>
[[nodiscard]] constexpr S worse(S a, S b) noexcept {
    return a >= b || a != a ? a : b;
}

} // namespace ductile
