// SPDX-License-Identifier: MIT
//
// ODE's vectors and bodies in the words of the core. A null dBodyID is the static world.
#pragma once

#include <ode/ode.h>

#include <Eigen/LU>

#include "ductile/joint/pair.hpp"

namespace ductile::ode {

[[nodiscard]] inline Vector3<double> to_core(const dReal* v) noexcept {
    return {double(v[0]), double(v[1]), double(v[2])};
}

/// ODE stores 3×3 matrices by rows of four.
[[nodiscard]] inline Matrix3<double> matrix_to_core(const dReal* m) noexcept {
    Matrix3<double> result;
    for (int row = 0; row < 3; ++row) result.row(row) = to_core(m + 4 * row).transpose();
    return result;
}

[[nodiscard]] inline double mass(dBodyID body) noexcept {
    dMass result;
    dBodyGetMass(body, &result);
    return double(result.mass);
}

/// Inertia about the centre of mass, world axes [kg m²].
[[nodiscard]] inline Matrix3<double> inertia(dBodyID body) noexcept {
    dMass m;
    dBodyGetMass(body, &m);
    const Matrix3<double> rotation = matrix_to_core(dBodyGetRotation(body));
    return rotation * matrix_to_core(m.I) * rotation.transpose();
}

[[nodiscard]] inline Vector3<double> linear_velocity(dBodyID body) noexcept {
    return body != nullptr ? to_core(dBodyGetLinearVel(body)) : Vector3<double>::Zero();
}
[[nodiscard]] inline Vector3<double> angular_velocity(dBodyID body) noexcept {
    return body != nullptr ? to_core(dBodyGetAngularVel(body)) : Vector3<double>::Zero();
}

/// The body as a joint at `point` (world) sees it; the static world and kinematic bodies cannot
/// move.
[[nodiscard]] inline BodyAtJoint<double> at_joint(dBodyID body,
                                                  const Vector3<double>& point) noexcept {
    if (body == nullptr || dBodyIsKinematic(body)) return {};
    return {.inverse_mass = 1 / mass(body),
            .inverse_inertia = inertia(body).inverse(),
            .arm = point - to_core(dBodyGetPosition(body))};
}

/// The two bodies of a joint in the order in which ODE's rows and feedback know them: a joint made
/// between the static world and a body (null first) is turned round inside ODE.
struct AttachedBodies {
    dBodyID a = nullptr;
    dBodyID b = nullptr;   ///< null: the static world
    bool reversed = false; ///< the user attached the world first

    bool operator==(const AttachedBodies&) const = default;
};

[[nodiscard]] inline AttachedBodies attached_bodies(dJointID joint) noexcept {
    const dBodyID first = dJointGetBody(joint, 0);
    const dBodyID second = dJointGetBody(joint, 1);
    if (first == nullptr && second != nullptr) return {second, nullptr, true};
    return {first, second, false};
}

inline void apply(dBodyID body, const VelocityChange<double>& change) noexcept {
    const Vector3<double> v = linear_velocity(body) + change.linear;
    const Vector3<double> w = angular_velocity(body) + change.angular;
    dBodySetLinearVel(body, dReal(v.x()), dReal(v.y()), dReal(v.z()));
    dBodySetAngularVel(body, dReal(w.x()), dReal(w.y()), dReal(w.z()));
}

} // namespace ductile::ode
