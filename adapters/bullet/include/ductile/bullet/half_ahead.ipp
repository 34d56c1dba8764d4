// SPDX-License-Identifier: MIT
//
// Bodies of half_ahead.hpp.
#pragma once

#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <LinearMath/btTransformUtil.h>

#include <algorithm>
#include <utility>

#include "ductile/bullet/half_ahead.hpp"

namespace ductile::bullet {

namespace detail {

/// Bullet's own list is not public.
struct ActionArray : btDiscreteDynamicsWorld {
    static auto& of(btDiscreteDynamicsWorld& world) { return world.*(&ActionArray::m_actions); }
};

/// A body that a tick moves; null for any other.
[[nodiscard]] DUCTILE_INLINE btRigidBody* awake_body(btCollisionObject& object) {
    btRigidBody* body = btRigidBody::upcast(&object);
    const bool moves = body != nullptr && !body->isStaticOrKinematicObject() && body->isActive();
    return moves ? body : nullptr;
}

[[nodiscard]] DUCTILE_INLINE btTransform moved(const btRigidBody& body, const btTransform& from,
                                               btScalar time) {
    btTransform result;
    btTransformUtil::integrateTransform(from, body.getLinearVelocity(), body.getAngularVelocity(),
                                        time, result);
    return result;
}

} // namespace detail

DUCTILE_INLINE HalfAhead::HalfAhead(btDiscreteDynamicsWorld& world) : world_(world) {
    auto& actions = detail::ActionArray::of(world_);
    actions.push_back(this);
    for (int i = actions.size() - 1; i > 0; --i) actions.swap(i, i - 1);
}

DUCTILE_INLINE void HalfAhead::leave() {
    // not by removeAction, which puts the last of the list in its place
    auto& actions = detail::ActionArray::of(world_);
    const int here = actions.findLinearSearch(this);
    if (here == actions.size()) return;
    for (int i = here; i + 1 < actions.size(); ++i) actions.swap(i, i + 1);
    actions.pop_back();
}

DUCTILE_INLINE void HalfAhead::move(btScalar h, DrivenWays& ways, btScalar time) {
    ways.place(time + h / 2, time + h);
    ways_ = &ways;
    end_ = time + h;
    const auto& objects = world_.getCollisionObjectArray();
    middles_.assign(std::size_t(objects.size()), {});
    for (int i = 0; i < objects.size(); ++i) {
        btRigidBody* body = detail::awake_body(*objects[i]);
        if (body == nullptr) continue;
        Middle& middle = middles_[std::size_t(i)];
        middle.body = body;
        middle.transform = detail::moved(*body, body->getCenterOfMassTransform(), h / 2);
        body->setCenterOfMassTransform(middle.transform);
    }
    moved_ = true;
}

DUCTILE_INLINE void HalfAhead::updateAction(btCollisionWorld* /*world*/, btScalar h) {
    if (!std::exchange(moved_, false)) return;
    ways_->place(end_, end_);
    const auto& objects = world_.getCollisionObjectArray();
    for (int i = 0; i < objects.size(); ++i) {
        btRigidBody* body = detail::awake_body(*objects[i]);
        if (body == nullptr) continue;
        const bool known = i < int(middles_.size()) && middles_[std::size_t(i)].body == body;
        if (known) {
            const btScalar share = std::min(btScalar(0.5), body->getHitFraction());
            body->setCenterOfMassTransform(
                detail::moved(*body, middles_[std::size_t(i)].transform, share * h));
        } else {
            body->setCenterOfMassTransform(
                detail::moved(*body, body->getCenterOfMassTransform(), -h / 2));
        }
    }
}

} // namespace ductile::bullet
