// SPDX-License-Identifier: MIT
//
// The point of an ellipsoid closest to another, in a diagonal metric:
//
//   minimise 1/2 Σ d_i (x_i - y_i)²   where   Σ (x_i/P_i)² <= 1
//
// Outside, x_i = d_i y_i / (d_i + μ/P_i²) with the one μ > 0 for which Σ (x_i/P_i)² = 1. With
// a_i = |P_i d_i y_i| and e_i = d_i P_i² that is
//
//   g(μ) = Σ (a_i/(e_i + μ))² = 1,   max(max(a_i - e_i), |a| - max e) <= μ <= |a| - min e
//
// and g^-1/2 is concave and rising, so that Newton on it from the left end never passes the root.
//
// Limit cases: one axis: clamp; y inside: y itself and μ = 0; a semi-axis of zero: x_i = 0.
//
// Source: the equation of one unknown as in Moré & Sorensen (1983), doi:10.1137/0904038.
#pragma once

#include <algorithm>
#include <cmath>

#include "ductile/vocabulary/vector.hpp"

namespace ductile::solve {

struct EllipsoidReturn {
    Vector6<double> point = Vector6<double>::Zero(); ///< x
    double multiplier = 0;                           ///< μ, 0: y was inside
};

/// Of the first `count` entries; `y` finite, `metric` > 0, `semi_axes` >= 0. Cost: 2 to 4 Newton
/// steps.
[[nodiscard]] inline EllipsoidReturn closest_on_ellipsoid(const Vector6<double>& y,
                                                          const Vector6<double>& metric,
                                                          const double* semi_axes,
                                                          int count) noexcept {
    constexpr int most = 60;
    constexpr double exact = 2e-15;
    EllipsoidReturn result;
    double a[6], e[6];
    double inside = 0, square = 0, low = 0, least = 0, largest = 0;
    bool flat = false; // a semi-axis of zero in the way
    for (int i = 0; i < count; ++i) {
        const double p = semi_axes[i];
        a[i] = std::abs(p * metric[i] * y[i]);
        e[i] = metric[i] * p * p;
        if (p > 0) {
            inside += (y[i] / p) * (y[i] / p);
        } else {
            flat = flat || y[i] != 0;
        }
        square += a[i] * a[i];
        low = std::max(low, a[i] - e[i]);
        least = i == 0 ? e[i] : std::min(least, e[i]);
        largest = std::max(largest, e[i]);
    }
    if (inside <= 1 && !flat) {
        result.point = y;
        return result;
    }
    const double size = std::sqrt(square);
    if (!(size > 0)) return result; // all that is asked for is along semi-axes of zero
    double high = size - least;
    low = std::max({low, size - largest, 0.0});
    double mu = low;
    for (int step = 0; step < most; ++step) {
        double g = 0, slope = 0;
        for (int i = 0; i < count; ++i) {
            if (!(a[i] > 0)) continue;
            const double share = a[i] / (e[i] + mu);
            g += share * share;
            slope += share * share / (e[i] + mu);
        }
        const double gauge = std::sqrt(g);
        if (!(std::abs(gauge - 1) > exact)) break;
        (gauge > 1 ? low : high) = mu;
        double next = mu + (gauge - 1) * g / slope;
        if (!(next > low && next < high)) next = 0.5 * (low + high);
        if (!(std::abs(next - mu) > 1e-16 * mu)) break;
        mu = next;
    }
    for (int i = 0; i < count; ++i) {
        const double p = semi_axes[i];
        result.point[i] = a[i] > 0 ? metric[i] * y[i] * p * p / (e[i] + mu) : 0;
    }
    result.multiplier = mu;
    return result;
}

} // namespace ductile::solve
