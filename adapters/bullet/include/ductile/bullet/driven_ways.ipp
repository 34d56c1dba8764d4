// SPDX-License-Identifier: MIT
//
// Bodies of driven_ways.hpp.
#pragma once

#include <LinearMath/btMotionState.h>
#include <LinearMath/btTransformUtil.h>

#include <algorithm>
#include <utility>

#include "ductile/bullet/convert.hpp"
#include "ductile/bullet/driven_ways.hpp"

namespace ductile::bullet {

DUCTILE_INLINE void DrivenWays::begin(btDiscreteDynamicsWorld& world, btScalar length) {
    std::swap(ways_, last_);
    ways_.clear();
    length_ = length;
    const auto& objects = world.getCollisionObjectArray();
    for (int i = 0; i < objects.size(); ++i) {
        btRigidBody* body = btRigidBody::upcast(objects[i]);
        if (body == nullptr || !body->isKinematicObject()) continue;
        Way way{body, body->getInterpolationWorldTransform(), body->getWorldTransform(), {}};
        if (body->getMotionState() != nullptr) body->getMotionState()->getWorldTransform(way.to);
        const auto before = std::find_if(last_.begin(), last_.end(),
                                         [body](const Way& last) { return last.body == body; });
        if (before != last_.end()) way.course = before->course;
        btVector3 velocity, spin;
        btTransformUtil::calculateVelocity(way.from, way.to, length, velocity, spin);
        BodyState<double> mean;
        mean.velocity = to_core(velocity);
        mean.spin = to_core(spin);
        way.course.begin(mean, double(length));
        ways_.push_back(way);
    }
    place(0, 0, 0);
}

DUCTILE_INLINE void DrivenWays::place(btScalar time, btScalar begun, btScalar then) {
    for (const auto& [body, from, to, course] : ways_) {
        btTransform now = from;
        if (time >= length_ * (1 - SIMD_EPSILON)) {
            now = to;
        } else if (time > 0) {
            const btVector3 turn = to_bullet(course.turn(double(time)));
            now.setOrigin(from.getOrigin() + to_bullet(course.way(double(time))));
            if (turn.length2() > 0) {
                now.setRotation(btQuaternion(turn.normalized(), turn.length()) *
                                from.getRotation());
            }
        }
        body->setWorldTransform(now);
        body->setInterpolationWorldTransform(now);
        body->setLinearVelocity(to_bullet(course.velocity(double(then))));
        body->setAngularVelocity(to_bullet(course.spin(double(then))));
        body->setInterpolationLinearVelocity(to_bullet(course.velocity(double(begun))));
        body->setInterpolationAngularVelocity(to_bullet(course.spin(double(begun))));
    }
}

} // namespace ductile::bullet
