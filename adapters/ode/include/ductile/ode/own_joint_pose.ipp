// SPDX-License-Identifier: MIT
//
// Bodies of own_joint.hpp: how the bodies of a joint lie. A part of own_joint.ipp.
#pragma once

#include <array>
#include <cmath>
#include <utility>

#include "ductile/joint/rotation.hpp"
#include "ductile/ode/joint_calls.hpp"

namespace ductile::ode {

DUCTILE_INLINE Vector3<double> OwnJoint::axis_of(dJointID joint, bool reversed) {
    switch (dJointGetType(joint)) {
        case dJointTypeHinge:
            return told(joint, dJointGetHingeAxis);
        case dJointTypeSlider:
            return told(joint, dJointGetSliderAxis);
        case dJointTypeUniversal:
            return told(joint, reversed ? dJointGetUniversalAxis2 : dJointGetUniversalAxis1);
        case dJointTypeHinge2:
            return told(joint, dJointGetHinge2Axis1);
        default:
            return {0, 0, 0};
    }
}

DUCTILE_INLINE Vector3<double> OwnJoint::turned() const {
    const Matrix3<double> wanted = times(body_motion(bodies_.a).orientation, turn_);
    return rotation_vector(times_transposed(body_motion(bodies_.b).orientation, wanted));
}

DUCTILE_INLINE Vector3<double> OwnJoint::shifted() const {
    const BodyState<double> a = body_motion(bodies_.a), b = body_motion(bodies_.b);
    const bool in_a = kind_ == dJointTypeFixed && bodies_.b != nullptr;
    const Vector3<double> place =
        in_a ? scaled(-1, times(a.orientation, place_)) : times(b.orientation, place_);
    return sum(difference(b.position, a.position), place);
}

DUCTILE_INLINE Vector3<double> OwnJoint::leans() const {
    const Vector3<double> a = axis_of(joint_, bodies_.reversed);
    if (kind_ == dJointTypeHinge) {
        return cross(a, times(body_motion(bodies_.b).orientation, axis_b_));
    }
    const Vector3<double> wheel = told(joint_, dJointGetHinge2Axis2), across = cross(a, wheel);
    const double sine = norm(across), angle = std::atan2(sine, dot(a, wheel));
    return scaled(std::sin(angle - angle_) / sine, across);
}

DUCTILE_INLINE std::array<Vector3<double>, 2> OwnJoint::pins() const {
    std::array<Vector3<double>, 2> pins;
    const auto ask = [&](void (*of_a)(dJointID, dVector3), void (*of_b)(dJointID, dVector3)) {
        pins = {told(joint_, of_a), told(joint_, of_b)};
        if (bodies_.reversed) std::swap(pins[0], pins[1]);
    };
    switch (kind_) {
        case dJointTypeHinge:
            ask(dJointGetHingeAnchor, dJointGetHingeAnchor2);
            break;
        case dJointTypeUniversal:
            ask(dJointGetUniversalAnchor, dJointGetUniversalAnchor2);
            break;
        case dJointTypeHinge2:
            ask(dJointGetHinge2Anchor, dJointGetHinge2Anchor2);
            break;
        default:
            ask(dJointGetBallAnchor, dJointGetBallAnchor2);
    }
    return pins;
}

DUCTILE_INLINE double OwnJoint::parameter(int name, int axis) const {
    return double(joint_calls(kind_).get(joint_, name + dParamGroup * axis));
}

} // namespace ductile::ode
