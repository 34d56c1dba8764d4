// SPDX-License-Identifier: MIT
//
// Bodies of suspect_solver.hpp.
#pragma once

#include <algorithm>
#include <functional>
#include <utility>

#include "ductile/bullet/suspect_solver.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::bullet {

DUCTILE_INLINE void SuspectSolver::suspect(const void* constraint) {
    const auto place =
        std::lower_bound(suspects_.begin(), suspects_.end(), constraint, std::less<>());
    if (place == suspects_.end() || *place != constraint) suspects_.insert(place, constraint);
}

DUCTILE_INLINE void SuspectSolver::trust(const void* constraint) {
    const auto place =
        std::lower_bound(suspects_.begin(), suspects_.end(), constraint, std::less<>());
    if (place != suspects_.end() && *place == constraint) suspects_.erase(place);
}

DUCTILE_INLINE bool SuspectSolver::is_suspect(const void* constraint) const {
    return std::binary_search(suspects_.begin(), suspects_.end(), constraint, std::less<>());
}

DUCTILE_INLINE int SuspectSolver::fallbacks() const {
    const std::lock_guard lock(mutex_);
    int sum = 0;
    for (const Direct* direct = idle_.get(); direct != nullptr; direct = direct->next.get()) {
        sum += direct->solver.getNumFallbacks();
    }
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
    bool has_suspect = false;
    for (int i = 0; i < constraint_count && !has_suspect; ++i) {
        has_suspect = is_suspect(constraints[i]);
    }
    if (!has_suspect) return solve(usual_);
    auto direct = borrow();
    const btScalar result = solve(direct->solver);
    give_back(std::move(direct));
    return result;
}

DUCTILE_INLINE void SuspectSolver::reset() {
    usual_.reset();
    for (Direct* direct = idle_.get(); direct != nullptr; direct = direct->next.get()) {
        direct->solver.reset();
    }
}

DUCTILE_INLINE std::unique_ptr<SuspectSolver::Direct> SuspectSolver::borrow() {
    const std::lock_guard lock(mutex_);
    if (idle_ == nullptr) return std::make_unique<Direct>();
    auto result = std::move(idle_);
    idle_ = std::move(result->next);
    return result;
}

DUCTILE_INLINE void SuspectSolver::give_back(std::unique_ptr<Direct> direct) {
    const std::lock_guard lock(mutex_);
    direct->next = std::move(idle_);
    idle_ = std::move(direct);
}

} // namespace ductile::bullet
