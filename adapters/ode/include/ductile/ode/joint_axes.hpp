// SPDX-License-Identifier: MIT
//
// The axes of ODE's joints that can be made plastic, by name. Each function throws
// std::invalid_argument where the joint is null, of another kind, not attached, or has no such
// axis.
#pragma once

#include <ode/ode.h>

#include "ductile/ode/motor_axis.hpp"

namespace ductile::ode {

[[nodiscard]] MotorAxis hinge_axis(dJointID hinge);

[[nodiscard]] MotorAxis slider_axis(dJointID slider);

/// `number` 0 or 1: ODE's axis 1 or 2.
[[nodiscard]] MotorAxis universal_axis(dJointID universal, int number);

/// `number` 0 or 1: ODE's axis 1 (steering) or 2 (wheel).
[[nodiscard]] MotorAxis hinge2_axis(dJointID hinge2, int number);

/// `number` 0, 1 or 2. User mode only.
[[nodiscard]] MotorAxis angular_motor_axis(dJointID motor, int number);

/// `number` 0, 1 or 2; `relative_to` 0, 1 or 2 as it was given to dJointSetLMotorAxis.
[[nodiscard]] MotorAxis linear_motor_axis(dJointID motor, int number, int relative_to);

} // namespace ductile::ode

#ifndef DUCTILE_COMPILED
#include "ductile/ode/joint_axes.ipp"
#endif
