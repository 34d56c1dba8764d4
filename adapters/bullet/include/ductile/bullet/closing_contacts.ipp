// SPDX-License-Identifier: MIT
//
// Bodies of closing_contacts.hpp.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionShapes/btCollisionShape.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ductile/bullet/closing_contacts.hpp"
#include "ductile/bullet/divisibles.hpp"
#include "ductile/bullet/falling_groups.hpp"
#include "ductile/bullet/moving_bodies.hpp"
#include "ductile/bullet/sharp_boxes.hpp"

namespace ductile::bullet {

namespace detail {

/// Null for what a contact cannot push.
[[nodiscard]] DUCTILE_INLINE const btRigidBody* pushed(const btCollisionObject& object) {
    const btRigidBody* body = btRigidBody::upcast(&object);
    const bool moves =
        body != nullptr && !body->isStaticOrKinematicObject() && body->getInvMass() > 0;
    return moves ? body : nullptr;
}

[[nodiscard]] DUCTILE_INLINE btVector3 velocity_at(const btCollisionObject& object,
                                                   const btVector3& point) {
    const btRigidBody* body = btRigidBody::upcast(&object);
    if (body == nullptr) return btVector3(0, 0, 0);
    return body->getVelocityInLocalPoint(point - body->getCenterOfMassPosition());
}

[[nodiscard]] DUCTILE_INLINE double parting_speed(const btCollisionObject& a,
                                                  const btCollisionObject& b,
                                                  const btManifoldPoint& point,
                                                  const btVector3& normal) {
    const btVector3 parts =
        velocity_at(a, point.getPositionWorldOnA()) - velocity_at(b, point.getPositionWorldOnB());
    return double(normal.dot(parts));
}

[[nodiscard]] DUCTILE_INLINE btVector3 spin(const btCollisionObject& object) {
    const btRigidBody* body = btRigidBody::upcast(&object);
    return body != nullptr ? body->getAngularVelocity() : btVector3(0, 0, 0);
}

/// 1/effective mass along `normal` at `point`, of one of the bodies [1/kg].
[[nodiscard]] DUCTILE_INLINE double yield_at(const btCollisionObject& object,
                                             const btVector3& point, const btVector3& normal) {
    const btRigidBody* body = pushed(object);
    return body != nullptr ? double(body->computeImpulseDenominator(point, normal)) : 0.0;
}

/// From the centre of mass to the farthest point of a shape [m]; many bodies have one shape.
class ShapeReach {
  public:
    [[nodiscard]] btScalar of(const btCollisionShape& shape) {
        if (&shape != last_) {
            btVector3 centre;
            btScalar radius;
            shape.getBoundingSphere(centre, radius);
            reach_ = radius + centre.length();
            last_ = &shape;
        }
        return reach_;
    }

  private:
    const btCollisionShape* last_ = nullptr;
    btScalar reach_ = 0;
};

/// No point of the body is faster than |v| plus this [m/s].
[[nodiscard]] DUCTILE_INLINE btScalar turning_speed(const btRigidBody& body, ShapeReach& reach) {
    return body.getAngularVelocity().length() * reach.of(*body.getCollisionShape());
}

/// How far a body may get past something and still be found on this side of it: half of its
/// smallest extent; infinite for what does not move [m].
[[nodiscard]] DUCTILE_INLINE double half_thickness(const btCollisionObject& object) {
    if (pushed(object) == nullptr) return std::numeric_limits<double>::infinity();
    btVector3 low, high;
    object.getCollisionShape()->getAabb(btTransform::getIdentity(), low, high);
    const btVector3 extent = high - low;
    return double(extent[extent.minAxis()]) / 2;
}

struct ClosestPoints final : btCollisionWorld::ContactResultCallback {
    ClosingContacts& found;
    double touching, apart;
    double h;       ///< of the part [s]
    double unseen;  ///< past each other by more than that nobody would find them [m]
    btVector3 fall; ///< acceleration of the first body beside the second [m/s²]
    const btCollisionObject* first;
    struct Nearest {                                           ///< of the points
        double away = std::numeric_limits<double>::infinity(); ///< [m]
        double speed = 0, energy = 0;                          ///< with which it closes [m/s], [J]
        double way = 0;                                        ///< until it is closed [m]
    } nearest{};
    ClosestPoints(ClosingContacts& result, double touch, double open, btScalar reach, double length,
                  const btCollisionObject* a, const btCollisionObject* b, const btVector3& falls)
        : found(result),
          touching(touch),
          apart(open),
          h(length),
          unseen(std::min(half_thickness(*a), half_thickness(*b))),
          fall(falls),
          first(a) {
        m_closestDistanceThreshold =
            reach + rounding(*a->getCollisionShape()) + rounding(*b->getCollisionShape());
    }
    /// Towards the second body, of who begins to fall on it [m/s²].
    [[nodiscard]] double gain(const btCollisionObject& a, const btVector3& normal) const {
        return std::max(0.0, (&a == first ? -1 : 1) * double(normal.dot(fall)));
    }
    btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper* a, int, int,
                             const btCollisionObjectWrapper* b, int, int) override {
        const btCollisionObject &of_a = *a->getCollisionObject(), &of_b = *b->getCollisionObject();
        const btVector3 &on_a = point.getPositionWorldOnA(), &on_b = point.getPositionWorldOnB();
        const auto [away, normal] = gap_at(point, *a, *b);
        const double speed = -parting_speed(of_a, of_b, point, normal);
        const double yields = yield_at(of_a, on_a, normal) + yield_at(of_b, on_b, normal);
        const double faster = gain(of_a, normal);
        const double taken = speed > 0 && yields > 0 ? speed * speed / (2 * yields) : 0;
        const double gap = std::max(away, 0.0);
        const btVector3 turns =
            speed > 0 ? btScalar(gap / speed) * (spin(of_a) - spin(of_b)) : btVector3(0, 0, 0);
        const double way = gap + closed_gap / 2 + flush_depth(normal, *a, *b, turns);
        if (away < nearest.away) nearest = {away, speed, taken, way};
        if (faster > 0 && yields > 0 && away > -closed_gap / 2) {
            const double end = std::max(speed, 0.0) + faster * h;
            if (!(end * end > 2 * yields * apart)) return 0;
            const double at = std::sqrt(speed * speed + 2 * faster * way);
            found.time = std::min(found.time, 2 * way / (speed + at));
            return 0;
        }
        if (!(speed > 0) || !(yields > 0)) return 0;
        const bool touches = away < closed_gap;
        found.strikes = found.strikes || (touches && taken > touching);
        // what a blow does not know is not closed for Bullet
        const bool counts = touches ? away > -closed_gap / 4 && taken > touching
                                    : taken > apart || speed * h / 2 - away > unseen;
        if (counts) found.time = std::min(found.time, way / speed);
        return 0;
    }
};

} // namespace detail

DUCTILE_INLINE ClosingContacts ClosingContactsFinder::find(btDiscreteDynamicsWorld& world, double h,
                                                           double touching, double apart) {
    ClosingContacts found;
    found_islands_ = false;
    found_bodies_.clear();
    foreign_.clear();
    open_.clear();
    const double least = std::min(touching, apart);
    find_falling(world, btScalar(h));
    const Fastest fastest = find_fastest(world, btScalar(h));
    if (4 * fastest.speed * fastest.speed <= 2 * fastest.inverse_mass * least) return found;
    find_islands(world);
    if (joined_.empty() && members_->empty()) return found;
    list_pairs(world, btScalar(h), least, btScalar(fastest.speed));
    for (const Pair& pair : pairs_) {
        ClosingContacts of_pair;
        detail::ClosestPoints points(of_pair, touching, apart, pair.reach, h, pair.a, pair.b,
                                     falls(*pair.a) - falls(*pair.b));
        world.contactPairTest(pair.a, pair.b, points);
        found.strikes = found.strikes || of_pair.strikes;
        found.time = std::min(found.time, of_pair.time);
        if (of_pair.strikes || of_pair.time <= h) note_found(*pair.a, *pair.b);
        if (points.nearest.away > 0) {
            open_.push_back({pair, points.nearest.way, points.nearest.speed});
        }
    }
    return found;
}

DUCTILE_INLINE void ClosingContactsFinder::note_found(const btCollisionObject& a,
                                                      const btCollisionObject& b) {
    for (const btCollisionObject* object : {&a, &b}) {
        if (const btRigidBody* body = detail::pushed(*object)) found_bodies_.push_back(body);
    }
}

DUCTILE_INLINE std::span<btRigidBody* const> ClosingContactsFinder::bodies(
    const btDiscreteDynamicsWorld& world) const {
    return scope_ != nullptr ? scope_->bodies() : MovingBodies::all(world);
}

/// Many of Bullet's algorithms see no contact before shapes overlap: what was just put down on
/// something falls for a part, and then strikes it. What hangs together falls if nothing holds any
/// of it.
DUCTILE_INLINE void ClosingContactsFinder::find_falling(btDiscreteDynamicsWorld& world,
                                                        btScalar h) {
    falling_.clear();
    if (scope_ != nullptr) return; // the frame's first look is at all
    std::vector<const btRigidBody*> slow;
    for (const btRigidBody* body : bodies(world)) {
        const btScalar gain = body->getGravity().length() * h;
        if (body->isActive() && body->getInvMass() > 0 &&
            body->getLinearVelocity().length2() < gain * gain) {
            slow.push_back(body);
        }
    }
    if (slow.empty()) return;
    FallingGroups groups(world.getNumCollisionObjects(), slow);
    // not by their constraint references, which only those have whose bodies do not collide
    for (int i = 0; i < world.getNumConstraints(); ++i) {
        btTypedConstraint& constraint = *world.getConstraint(i);
        if (!constraint.isEnabled()) continue;
        groups.join(constraint.getRigidBodyA(), constraint.getRigidBodyB());
    }
    btDispatcher& dispatcher = *world.getDispatcher();
    for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
        const btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(i);
        const btCollisionObject &a = *manifold.getBody0(), &b = *manifold.getBody1();
        if (manifold.getNumContacts() == 0 || !dispatcher.needsResponse(&a, &b)) continue;
        groups.hold(a);
        groups.hold(b);
    }
    std::erase_if(slow, [&groups](const btRigidBody* body) { return groups.is_held(*body); });
    falling_ = std::move(slow);
    std::sort(falling_.begin(), falling_.end());
}

/// Acceleration of a body that nothing holds and that just begins to move, else zero [m/s²].
DUCTILE_INLINE btVector3 ClosingContactsFinder::falls(const btCollisionObject& object) const {
    const btRigidBody* body = btRigidBody::upcast(&object);
    const bool does = body != nullptr && std::binary_search(falling_.begin(), falling_.end(), body);
    return does ? body->getGravity() : btVector3(0, 0, 0);
}

DUCTILE_INLINE auto ClosingContactsFinder::find_fastest(const btDiscreteDynamicsWorld& world,
                                                        btScalar h) const -> Fastest {
    btScalar speed = 0, inverse_mass = SIMD_INFINITY;
    detail::ShapeReach reach;
    const auto see = [&](const btRigidBody& body) {
        speed =
            std::max(speed, body.getLinearVelocity().length() + detail::turning_speed(body, reach));
    };
    for (const btRigidBody* body : bodies(world)) {
        if (body->getInvMass() > 0) inverse_mass = std::min(inverse_mass, body->getInvMass());
        if (body->isActive()) see(*body);
    }
    driven_.each(see);
    for (const btRigidBody* body : falling_) {
        speed = std::max(speed, 2 * h * body->getGravity().length());
    }
    return {double(speed), double(inverse_mass)};
}

DUCTILE_INLINE double ClosingContactsFinder::closed_early(btDiscreteDynamicsWorld& world, double h,
                                                          double apart) {
    constexpr double earliest = 0.5; // of the part
    double first = h;
    btDispatcher& dispatcher = *world.getDispatcher();
    const int count =
        scope_ != nullptr ? int(scope_->manifolds().size()) : dispatcher.getNumManifolds();
    found_bodies_.clear();
    for (int i = 0; i < count; ++i) {
        const btPersistentManifold& manifold = scope_ != nullptr
                                                   ? *scope_->manifolds()[std::size_t(i)]
                                                   : *dispatcher.getManifoldByIndexInternal(i);
        double impulse = 0;
        const btManifoldPoint* nearest = nullptr;
        for (int k = 0; k < manifold.getNumContacts(); ++k) {
            const btManifoldPoint& point = manifold.getContactPoint(k);
            if (!(point.m_appliedImpulse > 0) || !(double(point.getDistance()) > closed_gap)) {
                continue;
            }
            impulse += double(point.m_appliedImpulse);
            if (nearest == nullptr || point.getDistance() < nearest->getDistance()) {
                nearest = &point;
            }
        }
        if (nearest == nullptr) continue;
        if (!found_islands_) find_islands(world);
        const btCollisionObject &a = *manifold.getBody0(), &b = *manifold.getBody1();
        const btRigidBody *of_a = detail::pushed(a), *of_b = detail::pushed(b);
        const bool plastic = (of_a != nullptr && is_plastic(*of_a)) ||
                             (of_b != nullptr && is_plastic(*of_b)) || is_still_member(a) ||
                             is_still_member(b);
        if (!plastic) continue;
        const btVector3& normal = nearest->m_normalWorldOnB;
        const double yields = detail::yield_at(a, nearest->getPositionWorldOnA(), normal) +
                              detail::yield_at(b, nearest->getPositionWorldOnB(), normal);
        const double speed = 2 * double(nearest->getDistance()) / h;
        if (!(speed * speed > 2 * yields * apart)) continue;
        const double taken = impulse * yields;
        note_found(a, b);
        first = std::min(first, h * std::max(earliest, 1 - taken / (2 * (speed + taken))));
    }
    first = std::min(first, passed(world, h, apart));
    return first < h ? first : 0;
}

DUCTILE_INLINE double ClosingContactsFinder::passed(btDiscreteDynamicsWorld& world, double h,
                                                    double apart) {
    double first = h;
    for (const auto& [pair, way, speed] : open_) {
        ClosingContacts none;
        detail::ClosestPoints now(none, apart, apart, 0, h, pair.a, pair.b, btVector3(0, 0, 0));
        world.contactPairTest(pair.a, pair.b, now);
        if (!(now.nearest.away < -closed_gap) || !(now.nearest.energy > apart)) continue;
        const double gain = (now.nearest.speed - speed) / h;
        if (!(gain > 0)) continue;
        note_found(*pair.a, *pair.b);
        first = std::min(first, 2 * way / (speed + std::sqrt(speed * speed + 2 * gain * way)));
    }
    return first;
}

} // namespace ductile::bullet

#include "ductile/bullet/closing_pairs.ipp" // IWYU pragma: keep
