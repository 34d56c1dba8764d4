// SPDX-License-Identifier: MIT
//
// Bodies of closing_contacts.hpp.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionDispatch/btManifoldResult.h>
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "ductile/bullet/closing_contacts.hpp"
#include "ductile/bullet/closing_points.ipp" // IWYU pragma: keep
#include "ductile/bullet/divisibles.hpp"
#include "ductile/bullet/falling_groups.hpp"
#include "ductile/bullet/moving_bodies.hpp"
#include "ductile/bullet/soft_contacts.hpp"

namespace ductile::bullet {

namespace detail {

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

} // namespace detail

DUCTILE_INLINE ClosingContacts ClosingContactsFinder::find(btDiscreteDynamicsWorld& world, double h,
                                                           double touching, double apart) {
    ClosingContacts found;
    found_islands_ = false;
    found_bodies_.clear();
    foreign_.clear();
    open_.clear();
    struck_.clear();
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
        const std::optional<SoftContact> soft =
            soft_contact(*pair.a, *pair.b, points.nearest.at, points.nearest.normal, frame_);
        const double stiffness = soft ? soft->stiffness : 0;
        if (soft && !(points.nearest.away > closed_gap)) { // it is no blow, but swings
            note_found(*pair.a, *pair.b);
            open_.push_back({pair, stiffness, true, points.nearest.away, points.nearest.speed});
            if (points.nearest.speed > 0) { // a part is not to carry it past what it presses
                found.time = std::min(found.time, points.unseen / points.nearest.speed);
            }
            continue;
        }
        if (pair.turns && !of_pair.strikes) look_ahead(world, pair, h, touching, apart, of_pair);
        if (soft) of_pair.strikes = false;
        if (of_pair.strikes) {
            detail::PointsElsewhere(of_pair, struck_, touching, apart, *pair.a, *pair.b)
                .look_around(world, points.nearest.at, points.nearest.normal);
        }
        found.strikes = found.strikes || of_pair.strikes;
        found.time = std::min(found.time, of_pair.time);
        if (of_pair.strikes || of_pair.time <= h) note_found(*pair.a, *pair.b);
        if (points.nearest.away > 0 || pair.turns) {
            open_.push_back({pair, stiffness, !(points.nearest.away > 0), points.nearest.way,
                             points.nearest.speed});
        }
    }
    return found;
}

/// As often as it takes to see the thinner of the two pass.
DUCTILE_INLINE void ClosingContactsFinder::look_ahead(btDiscreteDynamicsWorld& world,
                                                      const Pair& pair, double h, double touching,
                                                      double apart, ClosingContacts& found) {
    constexpr double most = 8;
    const double until = std::min(h, found.time);
    const double passes =
        std::min(detail::half_thickness(*pair.a), detail::half_thickness(*pair.b));
    const double looks = std::clamp(std::ceil(double(pair.reach) * until / h / passes), 1.0, most);
    for (double i = 1; i <= looks && !found.strikes && !(found.time < until); ++i) {
        detail::PointsElsewhere points(found, struck_, touching, apart, *pair.a, *pair.b);
        points.look_ahead(world, until * i / looks);
    }
}

DUCTILE_INLINE void ClosingContactsFinder::show_struck(btDiscreteDynamicsWorld& world) const {
    for (const auto& [a, b, normal, on_b, gap] : struck_) {
        const btManifoldArray manifolds = manifolds_between(world, *a, *b);
        if (manifolds.size() == 0) continue;
        const btCollisionObject *one = manifolds[0]->getBody0(), *two = manifolds[0]->getBody1();
        const btCollisionObjectWrapper of_one(nullptr, one->getCollisionShape(), one,
                                              one->getWorldTransform(), -1, -1),
            of_two(nullptr, two->getCollisionShape(), two, two->getWorldTransform(), -1, -1);
        btManifoldResult result(&of_one, &of_two);
        result.setPersistentManifold(manifolds[0]);
        if (two == b) {
            result.addContactPoint(normal, on_b, btScalar(gap));
        } else { // Bullet wants it on the second one
            result.addContactPoint(-normal, on_b + btScalar(gap) * normal, btScalar(gap));
        }
    }
}

DUCTILE_INLINE void ClosingContactsFinder::note_found(const btCollisionObject& a,
                                                      const btCollisionObject& b) {
    for (const btCollisionObject* object : {&a, &b}) {
        if (const btRigidBody* body = detail::pushed(*object)) found_bodies_.push_back(body);
    }
}

/// Many of Bullet's algorithms see no contact before shapes overlap: what was just put down on
/// something falls for a part, and then strikes it. What hangs together falls if nothing holds any
/// of it.
DUCTILE_INLINE void ClosingContactsFinder::find_falling(btDiscreteDynamicsWorld& world,
                                                        btScalar h) {
    falling_.clear();
    if (scope_ != nullptr) return; // the frame's first look is at all
    std::vector<const btRigidBody*> slow;
    for (const btRigidBody* body : bodies_of(world, scope_)) {
        const btScalar gain = body->getGravity().length() * h;
        if (body->isActive() && body->getInvMass() > 0 &&
            body->getLinearVelocity().length2() < gain * gain) {
            slow.push_back(body);
        }
    }
    if (slow.empty()) return;
    FallingGroups groups(world.getNumCollisionObjects(), slow);
    // not by their constraint references, which only those have whose bodies do not collide
    for (btTypedConstraint* constraint : constraints_of(world, nullptr)) {
        if (!constraint->isEnabled()) continue;
        groups.join(constraint->getRigidBodyA(), constraint->getRigidBodyB());
    }
    btDispatcher& dispatcher = *world.getDispatcher();
    for (const btPersistentManifold* manifold : manifolds_of(dispatcher, nullptr)) {
        const btCollisionObject &a = *manifold->getBody0(), &b = *manifold->getBody1();
        if (manifold->getNumContacts() == 0 || !dispatcher.needsResponse(&a, &b)) continue;
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
    any_soft_ = false;
    const auto see = [&](const btRigidBody& body) {
        any_soft_ = any_soft_ || may_give_way(body);
        speed =
            std::max(speed, body.getLinearVelocity().length() + detail::turning_speed(body, reach));
    };
    for (const btRigidBody* body : bodies_of(world, scope_)) {
        if (body->getInvMass() > 0) inverse_mass = std::min(inverse_mass, body->getInvMass());
        if (body->isActive()) see(*body);
    }
    driven_.each(see);
    for (const btRigidBody* body : falling_) {
        speed = std::max(speed, 2 * h * body->getGravity().length());
    }
    if (any_soft_) speed += h * world.getGravity().length();
    return {double(speed), double(inverse_mass)};
}

DUCTILE_INLINE double ClosingContactsFinder::closed_early(btDiscreteDynamicsWorld& world, double h,
                                                          double apart) {
    constexpr double earliest = 0.5; // of the part
    double first = h;
    found_bodies_.clear();
    for (const btPersistentManifold* each : manifolds_of(*world.getDispatcher(), scope_)) {
        const btPersistentManifold& manifold = *each;
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

DUCTILE_INLINE bool ClosingContactsFinder::pushes(btDiscreteDynamicsWorld& world,
                                                  const Pair& pair) {
    const btManifoldArray manifolds = manifolds_between(world, *pair.a, *pair.b);
    bool any = false;
    for (int i = 0; i < manifolds.size(); ++i) {
        for (int k = 0; k < manifolds[i]->getNumContacts(); ++k) {
            any = any || manifolds[i]->getContactPoint(k).getAppliedImpulse() > 0;
        }
    }
    return any;
}

DUCTILE_INLINE double ClosingContactsFinder::passed(btDiscreteDynamicsWorld& world, double h,
                                                    double apart) {
    double first = h;
    for (const auto& [pair, stiffness, touched, way, speed] : open_) {
        if (stiffness > 0 && touched && pushes(world, pair)) continue;
        ClosingContacts none;
        detail::ClosestPoints now(none, apart, apart, 0, h, pair.a, pair.b, btVector3(0, 0, 0));
        world.contactPairTest(pair.a, pair.b, now);
        const double overlap = now.nearest.away,
                     energy = std::max(now.nearest.energy, stiffness * overlap * overlap / 2);
        if (!(overlap < -closed_gap) || !(energy > apart)) continue;
        const double gain = (now.nearest.speed - speed) / h;
        if (!(gain > 0)) continue;
        note_found(*pair.a, *pair.b);
        const double square = std::max(0.0, speed * speed + 2 * gain * way);
        const double closed =
            speed > 0 ? time_to_close(way, speed, gain) : (std::sqrt(square) - speed) / gain;
        first = std::min(first, touched ? std::max(closed, h / 2) : closed);
    }
    return first;
}

} // namespace ductile::bullet

#include "ductile/bullet/closing_pairs.ipp" // IWYU pragma: keep
