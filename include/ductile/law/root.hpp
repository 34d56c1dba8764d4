// SPDX-License-Identifier: MIT
//
// Roots of functions of one variable inside a bracket, without failure: both searches end after a
// bounded number of evaluations, never leave the bracket, and land on the root to round-off where
// the function is monotone.
//
// Source: Press et al. (2007), Numerical Recipes, 3rd ed., section 9.4 (Newton with bisection);
// Chandrupatla (1997), Advances in Engineering Software 28, 145-149 (inverse quadratic
// interpolation with bisection).
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
/// `resolution` >= 0 or round-off. Inverse quadratic steps where the last three points say that
/// they are safe, else bisection.
template <std::floating_point S, class F>
[[nodiscard]] S bracketed_root(S a, S b, S resolution, F&& f) noexcept(noexcept(f(a))) {
    constexpr int most = 300;
    S fa = f(a);
    S fb = f(b);
    if (fa == 0) return a;
    if (fb == 0) return b;
    S share = S(0.5);
    for (int i = 0; i < most; ++i) {
        const S x = a + share * (b - a);
        const S fx = f(x);
        // c: the end that is given up
        S c = b;
        S fc = fb;
        if ((fx > 0) == (fa > 0)) {
            c = a;
            fc = fa;
        } else {
            b = a;
            fb = fa;
        }
        a = x;
        fa = fx;
        const bool a_is_best = std::abs(fa) < std::abs(fb);
        const S best = a_is_best ? a : b;
        if ((a_is_best ? fa : fb) == 0) return best;
        const S round_off = 2 * std::numeric_limits<S>::epsilon() * std::abs(best);
        const S least = std::max(resolution, round_off) / std::abs(b - a);
        if (!(least < S(0.5))) return best;
        const S xi = (a - b) / (c - b);
        const S phi = (fa - fb) / (fc - fb);
        share = S(0.5);
        if (phi * phi < xi && (1 - phi) * (1 - phi) < 1 - xi) {
            share = fa / (fb - fa) * (fc / (fb - fc)) +
                    (c - a) / (b - a) * (fa / (fc - fa)) * (fb / (fc - fb));
        }
        share = std::clamp(share, least, 1 - least);
    }
    return a;
}

} // namespace ductile
