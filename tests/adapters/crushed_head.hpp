// SPDX-License-Identifier: MIT
//
// What falls on a head that a plastic slider holds up sticks to it, and the slider brakes both.
#pragma once

namespace ductile::test {

/// Way of the head [m] under `mass` [kg] that falls by `fall` [m], of a slider of `strength` [N]
/// that bears more than both weigh: M v²/2 = (R - M g) s, v = √(2 g fall) m/M, M = m + m_head.
inline double crush_of_head(double mass, double head_mass, double fall, double strength, double g) {
    const double both = mass + head_mass, square = 2 * g * fall * mass * mass / (both * both);
    return square / (2 * (strength / both - g));
}

} // namespace ductile::test
