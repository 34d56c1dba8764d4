// SPDX-License-Identifier: MIT
#include "ductile/joint/break_release.hpp"

#include <catch2/catch.hpp>

#include <cmath>

#include "core/joint/any_body.hpp"
#include "support/property.hpp"

using namespace ductile;
using any_body::Body;
using any_body::number;
using any_body::V3;

TEST_CASE("a release gives exactly its energy to the motion along its axis", "[joint][release]") {
    test::prop("any two bodies, joint, axis and energy", [] {
        Body a = Body::any(), b = Body::any();
        Vector6<double> axis = Vector6<double>::Zero();
        axis.segment<3>(*rc::gen::inRange(0, 2) * 3) =
            V3(number(1, 2), number(-2, 2), number(-2, 2)).normalized();
        const double energy = number(0, 50);
        const double before = a.kinetic() + b.kinetic();
        const Vector6<double> twist = a.twist() - b.twist();
        const V3 momentum = a.mass * a.linear + b.mass * b.linear;

        const auto release = break_release(a.at_joint(), b.at_joint(), axis, twist, energy);
        a.change(release.a);
        b.change(release.b);

        RC_ASSERT(std::abs(a.kinetic() + b.kinetic() - before - energy) < 1e-9 * (1 + before));
        const Vector6<double> change = a.twist() - b.twist() - twist;
        RC_ASSERT((change - axis * axis.dot(change)).norm() < 1e-9 * (1 + change.norm()));
        RC_ASSERT((a.mass * a.linear + b.mass * b.linear - momentum).norm() < 1e-9);
    });
}

TEST_CASE("a free rotor on its own axis takes a release as u'^2 = u^2 + 2 E/I",
          "[joint][release]") {
    BodyAtJoint<double> rotor{1.0, Matrix3<double>::Identity() / 2, V3::Zero()};
    Vector6<double> axis = Vector6<double>::Zero(), twist = Vector6<double>::Zero();
    axis[5] = 1;
    twist[5] = -3;
    const auto release = break_release(rotor, BodyAtJoint<double>{}, axis, twist, 7.0);
    CHECK(-3 + release.a.angular.z() == Approx(-4).epsilon(1e-14)); // √(9 + 2·7/2) = 4
    CHECK(release.b.angular.norm() == 0);
}

TEST_CASE("two bodies that cannot move are left alone", "[joint][release]") {
    const BodyAtJoint<double> fixed;
    Vector6<double> axis = Vector6<double>::Zero();
    axis[2] = 1;
    const auto impulse = release_impulse(fixed, fixed, axis, Vector6<double>(axis * 2), 5.0);
    CHECK(impulse.linear.norm() == 0);
    CHECK(impulse.angular.norm() == 0);
}
