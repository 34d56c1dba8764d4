// SPDX-License-Identifier: MIT
//
// Bodies of own_axes.hpp.
#pragma once

#include <utility>

#include "ductile/ode/own_axes.hpp"

namespace ductile::ode {

namespace detail {

[[nodiscard]] DUCTILE_INLINE Vector3<double> centre_of(dBodyID body,
                                                       const Vector3<double>& otherwise) {
    return body != nullptr ? to_core(dBodyGetPosition(body)) : otherwise;
}

} // namespace detail

DUCTILE_INLINE OwnAxes OwnAxes::of(dJointID joint, const AttachedBodies& bodies) {
    OwnAxes axes;
    const Vector3<double> a = detail::centre_of(bodies.a, {0, 0, 0}),
                          b = detail::centre_of(bodies.b, a);
    Vector3<double> pin = scaled(0.5, sum(a, b)), pin_b = pin;
    switch (dJointGetType(joint)) {
        case dJointTypeBall:
        case dJointTypeFixed:
            return axes;
        case dJointTypeHinge:
            axes.powered = dJointGetHingeParam(joint, dParamFMax) > 0;
            axes.turns = told(joint, dJointGetHingeAxis);
            pin = pin_b = told(joint, dJointGetHingeAnchor);
            break;
        case dJointTypeSlider:
            axes.powered = dJointGetSliderParam(joint, dParamFMax) > 0;
            axes.slides = told(joint, dJointGetSliderAxis);
            break;
        case dJointTypeUniversal:
            axes.powered = dJointGetUniversalParam(joint, dParamFMax) > 0 ||
                           dJointGetUniversalParam(joint, dParamFMax2) > 0;
            axes.turns = told(joint, dJointGetUniversalAxis1);
            axes.turns_too = told(joint, dJointGetUniversalAxis2);
            pin = pin_b = told(joint, dJointGetUniversalAnchor);
            break;
        case dJointTypeHinge2:
            axes.powered = true; // its spring
            axes.slides = axes.turns = told(joint, dJointGetHinge2Axis1);
            axes.turns_too = told(joint, dJointGetHinge2Axis2);
            pin = told(joint, dJointGetHinge2Anchor); // which its spring draws apart
            pin_b = told(joint, dJointGetHinge2Anchor2);
            if (bodies.reversed) std::swap(pin, pin_b);
            break;
        default:
            axes.known = false;
            axes.powered = true;
    }
    axes.arm_a = difference(pin, a);
    axes.arm_b = difference(pin_b, b);
    return axes;
}

DUCTILE_INLINE Vector3<double> OwnAxes::force(const Vector3<double>& of_all) const {
    return known ? scaled(dot(of_all, slides), slides) : of_all;
}

DUCTILE_INLINE Vector3<double> OwnAxes::moment(const Vector3<double>& force,
                                               const Vector3<double>& torque) const {
    const Vector3<double> at_pin = difference(torque, cross(arm_a, force));
    if (!known) return at_pin;
    const Vector3<double> across = cross(turns, turns_too);
    const double square = dot(across, across);
    if (square > 0) return difference(at_pin, scaled(dot(at_pin, across) / square, across));
    return scaled(dot(at_pin, turns), turns);
}

} // namespace ductile::ode
