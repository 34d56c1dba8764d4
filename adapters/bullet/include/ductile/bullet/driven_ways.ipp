// SPDX-License-Identifier: MIT
//
// Bodies of driven_ways.hpp.
#pragma once

#include <LinearMath/btMotionState.h>
#include <LinearMath/btTransformUtil.h>

#include "ductile/bullet/driven_ways.hpp"

namespace ductile::bullet {

DUCTILE_INLINE void DrivenWays::begin(btDiscreteDynamicsWorld& world, btScalar length) {
    ways_.clear();
    length_ = length;
    const auto& objects = world.getCollisionObjectArray();
    for (int i = 0; i < objects.size(); ++i) {
        btRigidBody* body = btRigidBody::upcast(objects[i]);
        if (body == nullptr || !body->isKinematicObject()) continue;
        Way way{body, body->getInterpolationWorldTransform(), body->getWorldTransform()};
        if (body->getMotionState() != nullptr) body->getMotionState()->getWorldTransform(way.to);
        btVector3 velocity, spin;
        btTransformUtil::calculateVelocity(way.from, way.to, length, velocity, spin);
        body->setLinearVelocity(velocity);
        body->setAngularVelocity(spin);
        body->setInterpolationLinearVelocity(velocity);
        body->setInterpolationAngularVelocity(spin);
        ways_.push_back(way);
    }
    place(0);
}

DUCTILE_INLINE void DrivenWays::place(btScalar time) {
    const btScalar share = time / length_;
    for (const auto& [body, from, to] : ways_) {
        btTransform now = share < btScalar(1) - SIMD_EPSILON ? from : to;
        if (share > 0 && share < btScalar(1) - SIMD_EPSILON) {
            now.setOrigin(from.getOrigin().lerp(to.getOrigin(), share));
            now.setRotation(from.getRotation().slerp(to.getRotation(), share));
        }
        body->setWorldTransform(now);
        body->setInterpolationWorldTransform(now);
    }
}

} // namespace ductile::bullet
