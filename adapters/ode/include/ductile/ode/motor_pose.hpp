// SPDX-License-Identifier: MIT
//
// Where a motor's row acts as its bodies were when last looked at, and how they move there. Asking
// ODE for a joint's axis, anchor and angle costs more than the plasticity of the row, so it is
// asked once for each place of the bodies.
//
// Cost: O(1), no allocation. Not thread-safe.
#pragma once

#include <ode/ode.h>

#include "ductile/ode/convert.hpp"
#include "ductile/ode/motor_axis.hpp"
#include "ductile/vocabulary/vector.hpp"

namespace ductile::ode {

class MotorPose {
  public:
    void look(const MotorAxis& row) {
        point_ = row.point();
        axes_ = row.axes();
        axis_ = column(axes_, row.number());
        if (!row.measured()) placement_ = row.placement();
        const auto& [a, b, reversed] = row.bodies();
        arm_a_ = arm_of(a, point_);
        arm_b_ = arm_of(b, point_);
    }

    [[nodiscard]] const Vector3<double>& axis() const noexcept { return axis_; }
    /// Of all motors of the joint, as MotorAxis::axes.
    [[nodiscard]] const Matrix3<double>& axes() const noexcept { return axes_; }
    [[nodiscard]] const Vector3<double>& point() const noexcept { return point_; }
    /// Of a row that is not measured; others need none.
    [[nodiscard]] const Placement& placement() const noexcept { return placement_; }
    [[nodiscard]] const Vector3<double>& arm_a() const noexcept { return arm_a_; } ///< world [m]
    [[nodiscard]] const Vector3<double>& arm_b() const noexcept { return arm_b_; }

    /// Linear and angular velocity now of A minus B where the row acts, world axes [m/s, rad/s].
    [[nodiscard]] Vector6<double> twist(const MotorAxis& row) const {
        const auto& [a, b, reversed] = row.bodies();
        const Vector3<double> wa = angular_velocity(a), wb = angular_velocity(b);
        const Vector3<double> of_a = sum(linear_velocity(a), cross(wa, arm_a_));
        const Vector3<double> of_b = sum(linear_velocity(b), cross(wb, arm_b_));
        return twist_of(difference(of_a, of_b), difference(wa, wb));
    }
    /// Its share along the row.
    [[nodiscard]] double along(const MotorAxis& row, const Vector6<double>& twist) const {
        return dot(axis_, row.turns() ? angular(twist) : linear(twist));
    }
    [[nodiscard]] double velocity(const MotorAxis& row) const {
        if (!row.turns()) return along(row, twist(row));
        const auto& [a, b, reversed] = row.bodies();
        return dot(axis_, difference(angular_velocity(a), angular_velocity(b)));
    }

  private:
    Placement placement_;
    Matrix3<double> axes_ = Matrix3<double>::Zero();
    Vector3<double> axis_ = Vector3<double>::Zero();
    Vector3<double> point_ = Vector3<double>::Zero();
    Vector3<double> arm_a_ = Vector3<double>::Zero();
    Vector3<double> arm_b_ = Vector3<double>::Zero();
};

} // namespace ductile::ode
