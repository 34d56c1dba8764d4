// SPDX-License-Identifier: MIT
//
// P01. A rotor stopped by a rigid-plastic hinge: against the ground, through many turns, and
// between two free bodies on a tilted axis. α = M_p/I, t = ω0/α, θ = ω0²/(2α), E = I ω0²/2.
#include <catch2/catch.hpp>

#include <cmath>

#include "reference/expect.hpp"
#include "reference/problems/rotors.hpp"

using namespace ductile::reference;

namespace {

/// Exact discrete rest position: dt (N ω0 - α dt N (N+1)/2), N = floor(ω0/(α dt)).
double discrete_angle(const Rotor& rotor, double dt) {
    const double alpha = rotor.deceleration();
    const double n = std::floor(rotor.speed / (alpha * dt) + 1e-9);
    return dt * (n * rotor.speed - alpha * dt * n * (n + 1) / 2);
}

} // namespace

TEST_CASE("P01 a rotor stops in the closed form's angle, energy and time", "[reference][P01]") {
    expect_trends("P01a", [](double dt) { return p01_rotor({}, dt); });
    expect_trends("P01b", [](double dt) { return p01_rotor({.speed = 30}, dt); });
    expect_trends("P01c", p01_pair);
}

TEST_CASE("P01 the rest position is the exact discrete one at any step", "[reference][P01]") {
    for (const Rotor& rotor : {Rotor{}, Rotor{.speed = 30}, Rotor{.inertia = 1.7, .speed = 7.3}}) {
        for (const double dt : {1.0 / 15, 1.0 / 60, 1.0 / 240, 0.0037, 1e-3}) {
            INFO("ω0 = " << rotor.speed << ", dt = " << dt);
            const RotorEnd end = spin_down(rotor, dt);
            CHECK(end.angle == Approx(discrete_angle(rotor, dt)).epsilon(1e-9));
            CHECK(end.joint.plastic_offset == Approx(end.angle).epsilon(1e-12));
        }
    }
    // as printed
    CHECK(spin_down({}, 1.0 / 60).angle == Approx(2.416667).epsilon(1e-6));
    CHECK(spin_down({}, 1.0 / 240).angle == Approx(2.479167).epsilon(1e-6));
    CHECK(spin_down({}, 1.0 / 1000).angle == Approx(2.495).epsilon(1e-9));
}

TEST_CASE("P01 started half a step of deceleration faster, the rest position is exact",
          "[reference][P01]") {
    // symplectic Euler is leapfrog with velocities half a step late
    for (const double dt : {1.0 / 60, 1.0 / 240, 1.0 / 1000}) {
        const Rotor rotor{.speed = 10 + 20 * dt / 2};
        CHECK(spin_down(rotor, dt).angle == Approx(2.5).epsilon(1e-9));
    }
}

TEST_CASE("P01 two bodies share the momentum, whichever way their axis points",
          "[reference][P01]") {
    const double dt = 1.0 / 240;
    const PairEnd tilted = couple({}, Eigen::Vector3d(1, 2, 2) / 3, dt);
    for (const Eigen::Vector3d& axis : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 0, -1),
                                        Eigen::Vector3d(-2.0 / 7, 6.0 / 7, 3.0 / 7)}) {
        const PairEnd end = couple({}, axis, dt);
        CHECK(end.joint.plastic_offset == Approx(tilted.joint.plastic_offset).epsilon(1e-9));
        CHECK(end.joint.plastic_work == Approx(tilted.joint.plastic_work).epsilon(1e-9));
        CHECK(end.angle1 == Approx(tilted.angle1).epsilon(1e-9));
    }
    // the first runs ahead with 10 -> 4 rad/s, so its own angle is 7 rad less 6 dt/2
    CHECK(tilted.angle1 == Approx(7 - 6 * dt / 2).epsilon(1e-9));
    CHECK(tilted.angle2 == Approx(2 + 4 * dt / 2).epsilon(1e-9));
    CHECK(tilted.speed2 == Approx(4).epsilon(1e-9));
}
