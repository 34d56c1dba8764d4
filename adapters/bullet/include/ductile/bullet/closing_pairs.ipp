// SPDX-License-Identifier: MIT
//
// Bodies of closing_contacts.hpp: islands with plastic joints, and the pairs that may reach them. A
// part of closing_contacts.ipp.
#pragma once

#include <BulletCollision/BroadphaseCollision/btCollisionAlgorithm.h>
#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>

#include <tuple>
#include <typeinfo>

namespace ductile::bullet {

DUCTILE_INLINE void ClosingContactsFinder::find_islands(btDiscreteDynamicsWorld& world) {
    found_islands_ = true;
    joined_.clear();
    islands_.clear();
    for (const btTypedConstraint* joint : constraints_of(world, scope_)) add_joint(*joint);
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

namespace detail {

/// Beyond what bodies may come nearer each other [m].
inline constexpr btScalar near_margin = btScalar(1e-3);

/// Whether Bullet has all that the body may come near in time among its pairs: these are of bodies
/// whose leaves in its trees meet, and a leaf has room around its body.
[[nodiscard]] DUCTILE_INLINE bool stays_in_leaf(const btRigidBody& body, btScalar reach) {
    const btDbvtVolume& leaf =
        static_cast<const btDbvtProxy*>(body.getBroadphaseHandle())->leaf->volume;
    btVector3 low, high;
    body.getAabb(low, high);
    bool inside = true;
    for (int k = 0; k < 3; ++k) {
        inside = inside && leaf.Mins()[k] <= low[k] - reach && leaf.Maxs()[k] >= high[k] + reach;
    }
    return inside;
}

/// Whether Bullet would make contacts of the two, and let these push: sensors do not, nor what the
/// user's own callback of near pairs leaves out. That is asked with a pair that is in no list.
[[nodiscard]] DUCTILE_INLINE bool may_push(btDiscreteDynamicsWorld& world, btCollisionObject& a,
                                           btCollisionObject& b) {
    btBroadphaseProxy &of_a = *a.getBroadphaseHandle(), &of_b = *b.getBroadphaseHandle();
    btDispatcher& dispatcher = *world.getDispatcher();
    if (!world.getPairCache()->needsBroadphaseCollision(&of_a, &of_b) ||
        !dispatcher.needsCollision(&a, &b) || !dispatcher.needsResponse(&a, &b)) {
        return false;
    }
    auto* own = dynamic_cast<btCollisionDispatcher*>(&dispatcher);
    if (own == nullptr || own->getNearCallback() == &btCollisionDispatcher::defaultNearCallback) {
        return true;
    }
    btBroadphasePair pair(of_a, of_b);
    own->getNearCallback()(pair, *own, world.getDispatchInfo());
    if (pair.m_algorithm == nullptr) return false;
    pair.m_algorithm->~btCollisionAlgorithm();
    own->freeCollisionAlgorithm(pair.m_algorithm);
    return true;
}

} // namespace detail

/// How far the body may come in `h` [m].
DUCTILE_INLINE btScalar ClosingContactsFinder::reach(const btRigidBody& body, btScalar h,
                                                     detail::ShapeReach& shapes) const {
    const btScalar speed = body.getLinearVelocity().length() + detail::turning_speed(body, shapes) +
                           h * falls(body).length();
    const btScalar gain = any_soft_ ? body.getGravity().length() * h * h : btScalar(0);
    return speed * h + gain + detail::near_margin;
}

DUCTILE_INLINE bool ClosingContactsFinder::is_struck_on(const btRigidBody& body) const {
    return detail::pushed(body) != nullptr ? is_plastic(body) : is_still_member(body);
}

/// Either each that may be struck looks around, or what goes far does, and the rest is in Bullet's
/// own pairs: whichever is less.
DUCTILE_INLINE void ClosingContactsFinder::list_pairs(btDiscreteDynamicsWorld& world, btScalar h,
                                                      double least, btScalar fastest) {
    const auto& objects = world.getCollisionObjectArray();
    const int count = scope_ != nullptr ? int(scope_->bodies().size()) : objects.size();
    const btBroadphaseInterface& broadphase = *world.getBroadphase();
    const bool has_leaves = scope_ == nullptr && typeid(broadphase) == typeid(btDbvtBroadphase);
    detail::ShapeReach shapes;
    const bool all_look = scope_ != nullptr && !members_->empty(); // still ones are in no scope
    std::vector<btRigidBody*> fast, struck, far;
    pairs_.clear();
    for (int i = 0; i < count; ++i) {
        btRigidBody* body =
            scope_ != nullptr ? scope_->bodies()[std::size_t(i)] : btRigidBody::upcast(objects[i]);
        if (body == nullptr || body->getBroadphaseHandle() == nullptr) continue;
        const btScalar way = reach(*body, h, shapes);
        const double most = double(way / h + fastest);
        if (most * most > 2 * double(body->getInvMass()) * least) fast.push_back(body);
        if (has_leaves && !stands(*body) && !detail::stays_in_leaf(*body, way)) {
            far.push_back(body);
        }
    }
    btOverlappingPairCache& cache = *world.getPairCache();
    bool by_pairs = false;
    for (btRigidBody* body : fast) {
        if (all_look || is_struck_on(*body)) struck.push_back(body);
        by_pairs = has_leaves && far.size() < struck.size();
        if (by_pairs) break;
    }
    for (btRigidBody* body : by_pairs ? far : struck) {
        struct Near final : btBroadphaseAabbCallback {
            std::vector<btCollisionObject*> found;
            bool process(const btBroadphaseProxy* proxy) override {
                found.push_back(static_cast<btCollisionObject*>(proxy->m_clientObject));
                return true;
            }
        } near;
        btVector3 low, high;
        body->getAabb(low, high);
        const btScalar swept = reach(*body, h, shapes) + fastest * h;
        const btVector3 around(swept, swept, swept);
        world.getBroadphase()->aabbTest(low - around, high + around, near);
        for (btCollisionObject* other : near.found) {
            if (other != body) add_pair(world, *body, *other, h, least, shapes);
        }
    }
    if (by_pairs) {
        const btBroadphasePair* pairs = cache.getOverlappingPairArrayPtr();
        for (int i = 0; i < cache.getNumOverlappingPairs(); ++i) {
            add_pair(world, *static_cast<btCollisionObject*>(pairs[i].m_pProxy0->m_clientObject),
                     *static_cast<btCollisionObject*>(pairs[i].m_pProxy1->m_clientObject), h, least,
                     shapes);
        }
    }
    const auto place = [](const Pair& pair) {
        return std::pair(pair.a->getWorldArrayIndex(), pair.b->getWorldArrayIndex());
    };
    std::sort(pairs_.begin(), pairs_.end(),
              [&place](const Pair& x, const Pair& y) { return place(x) < place(y); });
    pairs_.erase(
        std::unique(pairs_.begin(), pairs_.end(),
                    [&place](const Pair& x, const Pair& y) { return place(x) == place(y); }),
        pairs_.end());
}

/// Where one of them may be struck by the other in `h`, with an energy of `least` [J] or more.
DUCTILE_INLINE void ClosingContactsFinder::add_pair(btDiscreteDynamicsWorld& world,
                                                    btCollisionObject& one, btCollisionObject& two,
                                                    btScalar h, double least,
                                                    detail::ShapeReach& shapes) {
    if (detail::pushed(one) == nullptr && detail::pushed(two) == nullptr) return;
    btRigidBody *of_one = btRigidBody::upcast(&one), *of_two = btRigidBody::upcast(&two);
    const bool one_counts = of_one != nullptr && is_struck_on(*of_one),
               two_counts = of_two != nullptr && is_struck_on(*of_two);
    if (!(one_counts || two_counts)) return;
    // seen from what moves, and from that which comes first
    const auto rank = [](bool counts, const btCollisionObject& object) {
        return std::tuple(!counts, detail::pushed(object) == nullptr, object.getWorldArrayIndex());
    };
    const bool first = rank(one_counts, one) < rank(two_counts, two);
    btRigidBody* body = first ? of_one : of_two;
    btCollisionObject* other = first ? &two : &one;
    btRigidBody* mate = first ? of_two : of_one;
    if (other->getBroadphaseHandle() == nullptr) return;
    const btVector3 away = body->getLinearVelocity() -
                           (mate != nullptr ? mate->getLinearVelocity() : btVector3(0, 0, 0));
    const btScalar turning = detail::turning_speed(*body, shapes) +
                             (mate != nullptr ? detail::turning_speed(*mate, shapes) : btScalar(0));
    btScalar closing = away.length() + turning + h * (falls(*body) - falls(*other)).length();
    if (may_give_way(*body) || may_give_way(*other)) closing += h * world.getGravity().length();
    const double yields = double(body->getInvMass()) +
                          (detail::pushed(*other) != nullptr ? double(mate->getInvMass()) : 0.0);
    if (!(double(closing * closing) > 2 * yields * least)) return;
    const btScalar reach = closing * h + detail::near_margin;
    btVector3 low, high, from, to;
    body->getAabb(low, high);
    other->getCollisionShape()->getAabb(other->getWorldTransform(), from, to);
    bool meet = true;
    for (int k = 0; k < 3; ++k) {
        meet = meet && from[k] - reach <= high[k] && to[k] + reach >= low[k];
    }
    if (!meet || !detail::may_push(world, *body, *other)) return;
    if (scope_ != nullptr && mate != nullptr && detail::pushed(*other) != nullptr &&
        !scope_->has(*other)) {
        foreign_.push_back(mate); // where it is now is not where it was
    } else {
        const bool turns = double(4 * turning * turning) > 2 * yields * least;
        pairs_.push_back({body, other, reach, turns});
    }
}

} // namespace ductile::bullet
