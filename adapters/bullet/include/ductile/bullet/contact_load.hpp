// SPDX-License-Identifier: MIT
//
// What a tick did to a body: how it went through it, and what a contact point gave it.
#pragma once

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "ductile/bullet/convert.hpp"
#include "ductile/bullet/divisible.hpp"
#include "ductile/member/member_piece.hpp"

namespace ductile::bullet {

/// Of a body that moves and is awake, beside what gravity, its damping and Bullet's gyroscopic
/// moment gave it.
struct BodyChange {
    Vector3<double> velocity = Vector3<double>::Zero(); ///< [m/s]
    Vector3<double> turned = Vector3<double>::Zero();   ///< of the angular momentum [N m s]
    Vector3<double> spin = Vector3<double>::Zero();     ///< before [rad/s]
    double dt = 0; ///< in which it turned [s]; 0: Bullet has no gyroscopic moment of it

    /// Of a body with `inertia` along `axes` that had the same, as internal_forces.hpp wants it.
    [[nodiscard]] BodyMotion of(const Vector3<double>& inertia, const Matrix3<double>& axes) const {
        const Vector3<double> momentum = times(along_axes(inertia, axes), spin);
        const Vector3<double> rest = difference(turned, scaled(dt, cross(spin, momentum)));
        const Vector3<double> inverse{1 / inertia[0], 1 / inertia[1], 1 / inertia[2]};
        return {velocity, times(along_axes(inverse, axes), rest)};
    }
};

[[nodiscard]] inline BodyChange body_change(const btRigidBody& body, const BodyBefore& was,
                                            double dt) {
    const double keeps = std::pow(1 - double(body.getLinearDamping()), dt);
    const double keeps_spin = std::pow(1 - double(body.getAngularDamping()), dt);
    const Vector3<double> free =
        sum(scaled(keeps, to_core(was.velocity)), scaled(dt, to_core(body.getGravity())));
    BodyChange result;
    result.velocity = difference(to_core(body.getLinearVelocity()), free);
    result.spin = scaled(keeps_spin, to_core(was.spin));
    const btVector3& least = body.getInvInertiaDiagLocal();
    const Matrix3<double> inertia =
        along_axes({1 / double(least.x()), 1 / double(least.y()), 1 / double(least.z())},
                   to_core(was.pose.getBasis()));
    const Vector3<double> turned =
        times(inertia, difference(to_core(body.getAngularVelocity()), result.spin));
    result.turned = difference(turned, gyroscopic_impulse(body, inertia, result.spin, dt));
    if ((body.getFlags() & BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_BODY) != 0) result.dt = dt;
    return result;
}

struct ContactLoad {
    btVector3 at, impulse; ///< on the one asked for [m], [N s]
    double energy = 0;     ///< that the normal impulse took [J]
    double closing = 0;    ///< speed before [m/s]
};

/// `before`: velocities by place in the world.
[[nodiscard]] inline ContactLoad contact_load(const btPersistentManifold& manifold,
                                              const btManifoldPoint& point, bool of_a,
                                              std::span<const BodyBefore> before) {
    ContactLoad load;
    load.at = of_a ? point.getPositionWorldOnA() : point.getPositionWorldOnB();
    load.impulse = point.m_appliedImpulse * point.m_normalWorldOnB +
                   point.m_appliedImpulseLateral1 * point.m_lateralFrictionDir1 +
                   point.m_appliedImpulseLateral2 * point.m_lateralFrictionDir2;
    if (!of_a) load.impulse = -load.impulse;
    const auto velocities = [&](const btCollisionObject& object) {
        const btRigidBody* body = btRigidBody::upcast(&object);
        std::pair<btVector3, btVector3> result{{0, 0, 0}, {0, 0, 0}};
        if (body == nullptr || stands(*body)) return result;
        const btVector3 arm = load.at - body->getCenterOfMassPosition();
        result.first = result.second = body->getVelocityInLocalPoint(arm);
        if (body->isKinematicObject()) return result;
        const BodyBefore& was = before[std::size_t(object.getWorldArrayIndex())];
        result.first = was.velocity + was.spin.cross(arm);
        return result;
    };
    const auto [a_before, a_after] = velocities(*manifold.getBody0());
    const auto [b_before, b_after] = velocities(*manifold.getBody1());
    load.closing = -double(point.m_normalWorldOnB.dot(a_before - b_before));
    const auto after = double(point.m_normalWorldOnB.dot(a_after - b_after));
    load.energy = double(point.m_appliedImpulse) * (load.closing - after) / 2;
    return load;
}

namespace detail {

/// What sweeps left of a contact that still closes, at most; 0 where no more than `noticed` [N s]
/// is moved at all, at an arm of `arm` [m].
[[nodiscard]] inline double left_by_sweeps(const btPersistentManifold& manifold, double dt,
                                           double noticed, double arm) {
    const btRigidBody *a = btRigidBody::upcast(manifold.getBody0()),
                      *b = btRigidBody::upcast(manifold.getBody1());
    const auto velocity = [](const btRigidBody* body, const btVector3& at) {
        return body == nullptr
                   ? btVector3(0, 0, 0)
                   : body->getVelocityInLocalPoint(at - body->getCenterOfMassPosition());
    };
    double speed = 0, mass = 0, most = 0;
    for (const btRigidBody* body : {a, b}) {
        if (body == nullptr || stands(*body)) continue;
        mass = std::max(mass, double(body->getMass()));
        most += double(body->getLinearVelocity().length2()) +
                arm * arm * double(body->getAngularVelocity().length2());
    }
    if (!(4 * most * mass * mass > noticed * noticed)) return 0;
    for (int k = 0; k < manifold.getNumContacts(); ++k) {
        const btManifoldPoint& point = manifold.getContactPoint(k);
        const btVector3 away =
            velocity(a, point.getPositionWorldOnA()) - velocity(b, point.getPositionWorldOnB());
        const double gap = std::max(0.0, double(point.getDistance()));
        speed = std::max(speed, -double(point.m_normalWorldOnB.dot(away)) - 2 * gap / dt);
    }
    return speed * mass;
}

} // namespace detail

} // namespace ductile::bullet
