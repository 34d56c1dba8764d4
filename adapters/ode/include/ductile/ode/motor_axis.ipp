// SPDX-License-Identifier: MIT
//
// Bodies of motor_axis.hpp.
#pragma once

#include <limits>
#include <stdexcept>

#include "ductile/joint/rotation.hpp"
#include "ductile/numeric/ldlt.hpp"
#include "ductile/numeric/lu.hpp"
#include "ductile/ode/motor_axis.hpp"
#include "ductile/vocabulary/angle.hpp"

namespace ductile::ode {

DUCTILE_INLINE Matrix3<double> MotorAxis::axes() const {
    Matrix3<double> result = Matrix3<double>::Zero();
    for (int i = 0; i < motors_; ++i) {
        const Vector3<double> along = axis_of(i);
        for (int j = 0; j < 3; ++j) result(j, i) = along[j];
    }
    return result;
}

DUCTILE_INLINE Vector3<double> MotorAxis::point() const {
    switch (kind_) {
        case dJointTypeHinge:
            return told(joint_, bodies_.reversed ? dJointGetHingeAnchor2 : dJointGetHingeAnchor);
        case dJointTypeUniversal:
            return told(joint_, dJointGetUniversalAnchor);
        case dJointTypeHinge2:
            return told(joint_, dJointGetHinge2Anchor);
        case dJointTypeAMotor:
            if (const dJointID ball = pin()) return told(ball, dJointGetBallAnchor);
            return to_core(dBodyGetPosition(bodies_.a));
        default:
            break;
    }
    const Vector3<double> a = to_core(dBodyGetPosition(bodies_.a));
    return bodies_.b == nullptr ? a : scaled(0.5, sum(a, to_core(dBodyGetPosition(bodies_.b))));
}

DUCTILE_INLINE double MotorAxis::measure(double predicted) const {
    switch (kind_) {
        case dJointTypeSlider:
            return double(dJointGetSliderPosition(joint_));
        case dJointTypeHinge: {
            const double angle = double(dJointGetHingeAngle(joint_));
            return unwrap(bodies_.reversed ? -angle : angle, predicted);
        }
        case dJointTypeUniversal:
            return unwrap(double(number_ == 0 ? dJointGetUniversalAngle1(joint_)
                                              : dJointGetUniversalAngle2(joint_)),
                          predicted);
        case dJointTypeHinge2:
            return unwrap(double(number_ == 0 ? dJointGetHinge2Angle1(joint_)
                                              : -dJointGetHinge2Angle2(joint_)),
                          predicted);
        default:
            return predicted;
    }
}

DUCTILE_INLINE Placement MotorAxis::placement() const {
    Placement now;
    now.position_a = to_core(dBodyGetPosition(bodies_.a));
    now.rotation_a = matrix_to_core(dBodyGetRotation(bodies_.a));
    if (bodies_.b == nullptr) return now;
    now.position_b = to_core(dBodyGetPosition(bodies_.b));
    now.rotation_b = matrix_to_core(dBodyGetRotation(bodies_.b));
    return now;
}

DUCTILE_INLINE double MotorAxis::increment(const Placement& then, const Vector3<double>& axis_then,
                                           const Vector3<double>& where) const {
    const Placement now = placement();
    const Matrix3<double> turn_a = times_transposed(now.rotation_a, then.rotation_a);
    const Matrix3<double> turn_b = times_transposed(now.rotation_b, then.rotation_b);
    const Vector3<double> mean = scaled(0.5, sum(axis_then, axis()));
    if (turns()) return dot(mean, difference(rotation_vector(turn_a), rotation_vector(turn_b)));
    const Vector3<double> a =
        sum(now.position_a, times(turn_a, difference(where, then.position_a)));
    const Vector3<double> b =
        sum(now.position_b, times(turn_b, difference(where, then.position_b)));
    return dot(mean, difference(a, b));
}

DUCTILE_INLINE double MotorAxis::force(const dJointFeedback& feedback, const Matrix3<double>& axes,
                                       const Vector3<double>& arm) const {
    Vector3<double> whole = to_core(feedback.f1);
    if (turns()) whole = difference(to_core(feedback.t1), cross(arm, whole));
    if (motors_ == 1) return dot(column(axes, 0), whole);
    return numeric::Lu<double, 3>(gram(axes)).solve(transposed_times(axes, whole))[number_];
}

DUCTILE_INLINE Vector6<double> MotorAxis::response(const BodyAtJoint<double>& a,
                                                   const BodyAtJoint<double>& b) const {
    const Matrix6<double> k = inverse_mass_at_joint(a, b);
    const Vector3<double> none(0, 0, 0);
    const Vector6<double> row = turns() ? twist_of(none, axis()) : twist_of(axis(), none);
    Matrix6<double> held = Matrix6<double>::Identity(); // first the pin
    switch (kind_) {
        case dJointTypeUniversal:
        case dJointTypeHinge2: {
            const Vector3<double> across = cross(axis_of(0), axis_of(1));
            const double length = norm(across);
            for (int i = 0; i < 3; ++i) held(3 + i, 3) = length > 0 ? across[i] / length : 0;
            return axis_response(k, row, held, 4);
        }
        case dJointTypeAMotor:
            return axis_response(k, row, held, pin() ? 3 : 0);
        case dJointTypeLMotor:
            return axis_response(k, row, held, 0);
        default:
            return numeric::solve_semidefinite(k, row);
    }
}

DUCTILE_INLINE Vector3<double> MotorAxis::pin_error(const Vector3<double>& point) const {
    switch (kind_) {
        case dJointTypeHinge:
            return difference(
                told(joint_, bodies_.reversed ? dJointGetHingeAnchor : dJointGetHingeAnchor2),
                point);
        case dJointTypeUniversal: {
            const Vector3<double> other = told(joint_, dJointGetUniversalAnchor2);
            return bodies_.reversed ? difference(point, other) : difference(other, point);
        }
        default:
            return scaled(std::numeric_limits<double>::quiet_NaN(), point);
    }
}

DUCTILE_INLINE void MotorAxis::require(bool right, const std::string& what) {
    if (!right) throw std::invalid_argument("MotorAxis." + what);
}

DUCTILE_INLINE MotorAxis::MotorAxis(dJointID joint, dJointType kind, const char* name, int number,
                                    int motors)
    : joint_(joint), kind_(kind), calls_(joint_calls(kind)), number_(number), motors_(motors) {
    require(joint != nullptr, "joint = null: must be a joint");
    require(dJointGetType(joint) == kind, std::string("joint: must be ODE's ") + name);
    require(number >= 0 && number < motors, "number = " + std::to_string(number) +
                                                ": must be one of the joint's " +
                                                std::to_string(motors) + " axes");
    bodies_ = attached_bodies(joint);
    require(bodies_.a != nullptr, "joint: must be attached to a body");
}

DUCTILE_INLINE Matrix3<double> MotorAxis::gram(const Matrix3<double>& axes) {
    Matrix3<double> result = transposed_times(axes, axes);
    for (int i = 0; i < 3; ++i) {
        if (result(i, i) == 0) result(i, i) = 1;
    }
    return result;
}

DUCTILE_INLINE void MotorAxis::require_independent_axes() const {
    constexpr double flat = 1e-6;
    require(numeric::determinant(gram(axes())) > flat,
            "joint: its axes must be independent, else the force of one cannot be told from "
            "another");
}

DUCTILE_INLINE Vector3<double> MotorAxis::axis_of(int number) const {
    switch (kind_) {
        case dJointTypeHinge:
            return told(joint_, dJointGetHingeAxis);
        case dJointTypeSlider:
            // the motor of a slider attached to (null, body), unlike that of a hinge, is turned
            // round
            return scaled(bodies_.reversed ? -1 : 1, told(joint_, dJointGetSliderAxis));
        case dJointTypeUniversal:
            return told(joint_, number == 0 ? dJointGetUniversalAxis1 : dJointGetUniversalAxis2);
        case dJointTypeHinge2:
            return told(joint_, number == 0 ? dJointGetHinge2Axis1 : dJointGetHinge2Axis2);
        case dJointTypeAMotor: {
            dVector3 result;
            dJointGetAMotorAxis(joint_, number, result);
            return to_core(result);
        }
        default:
            return linear_axis(number);
    }
}

DUCTILE_INLINE Vector3<double> MotorAxis::linear_axis(int number) const {
    dVector3 stored;
    dJointGetLMotorAxis(joint_, number, stored);
    const dBodyID frame = relative_to_ == 0 ? nullptr : relative_to_ == 1 ? bodies_.a : bodies_.b;
    if (frame == nullptr) return to_core(stored);
    return times(matrix_to_core(dBodyGetRotation(frame)), to_core(stored));
}

DUCTILE_INLINE dJointID MotorAxis::pin() const {
    for (int i = 0; i < dBodyGetNumJoints(bodies_.a); ++i) {
        const dJointID other = dBodyGetJoint(bodies_.a, i);
        if (dJointGetType(other) != dJointTypeBall || dJointIsEnabled(other) == 0) continue;
        const AttachedBodies pair = attached_bodies(other);
        const bool same = pair.a == bodies_.a && pair.b == bodies_.b;
        const bool swapped = pair.a == bodies_.b && pair.b == bodies_.a;
        if (same || swapped) return other;
    }
    return nullptr;
}

} // namespace ductile::ode
