// SPDX-License-Identifier: MIT
//
// All of a Bullet world that a tick changes, kept and put back bit for bit: what follows is what
// would have followed without whatever was done in between.
//
//   bodies        pose, velocities, both of the interpolation too, applied forces, sleep
//   contacts      the points of every manifold, with their impulses and ages
//   constraints   whether they are enabled, the impulse that Bullet shows; plastic joints all
//   solver        the random seed of sequential impulse
//
// Nothing of the broadphase, of islands and of solver pools: they follow from the bodies, as long
// as Bullet sorts its pairs, `getDispatchInfo().m_deterministicOverlappingPairs`; without that 95 %
// of the frames of a pile of boxes differ.
//
// Traps of Bullet 3.24 that this header deals with
//   - Who falls asleep with whom hangs on pairs that are not yet dropped: meeting_islands.hpp.
//   - A manifold may have gone in between, with the pair; then the pairs are found anew first. One
//     that came stays, empty.
//   - Manifolds of compound shapes have the same two bodies: their order tells them apart.
//
// Rigid bodies only: no multibodies, no soft bodies. No body, constraint or shape may come or go
// between `take` and `put_back`. What a user's callbacks and actions keep is theirs.
//
// Not thread-safe. Allocates where a world grows, else nothing.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <BulletDynamics/ConstraintSolver/btConstraintSolver.h>
#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include "ductile/bullet/held_forces.hpp"
#include "ductile/bullet/local_scope.hpp"
#include "ductile/bullet/moving_bodies.hpp"
#include "ductile/bullet/plastic_constraint.hpp"

namespace ductile::bullet {

class WorldSnapshot {
  public:
    /// `solver`: who solves what is no plastic joint's. `scope`: of what alone; null: of all.
    void take(btDiscreteDynamicsWorld& world, btConstraintSolver& solver,
              const LocalScope* scope = nullptr) {
        bodies_.clear();
        constraints_.clear();
        for (btRigidBody* body : bodies_of(world, scope)) take_body(*body);
        for (btTypedConstraint* constraint : constraints_of(world, scope)) {
            take_constraint(*constraint);
        }
        take_manifolds(*world.getDispatcher(), scope);
        const auto* sweeps = dynamic_cast<btSequentialImpulseConstraintSolver*>(&solver);
        if (sweeps != nullptr) seed_ = sweeps->getRandSeed();
    }
    /// To what was last taken, which may be more than what of it is put back: `scope`, as there.
    /// `collide` looks for the contacts of the scope's bodies.
    void put_back(btDiscreteDynamicsWorld& world, btConstraintSolver& solver,
                  LocalScope* scope = nullptr, const std::function<void()>& collide = {}) {
        for (const Body& kept : bodies_) {
            btRigidBody& body = *kept.body;
            if (scope != nullptr && !scope->has(body)) continue;
            body.setWorldTransform(kept.transform);
            body.setLinearVelocity(kept.velocity);
            body.setAngularVelocity(kept.spin);
            body.updateInertiaTensor();
            body.setInterpolationWorldTransform(kept.interpolated);
            body.setInterpolationLinearVelocity(kept.interpolated_velocity);
            body.setInterpolationAngularVelocity(kept.interpolated_spin);
            body.clearForces();
            body.applyCentralForce(kept.force);
            body.applyTorque(kept.torque);
            body.forceActivationState(kept.activation);
            body.setDeactivationTime(kept.deactivation_time);
            body.setHitFraction(kept.hit_fraction);
            body.setIslandTag(kept.island);
            body.setCompanionId(kept.companion);
        }
        if (!write_manifolds(*world.getDispatcher(), scope)) {
            scope != nullptr ? collide() : world.performDiscreteCollisionDetection();
            (void)write_manifolds(*world.getDispatcher(), scope);
        }
        for (const Constraint& kept : constraints_) {
            if (scope != nullptr && !scope->has(*kept.constraint)) continue;
            if (PlasticConstraint* plastic = as_plastic(*kept.constraint)) {
                plastic->put_all_back();
                continue;
            }
            kept.constraint->internalSetAppliedImpulse(kept.impulse);
            kept.constraint->setEnabled(kept.enabled);
        }
        auto* sweeps = dynamic_cast<btSequentialImpulseConstraintSolver*>(&solver);
        if (sweeps != nullptr) sweeps->setRandSeed(seed_);
    }
    /// Others alone are put back from now on: bodies and constraints of these may end.
    void leave_out(const LocalScope& scope) {
        std::erase_if(bodies_, [&scope](const Body& kept) { return scope.has(*kept.body); });
        std::erase_if(constraints_,
                      [&scope](const Constraint& kept) { return scope.has(*kept.constraint); });
        std::erase_if(manifolds_, [&scope](const Manifold& kept) {
            return scope.has(*kept.a) || scope.has(*kept.b);
        });
    }
    /// What island each body was in, of all bodies that move if all were taken.
    template <class Tell>
    void tell_islands(const Tell& tell) const {
        for (const Body& body : bodies_) tell(*body.body, body.island);
    }

  private:
    struct Body {
        btRigidBody* body;
        btTransform transform, interpolated;
        btVector3 velocity, spin, interpolated_velocity, interpolated_spin, force, torque;
        btScalar deactivation_time, hit_fraction;
        int activation, island, companion;
    };
    struct Manifold {
        const btCollisionObject* a;
        const btCollisionObject* b;
        int order;             ///< of those of this pair, and before it is known of all
        std::size_t first = 0; ///< of its points
        int count = 0;

        [[nodiscard]] bool is_before(const Manifold& other) const {
            const std::less<const btCollisionObject*> before;
            if (a != other.a) return before(a, other.a);
            if (b != other.b) return before(b, other.b);
            return order < other.order;
        }
    };
    struct Constraint {
        btTypedConstraint* constraint;
        btScalar impulse;
        bool enabled;
    };

    /// All that there are now, sorted, into `manifolds`.
    static void list_manifolds(btDispatcher& dispatcher, const LocalScope* scope,
                               std::vector<Manifold>& manifolds,
                               std::vector<btPersistentManifold*>& in_order) {
        manifolds.clear();
        in_order.clear();
        for (btPersistentManifold* manifold : manifolds_of(dispatcher, scope)) {
            manifolds.push_back({manifold->getBody0(), manifold->getBody1(), int(in_order.size())});
            in_order.push_back(manifold);
        }
        sort(manifolds);
    }
    static void sort(std::vector<Manifold>& manifolds) {
        const auto before = [](const Manifold& x, const Manifold& y) { return x.is_before(y); };
        std::sort(manifolds.begin(), manifolds.end(), before);
    }
    void take_body(btRigidBody& body) {
        bodies_.push_back({&body, body.getWorldTransform(), body.getInterpolationWorldTransform(),
                           body.getLinearVelocity(), body.getAngularVelocity(),
                           body.getInterpolationLinearVelocity(),
                           body.getInterpolationAngularVelocity(),
                           unweighted(body.getTotalForce(), body.getLinearFactor()),
                           unweighted(body.getTotalTorque(), body.getAngularFactor()),
                           body.getDeactivationTime(), body.getHitFraction(),
                           body.getActivationState(), body.getIslandTag(), body.getCompanionId()});
    }
    void take_constraint(btTypedConstraint& constraint) {
        if (PlasticConstraint* plastic = as_plastic(constraint)) plastic->keep_all();
        constraints_.push_back(
            {&constraint, constraint.internalGetAppliedImpulse(), constraint.isEnabled()});
    }
    void take_manifolds(btDispatcher& dispatcher, const LocalScope* scope) {
        manifolds_.clear();
        points_.clear();
        sorted_ = false;
        for (const btPersistentManifold* manifold : manifolds_of(dispatcher, scope)) {
            const int count = manifold->getNumContacts();
            manifolds_.push_back({manifold->getBody0(), manifold->getBody1(),
                                  int(manifolds_.size()), points_.size(), count});
            for (int k = 0; k < count; ++k) points_.push_back(manifold->getContactPoint(k));
        }
    }
    /// False where one is missing.
    [[nodiscard]] bool write_manifolds(btDispatcher& dispatcher, const LocalScope* scope) {
        if (!std::exchange(sorted_, true)) sort(manifolds_);
        list_manifolds(dispatcher, scope, now_, listed_);
        auto kept = manifolds_.cbegin();
        const std::less<const btCollisionObject*> before;
        bool all = true;
        const auto is_missed = [scope](const Manifold& gone) {
            return gone.count > 0 &&
                   (scope == nullptr || scope->has(*gone.a) || scope->has(*gone.b));
        };
        for (const Manifold& here : now_) {
            btPersistentManifold& manifold = *listed_[std::size_t(here.order)];
            const auto gone = [&] {
                return before(kept->a, here.a) || (kept->a == here.a && before(kept->b, here.b));
            };
            for (; kept != manifolds_.cend() && gone(); ++kept) all = all && !is_missed(*kept);
            // its points are overwritten: what a user keeps with a point has to outlive this
            manifold.setNumContacts(0);
            if (kept == manifolds_.cend() || kept->a != here.a || kept->b != here.b) continue;
            for (int k = 0; k < kept->count; ++k) {
                manifold.addManifoldPoint(points_[kept->first + std::size_t(k)]);
            }
            ++kept;
        }
        for (; kept != manifolds_.cend(); ++kept) all = all && !is_missed(*kept);
        return all;
    }

    std::vector<Body> bodies_;
    std::vector<Manifold> manifolds_, now_;
    bool sorted_ = false; ///< manifolds_, which is not needed before they are put back
    std::vector<btPersistentManifold*> listed_;
    std::vector<btManifoldPoint> points_;
    std::vector<Constraint> constraints_;
    unsigned long seed_ = 0;
};

} // namespace ductile::bullet
