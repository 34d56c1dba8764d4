// SPDX-License-Identifier: MIT
//
// Contacts of islands with plastic joints as the last tick had them, beside what they are in the
// next one: how they turned since (world/turned_contact.hpp), and which of them are gone, as one
// body slid off the other.
//
// Bullet lets a point go that slid farther than 2 % of the smaller body's reach, but only after it
// has looked for new ones, for which the old ones left no room: what slides fast then stands on one
// or two corners for a part, sinks, and strikes with the others in the next one. `let_go` is before
// that look.
//
// Not thread-safe, but for `turned`.
#pragma once

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "ductile/bullet/closing_contacts.hpp"
#include "ductile/bullet/convert.hpp"
#include "ductile/bullet/face_points.hpp"
#include "ductile/world/turned_contact.hpp"

namespace ductile::bullet {

namespace detail {

[[nodiscard]] inline ContactBody contact_body(const btCollisionObject& object) {
    const btRigidBody* body = btRigidBody::upcast(&object);
    return body != nullptr ? bullet::contact_body(*body) : ContactBody();
}

/// Solved `ago` [s] ago, since when the bodies went straight on.
[[nodiscard]] inline SeenContact seen_contact(const btPersistentManifold& manifold,
                                              const btManifoldPoint& point, double ago) {
    const auto arm = [ago](const btCollisionObject& object, const btVector3& at) {
        const ContactBody body = contact_body(object);
        const Vector3<double> centre =
            difference(to_core(object.getWorldTransform().getOrigin()), scaled(ago, body.velocity));
        return difference(to_core(at), centre);
    };
    return {.point = to_core(point.getPositionWorldOnB()),
            .normal = to_core(point.m_normalWorldOnB),
            .arm_a = arm(*manifold.getBody0(), point.getPositionWorldOnA()),
            .arm_b = arm(*manifold.getBody1(), point.getPositionWorldOnB())};
}

using BodyPair = std::pair<const btCollisionObject*, const btCollisionObject*>;

[[nodiscard]] inline BodyPair bodies_of(const btPersistentManifold& manifold) {
    return {manifold.getBody0(), manifold.getBody1()};
}

[[nodiscard]] inline double pushes(const btPersistentManifold& manifold) {
    double impulse = 0;
    for (int k = 0; k < manifold.getNumContacts(); ++k) {
        impulse += double(manifold.getContactPoint(k).getAppliedImpulse());
    }
    return impulse;
}

/// How fast its points that push leave, along their normals [m/s].
[[nodiscard]] inline double parting_speed(const btPersistentManifold& manifold) {
    const ContactBody a = contact_body(*manifold.getBody0()),
                      b = contact_body(*manifold.getBody1());
    double fastest = 0;
    for (int k = 0; k < manifold.getNumContacts(); ++k) {
        const btManifoldPoint& point = manifold.getContactPoint(k);
        if (!(point.getAppliedImpulse() > 0)) continue;
        const SeenContact seen = seen_contact(manifold, point, 0);
        fastest = std::max(
            fastest, std::abs(dot(seen.normal, difference(a.at(seen.arm_a), b.at(seen.arm_b)))));
    }
    return fastest;
}

/// As far a point may slide and stay [m]; Bullet's own 2 cm are a share of the bodies.
inline constexpr double kept_slide = 5e-3;

/// Whether points may have slid as far as that; what stands is told at once.
[[nodiscard]] inline bool slides_far(const btPersistentManifold& manifold, double time) {
    if (manifold.getNumContacts() == 0) return false;
    const double usual = double(manifold.getContactBreakingThreshold());
    const double most = std::min(usual, kept_slide);
    const ContactBody a = contact_body(*manifold.getBody0()),
                      b = contact_body(*manifold.getBody1());
    constexpr double share = 0.25, reach = 50; // of bodies, in thresholds
    const double way = norm(difference(a.velocity, b.velocity)) * time,
                 turn = (norm(a.spin) + norm(b.spin)) * time;
    return way + turn * reach * usual > share * most;
}

/// Whether two bodies have a point nearer than the threshold.
struct AnyContact final : btCollisionWorld::ContactResultCallback {
    bool found = false;
    double reach;
    std::vector<Gap> gaps; ///< of a point
    AnyContact(double within, const BodyPair& bodies) : reach(within) {
        m_closestDistanceThreshold = btScalar(reach) +
                                     rounding(*bodies.first->getCollisionShape()) +
                                     rounding(*bodies.second->getCollisionShape());
    }
    btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper* a, int, int,
                             const btCollisionObjectWrapper* b, int, int) override {
        list_gaps(point, *a, *b, gaps);
        found = found || gaps.front().away <= reach;
        return 0;
    }
};

} // namespace detail

class HeldContacts {
  public:
    using Concerns = std::function<bool(const btCollisionObject&)>;

    /// Before bodies move: the manifolds are of a tick that was solved `ago` >= 0 [s] ago. Of
    /// bodies that `concerns`.
    void see(std::span<btPersistentManifold* const> manifolds, double ago,
             const Concerns& concerns) {
        ago_ = ago;
        seen_.clear();
        pushed_.clear();
        for (const btPersistentManifold* manifold : manifolds) {
            if (manifold->getNumContacts() == 0) continue;
            if (!concerns(*manifold->getBody0()) && !concerns(*manifold->getBody1())) continue;
            const detail::BodyPair bodies = detail::bodies_of(*manifold);
            for (int k = 0; k < manifold->getNumContacts(); ++k) {
                seen_.emplace_back(
                    bodies, detail::seen_contact(*manifold, manifold->getContactPoint(k), ago));
            }
            const bool is_gone = std::find(gone_.begin(), gone_.end(), bodies) != gone_.end();
            if (!is_gone && detail::pushes(*manifold) > 0) pushed_.push_back(bodies);
        }
        sort_by_bodies(seen_);
    }
    /// Lets points go that slid too far, as bodies are now, `time` [s] after they were looked for.
    static void let_go(std::span<btPersistentManifold* const> manifolds, double time,
                       const Concerns& concerns) {
        for (btPersistentManifold* manifold : manifolds) {
            if (!detail::slides_far(*manifold, time)) continue;
            const btCollisionObject &a = *manifold->getBody0(), &b = *manifold->getBody1();
            if (!concerns(a) && !concerns(b)) continue;
            const btScalar usual = manifold->getContactBreakingThreshold();
            manifold->setContactBreakingThreshold(std::min(usual, btScalar(detail::kept_slide)));
            manifold->refreshContactPoints(a.getWorldTransform(), b.getWorldTransform());
            manifold->setContactBreakingThreshold(usual);
        }
    }
    /// w of a point in the middle of a part of `h` [s], as its bodies are there, not yet solved
    /// [m/s].
    [[nodiscard]] double turned(const btPersistentManifold& manifold, const btManifoldPoint& point,
                                double h) const {
        const detail::BodyPair bodies = detail::bodies_of(manifold);
        const SeenContact now = detail::seen_contact(manifold, point, 0);
        const SeenContact* then = nearest(seen_, bodies, now.point);
        if (then == nullptr) return 0;
        return turned_contact(now, *then, detail::contact_body(*bodies.first),
                              detail::contact_body(*bodies.second), ago_ + h / 2, h / 2);
    }
    /// After a part of `h` [s]: whether bodies that pushed each other in it, or when it began, are
    /// apart farther than they part in it, and were not so before: Bullet keeps points that slid,
    /// and they go on pushing where shapes are 0.1 mm apart.
    [[nodiscard]] bool lost(btDiscreteDynamicsWorld& world,
                            std::span<btPersistentManifold* const> manifolds, double h,
                            const Concerns& concerns) {
        constexpr double noticed = 0.01; // of the largest impulse
        double largest = 0;
        for (const btPersistentManifold* manifold : manifolds) {
            largest = std::max(largest, detail::pushes(*manifold));
        }
        std::vector<std::pair<detail::BodyPair, double>> pushing; // and how fast they part [m/s]
        for (const detail::BodyPair& bodies : pushed_) {
            pushing.emplace_back(bodies,
                                 norm(difference(detail::contact_body(*bodies.first).velocity,
                                                 detail::contact_body(*bodies.second).velocity)));
        }
        for (const btPersistentManifold* manifold : manifolds) {
            if (!(detail::pushes(*manifold) > noticed * largest)) continue;
            if (!concerns(*manifold->getBody0()) && !concerns(*manifold->getBody1())) continue;
            pushing.emplace_back(detail::bodies_of(*manifold), detail::parting_speed(*manifold));
        }
        std::sort(pushing.begin(), pushing.end());
        const auto same = [](const auto& x, const auto& y) { return x.first == y.first; };
        pushing.erase(std::unique(pushing.begin(), pushing.end(), same), pushing.end());
        lost_.clear();
        bool anew = false;
        for (const auto& [bodies, parting] : pushing) {
            detail::AnyContact contact(closed_gap + h * parting, bodies);
            world.contactPairTest(const_cast<btCollisionObject*>(bodies.first),
                                  const_cast<btCollisionObject*>(bodies.second), contact);
            if (contact.found) continue;
            lost_.push_back(bodies);
            anew = anew || std::find(gone_.begin(), gone_.end(), bodies) == gone_.end();
        }
        return anew;
    }
    /// The farthest that a body turned in a part of `h` [s] that something pushed in it [rad].
    [[nodiscard]] static double turn(std::span<btPersistentManifold* const> manifolds, double h,
                                     const Concerns& concerns) {
        double spin = 0;
        for (const btPersistentManifold* manifold : manifolds) {
            if (!(detail::pushes(*manifold) > 0)) continue;
            for (const btCollisionObject* object : {manifold->getBody0(), manifold->getBody1()}) {
                if (concerns(*object)) {
                    spin = std::max(spin, norm(detail::contact_body(*object).spin));
                }
            }
        }
        return spin * h;
    }
    /// The part stands.
    void accept() { gone_ = lost_; }

  private:
    std::vector<std::pair<detail::BodyPair, SeenContact>> seen_; ///< sort_by_bodies
    double ago_ = 0;
    std::vector<detail::BodyPair> pushed_;      ///< when the part began
    std::vector<detail::BodyPair> lost_, gone_; ///< in the last part, and before the present one
};

} // namespace ductile::bullet
