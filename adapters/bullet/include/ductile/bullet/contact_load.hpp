// SPDX-License-Identifier: MIT
//
// What a tick did to a body: how it went through it, and what a contact point gave it.
#pragma once

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <cmath>
#include <span>
#include <utility>

#include "ductile/bullet/convert.hpp"
#include "ductile/bullet/divisible.hpp"
#include "ductile/member/member_piece.hpp"

namespace ductile::bullet {

/// Of a body that moves and is awake, beside what gravity and its damping gave it.
struct BodyChange {
    BodyMotion change;
    Vector3<double> spin = Vector3<double>::Zero(); ///< before [rad/s]
    bool turns = false;                             ///< Bullet had its gyroscopic moments act
};

[[nodiscard]] inline BodyChange body_change(const btRigidBody& body, const BodyBefore& was,
                                            double dt) {
    const double keeps = std::pow(1 - double(body.getLinearDamping()), dt);
    const double keeps_spin = std::pow(1 - double(body.getAngularDamping()), dt);
    const Vector3<double> free =
        sum(scaled(keeps, to_core(was.velocity)), scaled(dt, to_core(body.getGravity())));
    BodyChange result;
    result.spin = scaled(keeps_spin, to_core(was.spin));
    result.change = {difference(to_core(body.getLinearVelocity()), free),
                     difference(to_core(body.getAngularVelocity()), result.spin)};
    result.turns = (body.getFlags() & BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_BODY) != 0;
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
        if (body == nullptr || body->isStaticObject()) return result;
        const BodyBefore& was = before[std::size_t(object.getWorldArrayIndex())];
        const btVector3 arm = load.at - body->getCenterOfMassPosition();
        result.first = was.velocity + was.spin.cross(arm);
        result.second = body->getVelocityInLocalPoint(arm);
        return result;
    };
    const auto [a_before, a_after] = velocities(*manifold.getBody0());
    const auto [b_before, b_after] = velocities(*manifold.getBody1());
    load.closing = -double(point.m_normalWorldOnB.dot(a_before - b_before));
    const auto after = double(point.m_normalWorldOnB.dot(a_after - b_after));
    load.energy = double(point.m_appliedImpulse) * (load.closing - after) / 2;
    return load;
}

} // namespace ductile::bullet
