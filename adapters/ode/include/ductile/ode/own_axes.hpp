// SPDX-License-Identifier: MIT
//
// The axes of a joint of ODE's along which its motors, stops and springs act, where it is solved:
// with them what its feedback says is divided into what those did and what its rigid rows did,
// which take nothing as bodies go along. Balls and fixed joints have none; of hinges, sliders,
// universals and hinge-2 they are known; what all others do is taken to be their motors'.
//
// Not thread-safe.
#pragma once

#include <ode/ode.h>

#include <utility>

#include "ductile/ode/convert.hpp"

namespace ductile::ode {

namespace detail {

/// A motor of the axis, or a spring: two stops at one place.
[[nodiscard]] inline bool is_powered(dJointID joint, dReal (*get)(dJointID, int), int group = 0) {
    const dReal least = get(joint, dParamLoStop + group);
    return get(joint, dParamFMax + group) > 0 || least == get(joint, dParamHiStop + group);
}

[[nodiscard]] inline Vector3<double> centre_of(dBodyID body, const Vector3<double>& otherwise) {
    return body != nullptr ? to_core(dBodyGetPosition(body)) : otherwise;
}

} // namespace detail

struct OwnAxes {
    bool known = true;
    bool powered = false;                           ///< a motor or spring may bring energy in
    Vector3<double> arm_a{0, 0, 0}, arm_b{0, 0, 0}; ///< to the pin [m]
    Vector3<double> slides{0, 0, 0};                ///< unit vector, or none
    /// Turns about these are free; of two any moment in their plane is.
    Vector3<double> turns{0, 0, 0}, turns_too{0, 0, 0};

    /// Of `joint` between these, as they are.
    [[nodiscard]] static OwnAxes of(dJointID joint, const AttachedBodies& bodies) {
        OwnAxes axes;
        const Vector3<double> a = detail::centre_of(bodies.a, {0, 0, 0}),
                              b = detail::centre_of(bodies.b, a);
        Vector3<double> pin = scaled(0.5, sum(a, b)), pin_b = pin;
        switch (dJointGetType(joint)) {
            case dJointTypeBall:
            case dJointTypeFixed:
                return axes;
            case dJointTypeHinge:
                axes.powered = detail::is_powered(joint, dJointGetHingeParam);
                axes.turns = told(joint, dJointGetHingeAxis);
                pin = pin_b = told(joint, dJointGetHingeAnchor);
                break;
            case dJointTypeSlider:
                axes.powered = detail::is_powered(joint, dJointGetSliderParam);
                axes.slides = told(joint, dJointGetSliderAxis);
                break;
            case dJointTypeUniversal:
                axes.powered = detail::is_powered(joint, dJointGetUniversalParam) ||
                               detail::is_powered(joint, dJointGetUniversalParam, dParamGroup);
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
    /// Force and moment on A at the pin, of what the feedback says about A's centre.
    [[nodiscard]] Vector3<double> force(const Vector3<double>& of_all) const {
        return known ? scaled(dot(of_all, slides), slides) : of_all;
    }
    [[nodiscard]] Vector3<double> moment(const Vector3<double>& force,
                                         const Vector3<double>& torque) const {
        const Vector3<double> at_pin = difference(torque, cross(arm_a, force));
        if (!known) return at_pin;
        const Vector3<double> across = cross(turns, turns_too);
        const double square = dot(across, across);
        if (square > 0) return difference(at_pin, scaled(dot(at_pin, across) / square, across));
        return scaled(dot(at_pin, turns), turns);
    }
};

} // namespace ductile::ode
