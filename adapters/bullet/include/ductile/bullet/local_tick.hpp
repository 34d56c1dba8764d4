// SPDX-License-Identifier: MIT
//
// A tick of some islands of a world, the rest of which stays as it is to the last bit: what
// Bullet's own does for all, by public calls for theirs.
//
//   gravity, damping, prediction, bounds, broadphase, the near callback for their pairs, islands
//   and who sleeps or wakes, their solve, their motion, the end of the tick of their joints
//
// The order is Bullet's: pairs by their numbers, bodies and constraints by their places, so that an
// island ticked alone gets the bits that it has in a world of its own.
//
// Who touches a body that is not among them is found and told; the tick has to be put back then.
//
// Not for worlds with callbacks, actions, solvers, dispatchers or island managers of another kind,
// kinematic bodies, or continuous collision: `is_possible`.
//
// Not thread-safe.
#pragma once

#include <BulletCollision/BroadphaseCollision/btCollisionAlgorithm.h>
#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include <functional>
#include <vector>

#include "ductile/bullet/local_scope.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::bullet {

class LocalTick {
  public:
    /// `usual`: who solves what is no plastic joint's.
    [[nodiscard]] static bool is_possible(btDiscreteDynamicsWorld& world,
                                          const btConstraintSolver& usual);

    /// `moved`: is called when the bodies were moved, before joints book.
    void go(btDiscreteDynamicsWorld& world, LocalScope& scope, btScalar h,
            const std::function<void()>& moved);
    /// Bodies beside those of the scope that the last tick found touching them.
    [[nodiscard]] const std::vector<btRigidBody*>& touched() const noexcept { return touched_; }

    /// Looks for contacts of the scope's bodies where they are.
    void collide(btDiscreteDynamicsWorld& world, LocalScope& scope);

  private:
    void find_pairs(btDiscreteDynamicsWorld& world, const LocalScope& scope);
    void find_islands(btDiscreteDynamicsWorld& world, LocalScope& scope);
    void solve(btDiscreteDynamicsWorld& world, const LocalScope& scope, btScalar h);
    void finish(LocalScope& scope, btScalar h);
    [[nodiscard]] int root(int body) noexcept;
    void unite(int a, int b) noexcept;

    std::vector<const btBroadphaseProxy*> proxies_; ///< of the bodies, sorted
    std::vector<btBroadphasePair*> pairs_;
    std::vector<btPersistentManifold*> touching_;
    std::vector<btRigidBody*> touched_;
    std::vector<int> parent_; ///< by body of the scope
    std::vector<char> awake_; ///< by root
    btManifoldArray found_;
    std::vector<btCollisionObject*> solved_bodies_;
    std::vector<btPersistentManifold*> solved_manifolds_;
    std::vector<btTypedConstraint*> solved_constraints_;
    std::vector<TickMember*> joints_;
};

} // namespace ductile::bullet

#ifndef DUCTILE_COMPILED
#include "ductile/bullet/local_tick.ipp"
#endif
