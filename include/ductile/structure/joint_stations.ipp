// SPDX-License-Identifier: MIT
//
// Bodies of joint_stations.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "ductile/structure/joint_stations.hpp"

namespace ductile {

namespace detail {

/// Jacobi's polynomial of degree n for the weight (1 - x)^a (1 + x)^b, and its slope.
struct JacobiPolynomial {
    int n = 0, a = 0, b = 0; ///< a, b 0 or 1

    struct Value {
        double value, slope;
    };
    /// Abramowitz and Stegun, 22.7.1 and 22.8.1 (the slope by the recurrence's own derivative).
    [[nodiscard]] Value operator()(double x) const noexcept {
        double before = 0, before_slope = 0, p = 1, slope = 0;
        for (int k = 0; k < n; ++k) {
            const double s = 2 * k + a + b;
            const double c = 2 * (k + 1) * (k + a + b + 1.0);
            // k = 0 has no predecessor, and s may be 0 there
            const double linear = k == 0 ? (a + b + 2) / 2.0 : (s + 1) * (s + 2) / c;
            const double constant = k == 0 ? (a - b) / 2.0 : (s + 1) * (a * a - b * b) / (c * s);
            const double back = k == 0 ? 0 : 2 * (k + a) * (k + b) * (s + 2) / (c * s);
            const double next = (linear * x + constant) * p - back * before;
            const double next_slope =
                (linear * x + constant) * slope + linear * p - back * before_slope;
            before = p;
            before_slope = slope;
            p = next;
            slope = next_slope;
        }
        return {p, slope};
    }
    /// Roots, falling. Newton's method with the roots that are known divided out (Maehly), from 1:
    /// monotone, as all roots are real.
    [[nodiscard]] std::vector<double> roots() const {
        std::vector<double> found;
        constexpr int patience = 1000;
        for (int i = 0; i < n; ++i) {
            double x = 1;
            for (int step = 0; step < patience; ++step) {
                const Value p = (*this)(x);
                double slope = p.slope;
                for (const double root : found) slope -= p.value / (x - root);
                const double change = p.value / slope;
                x -= change;
                if (!(std::abs(change) > 4 * std::numeric_limits<double>::epsilon())) break;
            }
            found.push_back(x);
        }
        return found;
    }
};

DUCTILE_INLINE std::vector<JointStation> gauss_stations(int inner, bool at_start, bool at_end) {
    const JacobiPolynomial polynomial{inner, at_end ? 1 : 0, at_start ? 1 : 0};
    const int fixed = polynomial.a + polynomial.b;
    // Γ(n+a+1) Γ(n+b+1)/(Γ(n+a+b+1) n!) 2^(a+b+1), Abramowitz and Stegun, 25.4.33
    const double scale = fixed == 0 ? 2 : fixed == 1 ? 4 : 8 * (inner + 1.0) / (inner + 2);
    std::vector<double> roots = polynomial.roots();
    std::reverse(roots.begin(), roots.end());
    std::vector<JointStation> result;
    if (at_start) result.push_back({});
    double rest = 1;
    for (const double x : roots) {
        const double slope = polynomial(x).slope;
        double weight = scale / ((1 - x * x) * slope * slope);
        if (at_end) weight /= 1 - x;
        if (at_start) weight /= 1 + x;
        result.push_back({(1 + x) / 2, weight / 2});
        rest -= weight / 2;
    }
    if (at_end) result.push_back({.at = 1});
    // two ends are alike
    if (at_start) result.front().share = rest / fixed;
    if (at_end) result.back().share = rest / fixed;
    return result;
}

} // namespace detail

DUCTILE_INLINE std::vector<JointStation> joint_stations(int pieces, bool start_jointed,
                                                        bool end_jointed, JointSpacing spacing) {
    if (spacing == JointSpacing::gauss) {
        return detail::gauss_stations(pieces - 1, start_jointed, end_jointed);
    }
    std::vector<JointStation> result;
    for (int i = start_jointed ? 0 : 1; i < pieces + (end_jointed ? 1 : 0); ++i) {
        result.push_back({.at = double(i) / pieces});
    }
    double from = 0;
    for (std::size_t i = 0; i < result.size(); ++i) {
        const double to = i + 1 < result.size() ? (result[i].at + result[i + 1].at) / 2 : 1;
        result[i].share = to - from;
        from = to;
    }
    return result;
}

} // namespace ductile
