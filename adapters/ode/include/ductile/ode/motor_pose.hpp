// SPDX-License-Identifier: MIT
//
// Where a motor's row acts as its bodies were when last looked at, and how they move there. Asking
// ODE for a joint's axis, anchor and angle costs more than the plasticity of the row, so it is
// asked once for each place of the bodies.
//
// Cost: O(1), no allocation. Not thread-safe.
#pragma once

#include <ode/ode.h>

#include <algorithm>
#include <array>

#include "ductile/joint/pair.hpp"
#include "ductile/ode/convert.hpp"
#include "ductile/ode/motor_axis.hpp"

namespace ductile::ode {

class MotorPose {
  public:
    void look(const MotorAxis& row) {
        seen_a_ = Place(row.bodies().a);
        seen_b_ = Place(row.bodies().b);
        point_ = row.point();
        axes_ = row.axes();
        axis_ = axes_.col(row.number());
        if (!row.measured()) placement_ = row.placement();
        const auto& [a, b, reversed] = row.bodies();
        arm_a_ = point_ - to_core(dBodyGetPosition(a));
        arm_b_.setZero();
        if (b != nullptr) arm_b_ = point_ - to_core(dBodyGetPosition(b));
    }
    /// True where neither body has moved since, to the last bit.
    [[nodiscard]] bool is_now(const MotorAxis& row) const {
        return seen_a_.is(row.bodies().a) && seen_b_.is(row.bodies().b);
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
        Vector6<double> result;
        result.head<3>() =
            linear_velocity(a) + wa.cross(arm_a_) - linear_velocity(b) - wb.cross(arm_b_);
        result.tail<3>() = wa - wb;
        return result;
    }
    /// Its share along the row.
    [[nodiscard]] double along(const MotorAxis& row, const Vector6<double>& twist) const {
        return row.turns() ? axis_.dot(twist.tail<3>()) : axis_.dot(twist.head<3>());
    }
    [[nodiscard]] double velocity(const MotorAxis& row) const {
        if (!row.turns()) return along(row, twist(row));
        const auto& [a, b, reversed] = row.bodies();
        const Vector3<double> turning = angular_velocity(a) - angular_velocity(b);
        return axis_.dot(turning);
    }

  private:
    /// A body's place; that of the static world is never looked at.
    struct Place {
        std::array<dReal, 3> position{};
        std::array<dReal, 4> quaternion{}; ///< of no body

        explicit Place(dBodyID body = nullptr) {
            if (body == nullptr) return;
            std::copy_n(dBodyGetPosition(body), 3, position.begin());
            std::copy_n(dBodyGetQuaternion(body), 4, quaternion.begin());
        }
        [[nodiscard]] bool is_turned_as(dBodyID body) const {
            return body == nullptr ||
                   std::equal(quaternion.begin(), quaternion.end(), dBodyGetQuaternion(body));
        }
        [[nodiscard]] bool is(dBodyID body) const {
            return body == nullptr ||
                   (std::equal(position.begin(), position.end(), dBodyGetPosition(body)) &&
                    is_turned_as(body));
        }
    };

    Place seen_a_, seen_b_;
    Placement placement_;
    Matrix3<double> axes_ = Matrix3<double>::Zero();
    Vector3<double> axis_ = Vector3<double>::Zero();
    Vector3<double> point_ = Vector3<double>::Zero();
    Vector3<double> arm_a_ = Vector3<double>::Zero();
    Vector3<double> arm_b_ = Vector3<double>::Zero();
};

} // namespace ductile::ode
