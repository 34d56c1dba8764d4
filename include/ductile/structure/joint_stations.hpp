// SPDX-License-Identifier: MIT
//
// Where the joints of a member sit, and of how much of its length each one is the flexibility.
//
// A chain of rigid pieces with a joint of k = E I/l_i at the station x_i turns under the moments
// M(x) by Σ M(x_i) m(x_i) l_i/(E I) where the elastic member turns by ∫ M m dx/(E I), m the moment
// of a unit load: the stations and lengths are a quadrature rule. With those of Gauss a few pieces
// have the stiffness of the elastic member. An end that is jointed is a station, so the rule is
//
//   ends jointed        rule       exact to degree   pieces for end forces (2), uniform load (3)
//   none                Legendre   2n - 1            3, 3
//   one                 Radau      2n - 2            2, 3
//   both                Lobatto    2n - 3            2, 2          (Simpson's: 1/6, 2/3, 1/6)
//
// for n stations. Lengths add up to that of the member, so stretch, twist and bending by a constant
// moment are right with any. `equal`: pieces of one length; a joint stands for the halves of the
// pieces beside it, and for all of a last piece whose far end has no joint.
//
// Source: M. H. Scott, G. L. Fenves (2006), Plastic hinge integration methods for force-based
// beam-column elements, J. Struct. Eng. 132(2), 244-252; Abramowitz and Stegun (1964), 25.4.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace ductile {

enum class JointSpacing {
    gauss, ///< few pieces as stiff as the elastic member
    equal  ///< pieces of one length
};

/// One joint of a member.
struct JointStation {
    double at = 0;    ///< from the member's start, as a share of its length, in [0, 1]
    double share = 0; ///< of the member's length that it stands for, > 0

    bool operator==(const JointStation&) const = default;
};

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

inline std::vector<JointStation> gauss_stations(int inner, bool at_start, bool at_end) {
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

/// In order along a member of `pieces` >= 1 rigid pieces: pieces - 1, and one more at every jointed
/// end. Cost O(pieces²).
[[nodiscard]] inline std::vector<JointStation> joint_stations(int pieces, bool start_jointed,
                                                              bool end_jointed,
                                                              JointSpacing spacing) {
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
