// SPDX-License-Identifier: MIT
//
// The bodies of a world that are not static, its constraints and contacts of two bodies; Bullet
// keeps such lists and does not show them. And where a body goes by its velocities.
#pragma once

#include <BulletCollision/BroadphaseCollision/btCollisionAlgorithm.h>
#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <LinearMath/btTransformUtil.h>

#include <cstddef>
#include <span>

namespace ductile::bullet {

struct MovingBodies : btDiscreteDynamicsWorld {
    [[nodiscard]] static const btAlignedObjectArray<btRigidBody*>& of(
        const btDiscreteDynamicsWorld& world) {
        return world.*(&MovingBodies::m_nonStaticRigidBodies);
    }
    [[nodiscard]] static std::span<btRigidBody* const> all(const btDiscreteDynamicsWorld& world) {
        const auto& bodies = of(world);
        if (bodies.size() == 0) return {};
        return {&bodies[0], std::size_t(bodies.size())};
    }
};

struct AllConstraints : btDiscreteDynamicsWorld {
    [[nodiscard]] static btAlignedObjectArray<btTypedConstraint*>& of(
        btDiscreteDynamicsWorld& world) {
        return world.*(&AllConstraints::m_constraints);
    }
};

/// Bullet may have several of two shapes.
[[nodiscard]] inline btManifoldArray manifolds_between(btDynamicsWorld& world,
                                                       const btCollisionObject& a,
                                                       const btCollisionObject& b) {
    btManifoldArray manifolds;
    auto* of_a = const_cast<btBroadphaseProxy*>(a.getBroadphaseHandle());
    auto* of_b = const_cast<btBroadphaseProxy*>(b.getBroadphaseHandle());
    if (of_a == nullptr || of_b == nullptr) return manifolds;
    const btBroadphasePair* pair = world.getPairCache()->findPair(of_a, of_b);
    if (pair != nullptr && pair->m_algorithm != nullptr) {
        pair->m_algorithm->getAllContactManifolds(manifolds);
    }
    return manifolds;
}

namespace detail {

/// It is there, and rows may move it.
[[nodiscard]] inline bool moves(const btRigidBody* body) noexcept {
    return body != nullptr && !body->isStaticOrKinematicObject() && body->getInvMass() > 0;
}

/// `time` [s] after it was at `from`.
[[nodiscard]] inline btTransform moved(const btRigidBody& body, const btTransform& from,
                                       btScalar time) {
    btTransform result;
    btTransformUtil::integrateTransform(from, body.getLinearVelocity(), body.getAngularVelocity(),
                                        time, result);
    return result;
}

} // namespace detail

} // namespace ductile::bullet
