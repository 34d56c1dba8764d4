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

#include <cstddef>
#include <typeinfo>
#include <vector>

#include "ductile/bullet/meeting_islands.hpp"

namespace ductile::bullet {

namespace detail {

/// Bullet's own array is not public.
struct SortedConstraints : btDiscreteDynamicsWorld {
    static const auto& of(const btDiscreteDynamicsWorld& world) {
        return world.*(&SortedConstraints::m_sortedConstraints);
    }
};

/// By which Bullet sorts; negative: between bodies that do not move.
[[nodiscard]] inline int island_of(const btTypedConstraint& constraint) {
    const int of_a = constraint.getRigidBodyA().getIslandTag();
    return of_a >= 0 ? of_a : constraint.getRigidBodyB().getIslandTag();
}

} // namespace detail

class IslandBatches final : private btSimulationIslandManager::IslandCallback {
  public:
    explicit IslandBatches(btDiscreteDynamicsWorld& world) : world_(world) {}

    /// True where the islands that the world found have been solved.
    [[nodiscard]] bool hand_over(btConstraintSolver& solver) {
        btSimulationIslandManager& islands = *world_.getSimulationIslandManager();
        const bool known = typeid(islands) == typeid(btSimulationIslandManager) ||
                           typeid(islands) == typeid(MeetingIslands);
        // none: they were handed over, and this is no tick of all the world
        if (!known || !islands.getSplitIslands() || islands.getUnionFind().getNumElements() == 0) {
            return false;
        }
        solver_ = &solver;
        next_ = 0;
        islands.buildAndProcessIslands(world_.getDispatcher(), &world_, this);
        if (!bodies_.empty()) solve();
        islands.getUnionFind().reset(0);
        islands.setSplitIslands(false); // else Bullet lists and sorts the contacts once more
        return true;
    }
    /// After Bullet's turn, where they were.
    void end() { world_.getSimulationIslandManager()->setSplitIslands(true); }

  private:
    void processIsland(btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds,
                       int manifold_count, int island) override {
        bodies_.insert(bodies_.end(), bodies, bodies + body_count);
        manifolds_.insert(manifolds_.end(), manifolds, manifolds + manifold_count);
        const auto& sorted = detail::SortedConstraints::of(world_);
        while (next_ < sorted.size() && detail::island_of(*sorted[next_]) < island) ++next_;
        for (; next_ < sorted.size() && detail::island_of(*sorted[next_]) == island; ++next_) {
            constraints_.push_back(sorted[next_]);
        }
        const int batch = world_.getSolverInfo().m_minimumSolverBatchSize;
        const auto rows = constraints_.size() + manifolds_.size();
        if (batch <= 1 || rows > std::size_t(batch)) solve();
    }
    void solve() {
        solver_->solveGroup(bodies_.data(), int(bodies_.size()), manifolds_.data(),
                            int(manifolds_.size()), constraints_.data(), int(constraints_.size()),
                            world_.getSolverInfo(), world_.getDebugDrawer(),
                            world_.getDispatcher());
        bodies_.clear();
        manifolds_.clear();
        constraints_.clear();
    }

    btDiscreteDynamicsWorld& world_;
    btConstraintSolver* solver_ = nullptr;
    int next_ = 0; ///< of the world's sorted constraints
    std::vector<btCollisionObject*> bodies_;
    std::vector<btPersistentManifold*> manifolds_;
    std::vector<btTypedConstraint*> constraints_;
};

} // namespace ductile::bullet
