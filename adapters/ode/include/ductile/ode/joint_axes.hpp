// SPDX-License-Identifier: MIT
//
// The axes of ODE's joints that can be made plastic, by name. Each function throws
// std::invalid_argument where the joint is null, of another kind, not attached, or has no such
// axis.
#pragma once

#include <ode/ode.h>

#include <cmath>
#include <string>

#include "ductile/ode/motor_axis.hpp"

namespace ductile::ode {

[[nodiscard]] inline MotorAxis hinge_axis(dJointID hinge) {
    return {hinge, dJointTypeHinge, "hinge", 0, 1};
}

[[nodiscard]] inline MotorAxis slider_axis(dJointID slider) {
    return {slider, dJointTypeSlider, "slider", 0, 1};
}

/// `number` 0 or 1: ODE's axis 1 or 2.
[[nodiscard]] inline MotorAxis universal_axis(dJointID universal, int number) {
    const MotorAxis result{universal, dJointTypeUniversal, "universal", number, 2};
    MotorAxis::require(
        !result.bodies_.reversed,
        "joint: must be attached with its body first, not as (null, body): ODE swaps "
        "the axes of such a universal but not its motors");
    return result;
}

/// `number` 0 or 1: ODE's axis 1 (steering) or 2 (wheel).
[[nodiscard]] inline MotorAxis hinge2_axis(dJointID hinge2, int number) {
    MotorAxis result{hinge2, dJointTypeHinge2, "hinge-2", number, 2};
    constexpr double square = 1e-9;
    result.measured_ = std::abs(dot(result.axis_of(0), result.axis_of(1))) < square;
    return result;
}

/// `number` 0, 1 or 2. User mode only.
[[nodiscard]] inline MotorAxis angular_motor_axis(dJointID motor, int number) {
    MotorAxis::require(motor != nullptr, "joint = null: must be a joint");
    const bool right = dJointGetType(motor) == dJointTypeAMotor;
    MotorAxis result{motor, dJointTypeAMotor, "angular motor", number,
                     right ? dJointGetAMotorNumAxes(motor) : 3};
    MotorAxis::require(
        dJointGetAMotorMode(motor) == dAMotorUser,
        "joint: must be an angular motor in user mode: in Euler mode ODE's axes are not "
        "of unit length");
    result.measured_ = false;
    result.require_independent_axes();
    return result;
}

/// `number` 0, 1 or 2; `relative_to` 0, 1 or 2 as it was given to dJointSetLMotorAxis.
[[nodiscard]] inline MotorAxis linear_motor_axis(dJointID motor, int number, int relative_to) {
    MotorAxis::require(motor != nullptr, "joint = null: must be a joint");
    const bool right = dJointGetType(motor) == dJointTypeLMotor;
    MotorAxis result{motor, dJointTypeLMotor, "linear motor", number,
                     right ? dJointGetLMotorNumAxes(motor) : 3};
    MotorAxis::require(relative_to >= 0 && relative_to <= 2,
                       "relative_to = " + std::to_string(relative_to) +
                           ": must be 0 (world), 1 (first body) or 2 (second body)");
    // where there is no second body ODE takes the axis relative to the first
    result.relative_to_ = relative_to == 2 && result.bodies_.b == nullptr ? 1 : relative_to;
    result.measured_ = false;
    result.require_independent_axes();
    return result;
}

} // namespace ductile::ode
