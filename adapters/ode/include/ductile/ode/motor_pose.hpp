// SPDX-License-Identifier: MIT
//
// Where a motor's row acts as its bodies were when last looked at, and how they move there. Asking
// ODE for a joint's axis, anchor and angle costs more than the plasticity of the row, so it is
// asked once for each place of the bodies.
//
// Cost: O(1), no allocation. Not thread-safe.
#pragma once

#include <ode/ode.h>

#include "ductile/ode/motor_axis.hpp"
#include "ductile/vocabulary/linkage.hpp"
#include "ductile/vocabulary/vector.hpp"

namespace ductile::ode {

class MotorPose {
  public:
    void look(const MotorAxis& row);

    [[nodiscard]] const Vector3<double>& axis() const noexcept { return axis_; }
    /// Of all motors of the joint, as MotorAxis::axes.
    [[nodiscard]] const Matrix3<double>& axes() const noexcept { return axes_; }
    [[nodiscard]] const Vector3<double>& point() const noexcept { return point_; }
    /// Of a row that is not measured; others need none.
    [[nodiscard]] const Placement& placement() const noexcept { return placement_; }
    [[nodiscard]] const Vector3<double>& arm_a() const noexcept { return arm_a_; } ///< world [m]
    [[nodiscard]] const Vector3<double>& arm_b() const noexcept { return arm_b_; }

    /// Linear and angular velocity now of A minus B where the row acts, world axes [m/s, rad/s].
    [[nodiscard]] Vector6<double> twist(const MotorAxis& row) const;
    /// Its share along the row.
    [[nodiscard]] double along(const MotorAxis& row, const Vector6<double>& twist) const;
    [[nodiscard]] double velocity(const MotorAxis& row) const;

  private:
    Placement placement_;
    Matrix3<double> axes_ = Matrix3<double>::Zero();
    Vector3<double> axis_ = Vector3<double>::Zero();
    Vector3<double> point_ = Vector3<double>::Zero();
    Vector3<double> arm_a_ = Vector3<double>::Zero();
    Vector3<double> arm_b_ = Vector3<double>::Zero();
};

} // namespace ductile::ode

#ifndef DUCTILE_COMPILED
#include "ductile/ode/motor_pose.ipp"
#endif
