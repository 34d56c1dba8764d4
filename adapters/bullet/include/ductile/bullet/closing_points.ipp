// SPDX-License-Identifier: MIT
//
// Bodies of closing_contacts.hpp: what Bullet tells of the closest points of two bodies, and how it
// is asked for others. A part of closing_contacts.ipp.
//
// Of two convex shapes Bullet tells one point. But a bar that stands on one end slaps with the
// other, and an edge lands with both of its corners. So bodies are put for a moment
//
//   ahead   where they go by their velocities in a time t: of a point that overlaps there by d it
//   is
//           known how far apart it is now, g, and how fast it closes now, u. At a constant gain of
//           speed a = 2 ((g + d)/t - u)/t it closes after 2 g/(u + √(u² + 2 a g))
//   around  turned by 1 mrad about a point that touches, to all sides: what overlaps there, and is
//           as good as flush with it now, touches too
//
// and what they overlap in is a point of theirs as they are.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionShapes/btCollisionShape.h>
#include <LinearMath/btVector3.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "ductile/bullet/face_points.hpp"
#include "ductile/bullet/moving_bodies.hpp"

namespace ductile::bullet::detail {

/// Null for what a contact cannot push.
[[nodiscard]] DUCTILE_INLINE const btRigidBody* pushed(const btCollisionObject& object) {
    const btRigidBody* body = btRigidBody::upcast(&object);
    return moves(body) ? body : nullptr;
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

/// How fast a gap closes [m/s].
[[nodiscard]] DUCTILE_INLINE double closing_speed(const btCollisionObject& a,
                                                  const btCollisionObject& b, const Gap& gap) {
    return -double(gap.normal.dot(velocity_at(a, gap.on_a) - velocity_at(b, gap.on_b)));
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

/// How far a body may get past something and still be found on this side of it: half of its
/// smallest extent; infinite for what does not move [m].
[[nodiscard]] DUCTILE_INLINE double half_thickness(const btCollisionObject& object) {
    if (pushed(object) == nullptr) return std::numeric_limits<double>::infinity();
    btVector3 low, high;
    object.getCollisionShape()->getAabb(btTransform::getIdentity(), low, high);
    const btVector3 extent = high - low;
    return double(extent[extent.minAxis()]) / 2;
}

/// Overlap up to which a blow may not know what touches: Bullet's contacts find none of boxes that
/// the digits of their places have apart [m].
[[nodiscard]] DUCTILE_INLINE double unknown_depth(const btCollisionObjectWrapper& a,
                                                  const btCollisionObjectWrapper& b) {
    return std::max(closed_gap / 4, digits_of(a, b));
}
/// Until what is `away` is closed, or a blow knows it [m].
[[nodiscard]] DUCTILE_INLINE double way_to_close(double away, double unknown) {
    const double further = away > -unknown ? std::max(closed_gap / 2, -away) : closed_gap / 2;
    return std::max(away, 0.0) + further;
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
        btVector3 at, normal;
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
        list_gaps(point, *a, *b, gaps_);
        for (const Gap& gap : gaps_) see(gap, gaps_, *a, *b);
        return 0;
    }

  private:
    void see(const Gap& there, const std::vector<Gap>& all, const btCollisionObjectWrapper& a,
             const btCollisionObjectWrapper& b) {
        const btCollisionObject &of_a = *a.getCollisionObject(), &of_b = *b.getCollisionObject();
        const auto& [away, normal, on_a, on_b] = there;
        const double speed = closing_speed(of_a, of_b, there);
        const double yields = yield_at(of_a, on_a, normal) + yield_at(of_b, on_b, normal);
        const double faster = gain(of_a, normal);
        const double taken = speed > 0 && yields > 0 ? speed * speed / (2 * yields) : 0;
        const double gap = std::max(away, 0.0);
        const double time = speed > 0 ? gap / speed : 0;
        double depth = flush_depth(normal, a, b, btScalar(time) * (spin(of_a) - spin(of_b)));
        for (const Gap& other : all) { // corners that are as good as flush then
            const double rise = other.away - closing_speed(of_a, of_b, other) * time;
            if (rise < double(flush * other.on_b.distance(on_b))) depth = std::max(depth, rise);
        }
        const double unknown = unknown_depth(a, b), way = way_to_close(away, unknown) + depth;
        if (away < nearest.away) nearest = {away, speed, taken, way, on_b, normal};
        if (faster > 0 && yields > 0 && away > -closed_gap / 2) {
            const double end = std::max(speed, 0.0) + faster * h;
            if (!(end * end > 2 * yields * apart)) return;
            found.time = std::min(found.time, time_to_close(way, speed, faster));
            return;
        }
        if (!(speed > 0) || !(yields > 0)) return;
        const bool touches = away < closed_gap;
        found.strikes = found.strikes || (touches && taken > touching);
        // what a blow does not know is not closed for Bullet
        const bool counts = touches ? away > -unknown && taken > touching
                                    : taken > apart || speed * h / 2 - away > unseen;
        if (counts) found.time = std::min(found.time, way / speed);
    }

    std::vector<Gap> gaps_; ///< of a point
};

/// Where two bodies meet elsewhere than where they are nearest.
class PointsElsewhere final : public btCollisionWorld::ContactResultCallback {
  public:
    /// Energies as of ClosingContactsFinder::find.
    PointsElsewhere(ClosingContacts& found, std::vector<StruckPoint>& struck, double touching,
                    double apart, btCollisionObject& a, btCollisionObject& b)
        : found_(found),
          struck_(struck),
          touching_(touching),
          apart_(apart),
          a_(a),
          b_(b),
          at_a_(a.getWorldTransform()),
          at_b_(b.getWorldTransform()) {
        m_closestDistanceThreshold =
            rounding(*a.getCollisionShape()) + rounding(*b.getCollisionShape());
    }
    /// What closes until they are where they go in `time` > 0 [s].
    void look_ahead(btCollisionWorld& world, double time) {
        time_ = time;
        const auto then = [time](const btCollisionObject& object) {
            const btRigidBody* body = btRigidBody::upcast(&object);
            const bool goes = body != nullptr && !(body->getLinearVelocity().isZero() &&
                                                   body->getAngularVelocity().isZero());
            const btTransform& now = object.getWorldTransform();
            return goes ? moved(*body, now, btScalar(time)) : now;
        };
        ask(world, then(a_), then(b_));
    }
    /// What touches as they do at a `point` of theirs, along `normal`.
    void look_around(btCollisionWorld& world, const btVector3& point, const btVector3& normal) {
        constexpr btScalar angle = btScalar(1e-3);
        time_ = 0;
        touches_ = point;
        btVector3 axes[2];
        btPlaneSpace1(normal, axes[0], axes[1]);
        for (const btVector3& axis : {axes[0], -axes[0], axes[1], -axes[1]}) {
            const btQuaternion turn(axis, angle);
            ask(world, btTransform(turn, point - quatRotate(turn, point)) * a_.getWorldTransform(),
                at_b_);
        }
    }
    btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper* a, int, int,
                             const btCollisionObjectWrapper* b, int, int) override {
        list_gaps(point, *a, *b, gaps_);
        const bool known = are_all_known(gaps_, *a, *b);
        const double unknown = unknown_depth(*a, *b);
        for (const Gap& gap : gaps_) {
            see(gap, known, unknown, *a->getCollisionObject(), *b->getCollisionObject());
        }
        return 0;
    }

  private:
    void see(const Gap& there, bool known, double unknown, const btCollisionObject& of_a,
             const btCollisionObject& of_b) {
        const auto& [away, normal, on_a, on_b] = there;
        if (!(away < -closed_gap)) return;
        const Point now_a = now(of_a, on_a), now_b = now(of_b, on_b);
        const double gap = away + double(normal.dot((now_a.at - on_a) - (now_b.at - on_b)));
        const auto note = [&] {
            if (known) return;
            struck_.push_back({&of_a, &of_b, there.normal, now_b.at, gap});
        };
        if (!(time_ > 0)) {
            const btScalar lever = now_b.at.distance(touches_);
            if (gap < closed_gap + double(flush * lever)) note();
            return;
        }
        const double yields = yield_at(of_a, on_a, normal) + yield_at(of_b, on_b, normal);
        const auto counts = [yields](double speed, double energy) {
            return speed > 0 && speed * speed > 2 * yields * energy;
        };
        if (!counts(closing_speed(of_a, of_b, there), apart_)) return;
        const double speed = -double(normal.dot(now_a.velocity - now_b.velocity));
        if (gap < closed_gap) {
            if (!counts(speed, touching_)) return;
            const bool overlaps = !(gap > -unknown);
            found_.strikes = found_.strikes || overlaps || !known;
            note();
            if (overlaps) return;
        }
        const double gain = 2 * ((gap - away) / time_ - speed) / time_;
        found_.time = std::min(found_.time, time_to_close(way_to_close(gap, unknown), speed, gain));
    }

    struct Point {
        btVector3 at, velocity;
    };
    /// Where the body is, of a point of it as it was put elsewhere.
    [[nodiscard]] Point now(const btCollisionObject& object, const btVector3& point) const {
        const btTransform& here = &object == &a_ ? at_a_ : at_b_;
        const btVector3 at = here * object.getWorldTransform().invXform(point);
        const btRigidBody* body = btRigidBody::upcast(&object);
        const btVector3 zero(0, 0, 0);
        return {at, body != nullptr ? body->getVelocityInLocalPoint(at - here.getOrigin()) : zero};
    }
    void ask(btCollisionWorld& world, const btTransform& a, const btTransform& b) {
        a_.setWorldTransform(a);
        b_.setWorldTransform(b);
        world.contactPairTest(&a_, &b_, *this);
        a_.setWorldTransform(at_a_);
        b_.setWorldTransform(at_b_);
    }

    ClosingContacts& found_;
    std::vector<StruckPoint>& struck_;
    double touching_, apart_;
    btCollisionObject &a_, &b_;
    btTransform at_a_, at_b_;
    double time_ = 0;       ///< ahead [s]; 0: turned about
    std::vector<Gap> gaps_; ///< of a point
    btVector3 touches_ = btVector3(0, 0, 0);
};

} // namespace ductile::bullet::detail
