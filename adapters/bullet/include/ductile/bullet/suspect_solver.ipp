// SPDX-License-Identifier: MIT
//
// Bodies of suspect_solver.hpp.
#pragma once

#include <algorithm>
#include <utility>

#include "ductile/bullet/suspect_solver.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::bullet {

DUCTILE_INLINE int SuspectSolver::fallbacks() const {
    const std::lock_guard lock(mutex_);
    int sum = 0;
    for (const auto& direct : idle_) sum += direct->solver.getNumFallbacks();
    return sum;
}

DUCTILE_INLINE btScalar SuspectSolver::solveGroup(
    btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds,
    int manifold_count, btTypedConstraint** constraints, int constraint_count,
    const btContactSolverInfo& info, btIDebugDraw* drawer, btDispatcher* dispatcher) {
    const auto solve = [&](btConstraintSolver& solver) {
        return solver.solveGroup(bodies, body_count, manifolds, manifold_count, constraints,
                                 constraint_count, info, drawer, dispatcher);
    };
    const bool has_suspect =
        !suspects_.empty() && std::any_of(constraints, constraints + constraint_count,
                                          [this](const btTypedConstraint* constraint) {
                                              return suspects_.count(constraint) > 0;
                                          });
    if (!has_suspect) return solve(usual_);
    auto direct = borrow();
    const btScalar result = solve(direct->solver);
    give_back(std::move(direct));
    return result;
}

DUCTILE_INLINE void SuspectSolver::reset() {
    usual_.reset();
    for (auto& direct : idle_) direct->solver.reset();
}

DUCTILE_INLINE std::unique_ptr<SuspectSolver::Direct> SuspectSolver::borrow() {
    const std::lock_guard lock(mutex_);
    if (idle_.empty()) return std::make_unique<Direct>();
    auto result = std::move(idle_.back());
    idle_.pop_back();
    return result;
}

DUCTILE_INLINE void SuspectSolver::give_back(std::unique_ptr<Direct> direct) {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(direct));
}

} // namespace ductile::bullet
