// SPDX-License-Identifier: MIT
//
// Bodies of closing_contacts.hpp: islands with plastic joints, and the pairs that may reach them. A
// part of closing_contacts.ipp.
#pragma once

#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>

#include <algorithm>
#include <vector>

namespace ductile::bullet {

DUCTILE_INLINE void ClosingContactsFinder::find_islands(btDiscreteDynamicsWorld& world) {
    found_islands_ = true;
    joined_.clear();
    islands_.clear();
    if (scope_ != nullptr) {
        for (const btTypedConstraint* constraint : scope_->constraints()) add_joint(*constraint);
    } else {
        for (int i = 0; i < world.getNumConstraints(); ++i) add_joint(*world.getConstraint(i));
    }
    const auto sort_once = [](auto& items) {
        std::sort(items.begin(), items.end());
        items.erase(std::unique(items.begin(), items.end()), items.end());
    };
    sort_once(joined_);
    sort_once(islands_);
}

DUCTILE_INLINE void ClosingContactsFinder::add_joint(const btTypedConstraint& constraint) {
    if (constraint.getConstraintType() != plastic_constraint_type || !constraint.isEnabled())
        return;
    for (const btRigidBody* body : {&constraint.getRigidBodyA(), &constraint.getRigidBodyB()}) {
        if (detail::pushed(*body) == nullptr) continue;
        joined_.push_back(body);
        if (body->getIslandTag() >= 0) islands_.push_back(body->getIslandTag());
    }
}

DUCTILE_INLINE bool ClosingContactsFinder::is_plastic(const btRigidBody& body) const {
    return std::binary_search(joined_.begin(), joined_.end(), &body) || members_->is_member(body) ||
           (body.getIslandTag() >= 0 &&
            std::binary_search(islands_.begin(), islands_.end(), body.getIslandTag()));
}

DUCTILE_INLINE bool ClosingContactsFinder::is_still_member(const btCollisionObject& object) const {
    return detail::pushed(object) == nullptr && members_->is_member(object);
}

DUCTILE_INLINE void ClosingContactsFinder::list_pairs(btDiscreteDynamicsWorld& world, btScalar h,
                                                      double least, btScalar fastest) {
    const auto& objects = world.getCollisionObjectArray();
    const int count = scope_ != nullptr ? int(scope_->bodies().size()) : objects.size();
    detail::ShapeReach reach_of, reach_of_mate;
    constexpr btScalar margin = btScalar(1e-3);
    pairs_.clear();
    struct Near final : btBroadphaseAabbCallback {
        std::vector<btCollisionObject*> found;
        bool process(const btBroadphaseProxy* proxy) override {
            found.push_back(static_cast<btCollisionObject*>(proxy->m_clientObject));
            return true;
        }
    } near;
    btOverlappingPairCache& cache = *world.getPairCache();
    for (int i = 0; i < count; ++i) {
        btRigidBody* body =
            scope_ != nullptr ? scope_->bodies()[std::size_t(i)] : btRigidBody::upcast(objects[i]);
        if (body == nullptr || body->getBroadphaseHandle() == nullptr ||
            !(detail::pushed(*body) != nullptr ? is_plastic(*body) : is_still_member(*body))) {
            continue;
        }
        const bool still = detail::pushed(*body) == nullptr;
        const btScalar turning = detail::turning_speed(*body, reach_of);
        const btScalar speed = body->getLinearVelocity().length() + turning;
        const double most = double(speed + fastest);
        if (!(most * most > 2 * double(body->getInvMass()) * least)) continue;
        btVector3 low, high;
        body->getAabb(low, high);
        const btScalar swept = (speed + fastest) * h + margin;
        const btVector3 around(swept, swept, swept);
        near.found.clear();
        world.getBroadphase()->aabbTest(low - around, high + around, near);
        for (btCollisionObject* other : near.found) {
            btRigidBody* mate = btRigidBody::upcast(other);
            if (other == body || other->getBroadphaseHandle() == nullptr) continue;
            // seen from there
            if (still &&
                (mate == nullptr || detail::pushed(*mate) == nullptr || is_plastic(*mate))) {
                continue;
            }
            // both ways only once
            if (mate != nullptr && detail::pushed(*mate) != nullptr && is_plastic(*mate) &&
                other->getWorldArrayIndex() < body->getWorldArrayIndex()) {
                continue;
            }
            const btVector3 away =
                body->getLinearVelocity() -
                (mate != nullptr ? mate->getLinearVelocity() : btVector3(0, 0, 0));
            const btScalar closing =
                away.length() + turning + h * (falls(*body) - falls(*other)).length() +
                (mate != nullptr ? detail::turning_speed(*mate, reach_of_mate) : btScalar(0));
            const double yields =
                double(body->getInvMass()) +
                (detail::pushed(*other) != nullptr ? double(mate->getInvMass()) : 0.0);
            if (!(double(closing * closing) > 2 * yields * least)) continue;
            const btScalar reach = closing * h + margin;
            btVector3 from, to;
            other->getCollisionShape()->getAabb(other->getWorldTransform(), from, to);
            bool meet = true;
            for (int k = 0; k < 3; ++k) {
                meet = meet && from[k] - reach <= high[k] && to[k] + reach >= low[k];
            }
            if (!meet || !cache.needsBroadphaseCollision(body->getBroadphaseHandle(),
                                                         other->getBroadphaseHandle())) {
                continue;
            }
            if (!world.getDispatcher()->needsCollision(body, other)) continue;
            if (scope_ != nullptr && mate != nullptr && detail::pushed(*other) != nullptr &&
                !scope_->has(*other)) {
                foreign_.push_back(mate); // where it is now is not where it was
            } else {
                pairs_.push_back({body, other, reach});
            }
        }
    }
}

} // namespace ductile::bullet
