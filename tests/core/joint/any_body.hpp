// SPDX-License-Identifier: MIT
//
// A rigid body of any mass, inertia and motion, drawn by rapidcheck.
#pragma once

#include <rapidcheck.h>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "ductile/joint/inverse_mass.hpp"
#include "ductile/vocabulary/vector.hpp"

namespace any_body {

using namespace ductile;
using V3 = Vector3<double>;

inline double number(int lo, int hi) { return *rc::gen::inRange(lo * 1000, hi * 1000) / 1000.0; }
inline V3 vector(int size) {
    return {number(-size, size), number(-size, size), number(-size, size)};
}

/// World axes; moments about the centre of mass.
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

} // namespace any_body
