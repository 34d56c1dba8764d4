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

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <BulletDynamics/ConstraintSolver/btConstraintSolver.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <cstddef>
#include <functional>
#include <vector>

#include "ductile/bullet/local_scope.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::bullet {

class WorldSnapshot {
  public:
    /// `solver`: who solves what is no plastic joint's. `scope`: of what alone; null: of all.
    void take(btDiscreteDynamicsWorld& world, btConstraintSolver& solver,
              const LocalScope* scope = nullptr);
    /// To what was last taken, which may be more than what of it is put back: `scope`, as there.
    /// `collide` looks for the contacts of the scope's bodies.
    void put_back(btDiscreteDynamicsWorld& world, btConstraintSolver& solver,
                  LocalScope* scope = nullptr, const std::function<void()>& collide = {});
    /// Others alone are put back from now on: bodies and constraints of these may end.
    void leave_out(const LocalScope& scope);
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

        [[nodiscard]] bool is_before(const Manifold& other) const;
    };
    struct Constraint {
        btTypedConstraint* constraint;
        btScalar impulse;
        bool enabled;
    };

    /// All that there are now, sorted, into `manifolds`.
    static void list_manifolds(btDispatcher& dispatcher, const LocalScope* scope,
                               std::vector<Manifold>& manifolds,
                               std::vector<btPersistentManifold*>& in_order);
    static void sort(std::vector<Manifold>& manifolds);
    void take_body(btRigidBody& body);
    void take_constraint(btTypedConstraint& constraint);
    void take_manifolds(btDispatcher& dispatcher, const LocalScope* scope);
    /// False where one is missing.
    [[nodiscard]] bool write_manifolds(btDispatcher& dispatcher, const LocalScope* scope);

    std::vector<Body> bodies_;
    std::vector<Manifold> manifolds_, now_;
    bool sorted_ = false; ///< manifolds_, which is not needed before they are put back
    std::vector<btPersistentManifold*> listed_;
    std::vector<btManifoldPoint> points_;
    std::vector<Constraint> constraints_;
    unsigned long seed_ = 0;
};

} // namespace ductile::bullet

#ifndef DUCTILE_COMPILED
#include "ductile/bullet/world_snapshot.ipp"
#endif
