// SPDX-License-Identifier: MIT
//
// Bullet's vectors and bodies in the words of the core. Results are double whatever the precision
// of Bullet: accumulated work and travel would lose digits in float.
#pragma once

#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <LinearMath/btMatrix3x3.h>
#include <LinearMath/btTransform.h>
#include <LinearMath/btVector3.h>

#include "ductile/joint/inverse_mass.hpp"
#include "ductile/joint/link_types.hpp"
#include "ductile/numeric/lu.hpp"
#include "ductile/world/turned_contact.hpp"

namespace ductile::bullet {

[[nodiscard]] inline Vector3<double> to_core(const btVector3& v) noexcept {
    return {double(v.x()), double(v.y()), double(v.z())};
}

[[nodiscard]] inline Matrix3<double> to_core(const btMatrix3x3& m) noexcept {
    Matrix3<double> result;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) result(row, column) = double(m[row][column]);
    }
    return result;
}

[[nodiscard]] inline btVector3 to_bullet(const Vector3<double>& v) noexcept {
    return {btScalar(v.x()), btScalar(v.y()), btScalar(v.z())};
}

[[nodiscard]] inline JointFrame<double> to_core(const btTransform& frame) noexcept {
    return {to_core(frame.getOrigin()), to_core(frame.getBasis())};
}

[[nodiscard]] inline btTransform to_bullet(const JointFrame<double>& frame) noexcept {
    const Matrix3<double>& m = frame.axes;
    btMatrix3x3 axes;
    for (int row = 0; row < 3; ++row) {
        axes[row] = btVector3(btScalar(m(row, 0)), btScalar(m(row, 1)), btScalar(m(row, 2)));
    }
    return btTransform(axes, to_bullet(frame.origin));
}

/// It is static: at rest, whatever it was told. A kinematic one mostly has that flag, too.
[[nodiscard]] inline bool stands(const btCollisionObject& body) noexcept {
    return body.isStaticObject() && !body.isKinematicObject();
}

[[nodiscard]] inline ContactBody contact_body(const btRigidBody& body) noexcept {
    if (stands(body)) return {};
    return {to_core(body.getLinearVelocity()), to_core(body.getAngularVelocity())};
}

/// Place and velocities of the body as they are now, without its mass.
[[nodiscard]] inline BodyState<double> body_motion(const btRigidBody& body) noexcept {
    const btTransform& at = body.getCenterOfMassTransform();
    return {.position = to_core(at.getOrigin()),
            .orientation = to_core(at.getBasis()),
            .velocity = to_core(body.getLinearVelocity()),
            .spin = to_core(body.getAngularVelocity())};
}

/// The body as it is now. Static and kinematic bodies cannot be moved by a joint.
[[nodiscard]] inline BodyState<double> body_state(const btRigidBody& body) noexcept {
    BodyState<double> state = body_motion(body);
    if (!body.isStaticOrKinematicObject()) {
        state.inverse_mass = double(body.getInvMass());
        state.inverse_inertia = to_core(body.getInvInertiaTensorWorld());
    }
    return state;
}

/// Where the body is now, with the velocities that the last tick left it: Bullet keeps them as
/// its interpolation velocities, whoever changed the velocities since (damping at the start of the
/// next tick, for one). Without its mass.
[[nodiscard]] inline BodyState<double> body_motion_of_last_tick(const btRigidBody& body) noexcept {
    BodyState<double> state = body_motion(body);
    if (!body.isStaticOrKinematicObject()) {
        state.velocity = to_core(body.getInterpolationLinearVelocity());
        state.spin = to_core(body.getInterpolationAngularVelocity());
    }
    return state;
}

/// The velocities that the body would have after a tick of `dt` [s] if nothing held it.
[[nodiscard]] inline BodyState<double> free_state(const btRigidBody& body, double dt) noexcept {
    BodyState<double> state = body_state(body);
    const Vector3<double> force = to_core(body.getTotalForce());
    const Vector3<double> torque = to_core(body.getTotalTorque());
    state.velocity = sum(state.velocity, scaled(dt * state.inverse_mass, force));
    state.spin = sum(state.spin, scaled(dt, times(state.inverse_inertia, torque)));
    if (!(state.inverse_mass > 0)) return state;
    if (body.getFlags() & BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_BODY) {
        state.spin =
            sum(state.spin, to_core(body.computeGyroscopicImpulseImplicit_Body(btScalar(dt))));
    } else if (body.getFlags() & BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_WORLD) {
        state.spin =
            sum(state.spin, to_core(body.computeGyroscopicImpulseImplicit_World(btScalar(dt))));
    }
    return state;
}

/// What Bullet's gyroscopic moment changes of the angular momentum in a tick, by its implicit rule:
/// one Newton step on I(ω' - ω) + dt ω' × Iω' = 0.
[[nodiscard]] inline Vector3<double> gyroscopic_impulse(const btRigidBody& body,
                                                        const Matrix3<double>& inertia,
                                                        const Vector3<double>& spin,
                                                        double dt) noexcept {
    if ((body.getFlags() & BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_BODY) == 0) {
        return Vector3<double>::Zero();
    }
    const Vector3<double> momentum = times(inertia, spin);
    const Matrix3<double> turned = times(skew(spin), inertia);
    const Matrix3<double> jacobian = sum(inertia, scaled(dt, difference(turned, skew(momentum))));
    const Vector3<double> wanted = scaled(dt, cross(spin, momentum));
    const Vector3<double> impulse =
        scaled(-1, times(inertia, numeric::Lu<double, 3>(jacobian).solve(wanted)));
    return is_finite(impulse) ? impulse : Vector3<double>(0, 0, 0); // one that cannot turn
}

inline void apply(btRigidBody& body, const VelocityChange<double>& change) noexcept {
    if (body.isStaticOrKinematicObject()) return;
    body.setLinearVelocity(body.getLinearVelocity() + to_bullet(change.linear));
    body.setAngularVelocity(body.getAngularVelocity() + to_bullet(change.angular));
}

} // namespace ductile::bullet
