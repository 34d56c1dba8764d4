// SPDX-License-Identifier: MIT
//
// Bodies of island_batches.hpp.
#pragma once

#include <typeinfo>

#include "ductile/bullet/island_batches.hpp"
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
[[nodiscard]] DUCTILE_INLINE int island_of(const btTypedConstraint& constraint) {
    const int of_a = constraint.getRigidBodyA().getIslandTag();
    return of_a >= 0 ? of_a : constraint.getRigidBodyB().getIslandTag();
}

} // namespace detail

DUCTILE_INLINE bool IslandBatches::hand_over(btConstraintSolver& solver) {
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

DUCTILE_INLINE void IslandBatches::end() {
    world_.getSimulationIslandManager()->setSplitIslands(true);
}

DUCTILE_INLINE void IslandBatches::processIsland(btCollisionObject** bodies, int body_count,
                                                 btPersistentManifold** manifolds,
                                                 int manifold_count, int island) {
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

DUCTILE_INLINE void IslandBatches::solve() {
    solver_->solveGroup(bodies_.data(), int(bodies_.size()), manifolds_.data(),
                        int(manifolds_.size()), constraints_.data(), int(constraints_.size()),
                        world_.getSolverInfo(), world_.getDebugDrawer(), world_.getDispatcher());
    bodies_.clear();
    manifolds_.clear();
    constraints_.clear();
}

} // namespace ductile::bullet
