// SPDX-License-Identifier: MIT
//
// Hands the islands of a tick to a solver, in Bullet's order and in its batches. Bullet's own
// callback looks through all constraints of a world for each island: 1,000 pairs of bodies cost
// 12,000 instructions a joint, whoever solves. Here both are gone through once.
//
// Bullet has its solver prepared when it has found the islands and sorted the constraints by them,
// and hands over next. Handed over here they are taken, so that it finds none:
//
//   prepareSolve   hand_over(solver)    true: what Bullet hands over now is to be left alone
//   allSolved      end(), where they were
//
// Not for worlds that do not split islands, or have another island manager, as that of threads is.
//
// Not thread-safe.
#pragma once

#include <BulletCollision/CollisionDispatch/btSimulationIslandManager.h>
#include <BulletDynamics/ConstraintSolver/btConstraintSolver.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include <vector>

#include "ductile/vocabulary/linkage.hpp"

namespace ductile::bullet {

class IslandBatches final : private btSimulationIslandManager::IslandCallback {
  public:
    explicit IslandBatches(btDiscreteDynamicsWorld& world) : world_(world) {}

    /// True where the islands that the world found have been solved.
    [[nodiscard]] bool hand_over(btConstraintSolver& solver);
    /// After Bullet's turn, where they were.
    void end();

  private:
    DUCTILE_INLINE void processIsland(btCollisionObject** bodies, int body_count,
                                      btPersistentManifold** manifolds, int manifold_count,
                                      int island) override;
    void solve();

    btDiscreteDynamicsWorld& world_;
    btConstraintSolver* solver_ = nullptr;
    int next_ = 0; ///< of the world's sorted constraints
    std::vector<btCollisionObject*> bodies_;
    std::vector<btPersistentManifold*> manifolds_;
    std::vector<btTypedConstraint*> constraints_;
};

} // namespace ductile::bullet

#ifndef DUCTILE_COMPILED
#include "ductile/bullet/island_batches.ipp"
#endif
