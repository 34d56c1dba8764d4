// SPDX-License-Identifier: MIT
//
// Bullet's vectors and bodies in the words of the core. Results are double whatever the precision of
// Bullet: accumulated work and travel would lose digits in float.
#pragma once

#include <LinearMath/btMatrix3x3.h>
#include <LinearMath/btVector3.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include "ductile/joint/pair.hpp"

namespace ductile::bullet {

[[nodiscard]] inline Vector3<double> to_core(const btVector3& v) noexcept {
    return {double(v.x()), double(v.y()), double(v.z())};
}

[[nodiscard]] inline Matrix3<double> to_core(const btMatrix3x3& m) noexcept {
    Matrix3<double> result;
    for (int row = 0; row < 3; ++row) result.row(row) = to_core(m[row]).transpose();
    return result;
}

[[nodiscard]] inline btVector3 to_bullet(const Vector3<double>& v) noexcept {
    return {btScalar(v.x()), btScalar(v.y()), btScalar(v.z())};
}

/// Velocity of the point of the body that is at `arm` from its centre of mass, world axes [m/s].
/// Double throughout, also where Bullet is float.
[[nodiscard]] inline Vector3<double> velocity_at(const btRigidBody& body,
                                                 const Vector3<double>& arm) noexcept {
    return to_core(body.getLinearVelocity()) + to_core(body.getAngularVelocity()).cross(arm);
}

/// The body as a joint at `point` (world) sees it. Static and kinematic bodies cannot move.
[[nodiscard]] inline BodyAtJoint<double> at_joint(const btRigidBody& body,
                                                  const btVector3& point) noexcept {
    return {.inverse_mass = double(body.getInvMass()),
            .inverse_inertia = to_core(body.getInvInertiaTensorWorld()),
            .arm = to_core(point - body.getCenterOfMassPosition())};
}

inline void apply(btRigidBody& body, const VelocityChange<double>& change) noexcept {
    body.setLinearVelocity(body.getLinearVelocity() + to_bullet(change.linear));
    body.setAngularVelocity(body.getAngularVelocity() + to_bullet(change.angular));
}

} // namespace ductile::bullet
