// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include <limits>

#include "ductile/joint/link.hpp"
#include "ductile/joint/one_axis_joint.hpp"
#include "ductile/law/perfect.hpp"

using namespace ductile;

namespace {

using V3 = Vector3<double>;
using Hinge = OneAxisJoint<Perfect<double>>;
constexpr double moment = 60, inertia = 2, dt = 1.0 / 60;

/// A rotor that a moment is put on from outside, as big as its hinge bears: nothing moves.
struct Held {
    BodyState<double> rotor{.inverse_mass = 1, .inverse_inertia = Matrix3<double>::Identity() / 2};
    BodyState<double> ground{};
    Link<Hinge> link{Hinge(Perfect<double>({.strength = moment})), {JointAxis::torsion}, {}, {}};

    Held() { link.start(rotor, ground); }
    /// Most of what the joint bore that it should have yielded to [J].
    double bear(double share, bool ahead = false) {
        link.prepare(rotor, ground, dt, 0, ahead);
        Vector6<double> forces = Vector6<double>::Zero();
        forces[5] = share * moment;
        link.commit_rows(rotor, ground, forces, dt);
        return link.borne_blow();
    }
};

} // namespace

TEST_CASE("what rises for one step and falls again is a blow that a rigid joint bore",
          "[joint][link]") {
    for (const double sign : {1.0, -1.0}) {
        Held held;
        held.bear(0.2 * sign);
        CHECK(held.bear(0.8 * sign) == 0);
        CHECK_FALSE(held.link.borne_error() > 0);
        const double impulse = (0.8 - 0.3) * moment * dt;
        CHECK(held.bear(0.3 * sign) == Approx(impulse * impulse / (2 * inertia)).epsilon(1e-12));
        CHECK(held.link.borne_error() > 0.04);
        CHECK(held.bear(0.3 * sign) == 0);
    }
}

TEST_CASE("a load that comes and rests, or goes, is no blow", "[joint][link]") {
    Held held;
    for (const double share : {0.0, 0.9, 0.9, 0.9, 0.1, 0.1, -0.8, -0.8, 0.0}) {
        CHECK(held.bear(share) == 0);
    }
}

TEST_CASE("what flowed has not borne", "[joint][link]") {
    Held held;
    held.bear(0);
    held.rotor.spin = V3(0, 0, 1); // it turns while its hinge is at its strength
    held.bear(-1);
    held.rotor.spin = V3::Zero();
    CHECK(held.link.totals().plastic_work > 0);
    CHECK(held.bear(0) == 0);
}

TEST_CASE("a step that is put back has borne nothing", "[joint][link]") {
    Held held;
    held.bear(0);
    held.link.keep();
    held.bear(0.9);
    held.link.put_back();
    CHECK(held.bear(0) == 0);
    CHECK(held.bear(0) == 0);
}

TEST_CASE("a joint that goes over to frames has borne nothing", "[joint][link]") {
    Held held;
    held.bear(0);
    held.bear(0.9);
    held.bear(0);
    CHECK(held.link.borne_error() > 0);
    CHECK(held.bear(0, true) == 0);
    CHECK_FALSE(held.link.borne_error() > 0);
}
