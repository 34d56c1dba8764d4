// SPDX-License-Identifier: MIT
//
// Roots of functions of one variable inside a bracket, without failure: both searches end after a
// bounded number of evaluations, never leave the bracket, and land on the root to round-off where
// the function is monotone.
//
// Source: Press et al. (2007), Numerical Recipes, 3rd ed., section 9.4 (Newton with bisection);
// Dowell and Jarratt (1971), BIT 11, 168-174 (the Illinois rule), with a bisection every third step
// so that the bracket shrinks at a known rate.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>

namespace ductile {

template <std::floating_point S>
struct ValueAndSlope {
    S value = 0;
    S slope = 0;
};

/// Root of f between `low` and `high`, where f(low) >= 0 >= f(high). f returns a ValueAndSlope.
/// Starts from `start` in [low, high]. Exact in one step where f is linear there.
template <std::floating_point S, class F>
[[nodiscard]] S newton_root(S low, S high, S start, F&& f) noexcept {
    constexpr int most = 200;
    S x = start;
    S last_step = 2 * (high - low);
    for (int i = 0; i < most; ++i) {
        const ValueAndSlope<S> at = f(x);
        if (at.value == 0) return x;
        (at.value > 0 ? low : high) = x;
        S next = x - at.value / at.slope;
        const bool inside = next >= low && next <= high;
        // Newton that does not halve its steps is lost: bisect
        if (!inside || std::abs(next - x) > std::abs(last_step) / 2) next = low + (high - low) / 2;
        last_step = next - x;
        x = next;
        const S resolution = std::numeric_limits<S>::epsilon() * std::abs(x);
        if (std::abs(last_step) <= resolution || high - low <= resolution) return x;
    }
    return x;
}

/// Root of f between `a` and `b`, where f(a) and f(b) do not have the same sign, to within
/// `resolution` >= 0 or round-off.
template <std::floating_point S, class F>
[[nodiscard]] S bracketed_root(S a, S b, S resolution, F&& f) noexcept {
    constexpr int most = 300;
    S fa = f(a);
    S fb = f(b);
    if (fa == 0) return a;
    for (int i = 0; i < most && fb != 0; ++i) {
        const S width = std::abs(b - a);
        const S round_off =
            2 * std::numeric_limits<S>::epsilon() * std::max(std::abs(a), std::abs(b));
        if (width <= std::max(resolution, round_off)) break;
        S x = i % 3 == 2 ? a + (b - a) / 2 : b - fb * (b - a) / (fb - fa);
        if (!(x > std::min(a, b) && x < std::max(a, b))) x = a + (b - a) / 2;
        const S fx = f(x);
        if ((fx > 0) == (fb > 0)) {
            fa /= 2; // the end that stays weighs half, or it would stay for good
        } else {
            a = b;
            fa = fb;
        }
        b = x;
        fb = fx;
    }
    return b;
}

} // namespace ductile
