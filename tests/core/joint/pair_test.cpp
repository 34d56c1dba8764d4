// SPDX-License-Identifier: MIT
#include <rapidcheck/catch.h>
#include <catch2/catch.hpp>

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <cmath>

#include "ductile/joint/pair.hpp"

using namespace ductile;

namespace {

using V3 = Vector3<double>;

double number(int lo, int hi) { return *rc::gen::inRange(lo * 1000, hi * 1000) / 1000.0; }
V3 vector(int size) { return {number(-size, size), number(-size, size), number(-size, size)}; }

struct Body {
    double mass;
    Matrix3<double> inertia;
    V3 arm, linear, angular;

    static Body any() {
        Body body;
        body.mass = number(1, 20);
        const V3 axis = V3(number(1, 2), number(-2, 2), number(-2, 2)).normalized();
        const Matrix3<double> r = Eigen::AngleAxisd(number(-3, 3), axis).toRotationMatrix();
        body.inertia =
            r * V3(number(1, 3), number(1, 3), number(1, 3)).asDiagonal() * r.transpose();
        body.arm = vector(2);
        body.linear = vector(5);
        body.angular = vector(5);
        return body;
    }
    [[nodiscard]] BodyAtJoint<double> at_joint() const {
        return {1 / mass, inertia.inverse(), arm};
    }
    [[nodiscard]] double kinetic() const {
        return (mass * linear.squaredNorm() + angular.dot(inertia * angular)) / 2;
    }
    void change(const VelocityChange<double>& by) {
        linear += by.linear;
        angular += by.angular;
    }
    [[nodiscard]] Vector6<double> twist() const {
        Vector6<double> t;
        t << linear + angular.cross(arm), angular;
        return t;
    }
};

} // namespace

TEST_CASE("a release gives exactly its energy to the motion along its axis", "[pair]") {
    rc::prop("any two bodies, joint, axis and energy", [] {
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

TEST_CASE("a free rotor on its own axis takes a release as u'^2 = u^2 + 2 E/I", "[pair]") {
    BodyAtJoint<double> rotor{1.0, Matrix3<double>::Identity() / 2, V3::Zero()};
    Vector6<double> axis = Vector6<double>::Zero(), twist = Vector6<double>::Zero();
    axis[5] = 1;
    twist[5] = -3;
    const auto release = break_release(rotor, BodyAtJoint<double>{}, axis, twist, 7.0);
    CHECK(-3 + release.a.angular.z() == Approx(-4).epsilon(1e-14)); // √(9 + 2·7/2) = 4
    CHECK(release.b.angular.norm() == 0);
}

TEST_CASE("two bodies that cannot move are left alone", "[pair]") {
    const BodyAtJoint<double> fixed;
    Vector6<double> axis = Vector6<double>::Zero();
    axis[2] = 1;
    const auto impulse = release_impulse(fixed, fixed, axis, Vector6<double>(axis * 2), 5.0);
    CHECK(impulse.linear.norm() == 0);
    CHECK(impulse.angular.norm() == 0);
}

TEST_CASE("an axis response moves its axis by one and leaves the held axes alone", "[pair]") {
    rc::prop("any two bodies, any axis, any number of held ones", [] {
        const Body a = Body::any(), b = Body::any();
        const Matrix6<double> k = inverse_mass_at_joint(a.at_joint(), b.at_joint());
        // any six directions at right angles
        Matrix6<double> any;
        for (int i = 0; i < 36; ++i) any(i) = number(-2, 2);
        for (int i = 0; i < 6; ++i) any(i, i) += 9;
        const Matrix6<double> q = any.householderQr().householderQ();
        const int held = *rc::gen::inRange(0, 6);
        const Vector6<double> axis = q.col(held);
        const Vector6<double> h = axis_response(k, axis, q.leftCols(held));
        const Vector6<double> moved = k * h;
        RC_ASSERT(std::abs(axis.dot(moved) - 1) < 1e-9);
        for (int i = 0; i < held; ++i) RC_ASSERT(std::abs(q.col(i).dot(moved)) < 1e-9);
        for (int i = held + 1; i < 6; ++i) RC_ASSERT(std::abs(q.col(i).dot(h)) < 1e-9 * h.norm());
        RC_ASSERT(axis.dot(h) > 0);
    });
}
