// SPDX-License-Identifier: MIT
//
// Joints, frames and exact answers for the tests of the six-axis joint. Included after the rig.
#pragma once

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

#include "ductile/ductile.hpp"
#include "support/axes_along.hpp"

namespace ductile::test {

using M3 = Matrix3<double>;
using V6 = Vector6<double>;
using Frame = JointFrame<double>;
using Six = CoupledJoint<Ellipsoid<double, 6>, Perfect<double>>;
using One = std::array<JointAxis, 1>;

inline constexpr double infinity = std::numeric_limits<double>::infinity();
/// Round-off of an exact answer: accumulated over at most some thousand steps.
inline constexpr double exact = Rig::single ? 2e-4 : 1e-9;
inline const V3 none = V3::Zero();

inline Joint one(double strength, double limit = infinity, double stiffness = infinity) {
    return Joint(Perfect<double>({.strength = strength}), TravelLimit<double>({.limit = limit}),
                 {.stiffness = stiffness});
}

inline Six six(const V6& capacity, double limit = infinity,
               const V6& stiffness = V6::Constant(infinity)) {
    return Six(Ellipsoid<double, 6>({.capacity = capacity}), Perfect<double>({.strength = 1}),
               TravelLimit<double>({.limit = limit}), {.stiffness = stiffness});
}

inline V6 capacities() {
    V6 c;
    c << 900, 700, 1200, 40, 60, 30;
    return c;
}

inline V3 sphere(double i) { return V3::Constant(i); }

inline M3 turned(double angle, const V3& axis) {
    return Eigen::AngleAxis<double>(angle, axis.normalized()).toRotationMatrix();
}

/// Axes whose z, the member's, points along `z`.
inline M3 along(const V3& z) {
    return axes_along(z);
}

/// Travel of a row that stops from speed `u` at deceleration `a`, as symplectic Euler moves it.
inline double discrete_travel(double u, double a, double dt) {
    const double n = std::floor(u / (a * dt) * (1 + 1e-12));
    return dt * (n * u - a * dt * n * (n + 1) / 2);
}

} // namespace ductile::test
