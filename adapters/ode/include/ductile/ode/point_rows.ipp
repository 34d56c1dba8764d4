// SPDX-License-Identifier: MIT
//
// Bodies of point_rows.hpp.
#pragma once

#include <cmath>

#include "ductile/ode/convert.hpp"
#include "ductile/ode/point_rows.hpp"

namespace ductile::ode {

namespace detail {

/// Any one of unit length at right angles to v.
DUCTILE_INLINE Vector3<double> unit_orthogonal(const Vector3<double>& v) noexcept {
    constexpr double beside = 1e-12;
    const bool along_z =
        std::abs(v[0]) <= beside * std::abs(v[2]) && std::abs(v[1]) <= beside * std::abs(v[2]);
    const double first = along_z ? v[1] : v[0], second = along_z ? v[2] : v[1];
    const double length = std::sqrt(first * first + second * second);
    const double across = -second / length, on = first / length;
    return along_z ? Vector3<double>(0, across, on) : Vector3<double>(across, on, 0);
}

} // namespace detail

template <class ContactOf>
void PointRows::attach(dBodyID a, dBodyID b, const std::array<PointRow, 3>& rows,
                       std::size_t together, const ContactOf& contact_of) {
    std::array<const PointRow*, 3> acting{};
    std::size_t count = 0;
    for (const PointRow& row : rows) {
        if (row.row.strength > 0) acting[count++] = &row;
    }
    for (std::size_t i = 0; i < count; i += together) {
        const PointRow& first = *acting[i];
        const PointRow* second = together > 1 && i + 1 < count ? acting[i + 1] : nullptr;
        dContact contact = contact_of(first, second);
        dSurfaceParameters& surface = contact.surface;
        surface.mu = dReal(first.row.strength / first.scale);
        surface.motion1 = dReal(first.row.velocity * first.scale);
        surface.slip1 = dReal(first.row.cfm * first.scale * first.scale);
        if (second != nullptr) {
            surface.mu2 = dReal(second->row.strength / second->scale);
            surface.motion2 = dReal(second->row.velocity * second->scale);
            surface.slip2 = dReal(second->row.cfm * second->scale * second->scale);
        }
        const dJointID joint = dJointCreateContact(world_, group_, &contact);
        dJointAttach(joint, a, b);
        dJointSetFeedback(joint, &feedback_[contacts_++]);
    }
}

DUCTILE_INLINE double row_scale(double diagonal) noexcept {
    return diagonal > largest_diagonal ? 1 / std::sqrt(diagonal) : 1;
}

DUCTILE_INLINE void PointRows::make(dBodyID a, dBodyID b, const Vector3<double>& point,
                                    const std::array<PointRow, 3>& rows) {
    attach(a, b, rows, 2, [&point](const PointRow& first, const PointRow* second) {
        const Vector3<double> along = scaled(first.scale, first.direction);
        const Vector3<double> other =
            second != nullptr ? scaled(second->scale, second->direction)
                              : scaled(first.scale, detail::unit_orthogonal(first.direction));
        return contact(point, along, other);
    });
}

DUCTILE_INLINE void PointRows::make_moments(dBodyID a, dBodyID b,
                                            const std::array<PointRow, 3>& rows) {
    attach(a, b, rows, 1, [](const PointRow& row, const PointRow*) {
        const Vector3<double> normal = cross(row.direction, detail::unit_orthogonal(row.direction));
        const Vector3<double> along = scaled(row.scale / distance, cross(row.direction, normal));
        return contact(scaled(distance, normal), along,
                       scaled(row.scale / distance, row.direction));
    });
}

DUCTILE_INLINE OutsideForce PointRows::collect() {
    OutsideForce result;
    for (const dJointFeedback& f : feedback_) {
        result.force = sum(result.force, to_core(f.f1));
        result.torque_a = sum(result.torque_a, to_core(f.t1));
        result.torque_b = sum(result.torque_b, to_core(f.t2));
    }
    clear();
    return result;
}

DUCTILE_INLINE void PointRows::clear() {
    dJointGroupEmpty(group_);
    feedback_ = {};
    contacts_ = 0;
}

DUCTILE_INLINE dContact PointRows::contact(const Vector3<double>& point,
                                           const Vector3<double>& first,
                                           const Vector3<double>& second) {
    // ODE's second friction direction is normal × first
    const Vector3<double> normal = scaled(1 / dot(first, first), cross(first, second));
    dContact result{};
    result.surface.mode = dContactAxisDep | dContactFDir1 | dContactMotionN | dContactMotion1 |
                          dContactMotion2 | dContactSlip1 | dContactSlip2;
    for (int i = 0; i < 3; ++i) {
        result.geom.pos[i] = dReal(point[i]);
        result.geom.normal[i] = dReal(normal[i]);
        result.fdir1[i] = dReal(first[i]);
    }
    result.surface.motionN = dReal(never);
    return result;
}

} // namespace ductile::ode
