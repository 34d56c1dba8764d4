// SPDX-License-Identifier: MIT
//
// An arm that lies on a floor, its hinge at the floor's edge of its end, and is thrown up about it.
#pragma once

#include <cmath>

namespace ductile::test {

struct ThrownArm {
    static constexpr double mass = 6, length = 0.8,
                            half = 0.04;                      ///< [kg], [m], of its thickness [m]
    static constexpr double strength = 3, g = 9.81, spin = 4; ///< [N m], [m/s²], at first [rad/s]
    static constexpr double inertia = mass * (length * length + 4 * half * half) / 3; ///< [kg m²]

    /// R 2 θ, of its way up to where R θ + M g rise(θ) = I ω²/2, and down again [J].
    [[nodiscard]] static double work() {
        double low = 0, high = 1.5;
        for (int i = 0; i < 60; ++i) {
            const double angle = (low + high) / 2;
            const double rise = length / 2 * std::sin(angle) + half * (std::cos(angle) - 1);
            const double needs = strength * angle + mass * g * rise;
            (needs < inertia * spin * spin / 2 ? low : high) = angle;
        }
        return 2 * strength * low;
    }
};

} // namespace ductile::test
