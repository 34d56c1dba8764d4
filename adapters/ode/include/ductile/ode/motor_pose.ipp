// SPDX-License-Identifier: MIT
//
// Bodies of motor_pose.hpp.
#pragma once

#include "ductile/ode/convert.hpp"
#include "ductile/ode/motor_pose.hpp"

namespace ductile::ode {

DUCTILE_INLINE void MotorPose::look(const MotorAxis& row) {
    point_ = row.point();
    axes_ = row.axes();
    axis_ = column(axes_, row.number());
    if (!row.measured()) placement_ = row.placement();
    const auto& [a, b, reversed] = row.bodies();
    arm_a_ = arm_of(a, point_);
    arm_b_ = arm_of(b, point_);
}

DUCTILE_INLINE Vector6<double> MotorPose::twist(const MotorAxis& row) const {
    const auto& [a, b, reversed] = row.bodies();
    const Vector3<double> wa = angular_velocity(a), wb = angular_velocity(b);
    const Vector3<double> of_a = sum(linear_velocity(a), cross(wa, arm_a_));
    const Vector3<double> of_b = sum(linear_velocity(b), cross(wb, arm_b_));
    return twist_of(difference(of_a, of_b), difference(wa, wb));
}

DUCTILE_INLINE double MotorPose::along(const MotorAxis& row, const Vector6<double>& twist) const {
    return dot(axis_, row.turns() ? angular(twist) : linear(twist));
}

DUCTILE_INLINE double MotorPose::velocity(const MotorAxis& row) const {
    if (!row.turns()) return along(row, twist(row));
    const auto& [a, b, reversed] = row.bodies();
    return dot(axis_, difference(angular_velocity(a), angular_velocity(b)));
}

} // namespace ductile::ode
