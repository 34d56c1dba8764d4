// SPDX-License-Identifier: MIT
//
// Bodies of front_solver.hpp.
#pragma once

#include <algorithm>
#include <limits>
#include <new>
#include <utility>

#include "ductile/bullet/front_solver.hpp"

namespace ductile::bullet {

namespace detail {

[[nodiscard]] DUCTILE_INLINE int island_of(const btCollisionObject& a, const btCollisionObject& b) {
    return a.getIslandTag() >= 0 ? a.getIslandTag() : b.getIslandTag();
}
[[nodiscard]] DUCTILE_INLINE int island_of(const btCollisionObject& body) {
    return body.getIslandTag();
}
[[nodiscard]] DUCTILE_INLINE int island_of(const btTypedConstraint& constraint) {
    return island_of(constraint.getRigidBodyA(), constraint.getRigidBodyB());
}
[[nodiscard]] DUCTILE_INLINE int island_of(const btPersistentManifold& manifold) {
    return island_of(*manifold.getBody0(), *manifold.getBody1());
}

/// One that is switched off, as a broken one is, leaves its island to the user's solver.
[[nodiscard]] DUCTILE_INLINE bool is_plastic(btTypedConstraint* constraint) {
    return constraint->isEnabled() && as_plastic(*constraint) != nullptr;
}

[[nodiscard]] DUCTILE_INLINE bool differ(const btCollisionObject& a, const btCollisionObject& b) {
    return a.getIslandTag() >= 0 && b.getIslandTag() >= 0 && a.getIslandTag() != b.getIslandTag();
}
[[nodiscard]] DUCTILE_INLINE bool joins_islands(const btTypedConstraint& constraint) {
    return constraint.isEnabled() && differ(constraint.getRigidBodyA(), constraint.getRigidBodyB());
}
[[nodiscard]] DUCTILE_INLINE bool joins_islands(const btPersistentManifold& manifold) {
    return differ(*manifold.getBody0(), *manifold.getBody1());
}

/// Bullet's own members are not public.
struct SolverOfWorld : btDiscreteDynamicsWorld {
    static bool& owned(btDiscreteDynamicsWorld& world) {
        return world.*(&SolverOfWorld::m_ownsConstraintSolver);
    }
};

/// What an island had of it while a plastic joint was in it: a solver of one direction leaves it
/// there.
DUCTILE_INLINE void forget_second_direction(btPersistentManifold** manifolds, int count) {
    for (int i = 0; i < count; ++i) {
        for (int k = 0; k < manifolds[i]->getNumContacts(); ++k) {
            manifolds[i]->getContactPoint(k).m_appliedImpulseLateral2 = 0;
        }
    }
}

} // namespace detail

DUCTILE_INLINE FrontHold::FrontHold(btDiscreteDynamicsWorld& world) : world_(world) {
    bool& owned = detail::SolverOfWorld::owned(world);
    void* room = btAlignedAlloc(sizeof(FrontSolver), 16);
    auto* front = new (room) FrontSolver(*world.getConstraintSolver(), owned);
    front_ = front->self_;
    owned = false; // else the world would end the user's solver where another one comes
    world.setConstraintSolver(front);
    owned = true;
}

DUCTILE_INLINE FrontHold::~FrontHold() {
    const std::shared_ptr<FrontSolver*> self = front_.lock();
    if (self == nullptr || world_.getConstraintSolver() != *self) return;
    FrontSolver* front = *self;
    bool& owned = detail::SolverOfWorld::owned(world_);
    owned = false;
    world_.setConstraintSolver(&front->usual());
    owned = std::exchange(front->owned_, false);
    front->~FrontSolver();
    btAlignedFree(front);
}

DUCTILE_INLINE FrontSolver::~FrontSolver() {
    if (!owned_) return;
    usual_.~btConstraintSolver();
    btAlignedFree(&usual_);
}

DUCTILE_INLINE btScalar FrontSolver::solve_usual(
    btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds,
    int manifold_count, btTypedConstraint** constraints, int constraint_count,
    const btContactSolverInfo& info, btIDebugDraw* drawer, btDispatcher* dispatcher) {
    const bool one_direction = (info.m_solverMode & SOLVER_USE_2_FRICTION_DIRECTIONS) == 0;
    if (one_direction) detail::forget_second_direction(manifolds, manifold_count);
    return usual_.solveGroup(bodies, body_count, manifolds, manifold_count, constraints,
                             constraint_count, info, drawer, dispatcher);
}

DUCTILE_INLINE btScalar FrontSolver::solveGroup(btCollisionObject** bodies, int body_count,
                                                btPersistentManifold** manifolds,
                                                int manifold_count, btTypedConstraint** constraints,
                                                int constraint_count,
                                                const btContactSolverInfo& info,
                                                btIDebugDraw* drawer, btDispatcher* dispatcher) {
    // Bullet flushes an empty group after an island above its batch size
    if (body_count == 0 && manifold_count == 0 && constraint_count == 0) return 0;
    if (std::none_of(constraints, constraints + constraint_count, detail::is_plastic)) {
        return solve_usual(bodies, body_count, manifolds, manifold_count, constraints,
                           constraint_count, info, drawer, dispatcher);
    }
    const auto join_islands = [](const auto* item) { return detail::joins_islands(*item); };
    if (std::any_of(manifolds, manifolds + manifold_count, join_islands) ||
        std::any_of(constraints, constraints + constraint_count, join_islands)) {
        // tags of islands that Bullet did not find: it was not asked to split them
        return solver_of(
                   **std::find_if(constraints, constraints + constraint_count, detail::is_plastic))
            ->solver.solveGroup(bodies, body_count, manifolds, manifold_count, constraints,
                                constraint_count, info, drawer, dispatcher);
    }
    std::unique_ptr<Room> room = borrow();
    const auto by_island = [](auto** items, int count, auto& copy) {
        const auto before = [](const auto* a, const auto* b) {
            return detail::island_of(*a) < detail::island_of(*b);
        };
        if (std::is_sorted(items, items + count, before)) return items;
        copy.assign(items, items + count);
        std::stable_sort(copy.begin(), copy.end(), before);
        return copy.data();
    };
    bodies = by_island(bodies, body_count, room->sorted_bodies);
    manifolds = by_island(manifolds, manifold_count, room->sorted_manifolds);
    constraints = by_island(constraints, constraint_count, room->sorted_constraints);
    room->bodies.clear();
    room->manifolds.clear();
    room->constraints.clear();
    int body = 0, manifold = 0, constraint = 0;
    while (body < body_count || manifold < manifold_count || constraint < constraint_count) {
        // what begins with the lowest island that is left
        int island = std::numeric_limits<int>::max();
        const auto see = [&island](auto** items, int at, int count) {
            if (at < count) island = std::min(island, detail::island_of(*items[at]));
        };
        see(bodies, body, body_count);
        see(manifolds, manifold, manifold_count);
        see(constraints, constraint, constraint_count);
        const auto end_of = [island](auto** items, int at, int count) {
            while (at < count && detail::island_of(*items[at]) == island) ++at;
            return at;
        };
        const int body_end = end_of(bodies, body, body_count);
        const int manifold_end = end_of(manifolds, manifold, manifold_count);
        const int constraint_end = end_of(constraints, constraint, constraint_count);
        if (island >= 0 && std::any_of(constraints + constraint, constraints + constraint_end,
                                       detail::is_plastic)) {
            solver_of(*constraints[constraint])
                ->solver.solveGroup(bodies + body, body_end - body, manifolds + manifold,
                                    manifold_end - manifold, constraints + constraint,
                                    constraint_end - constraint, info, drawer, dispatcher);
        } else {
            room->bodies.insert(room->bodies.end(), bodies + body, bodies + body_end);
            room->manifolds.insert(room->manifolds.end(), manifolds + manifold,
                                   manifolds + manifold_end);
            room->constraints.insert(room->constraints.end(), constraints + constraint,
                                     constraints + constraint_end);
        }
        body = body_end;
        manifold = manifold_end;
        constraint = constraint_end;
    }
    btScalar residual = 0;
    if (!room->bodies.empty() || !room->constraints.empty()) {
        residual =
            solve_usual(room->bodies.data(), int(room->bodies.size()), room->manifolds.data(),
                        int(room->manifolds.size()), room->constraints.data(),
                        int(room->constraints.size()), info, drawer, dispatcher);
    }
    give_back(std::move(room));
    return residual;
}

DUCTILE_INLINE void FrontSolver::allSolved(const btContactSolverInfo& info, btIDebugDraw* drawer) {
    usual_.allSolved(info, drawer);
    const std::lock_guard lock(mutex_); // one front may serve several worlds
    std::erase_if(kept_, [](auto& entry) { return !std::exchange(entry.second->used, false); });
}

DUCTILE_INLINE void FrontSolver::reset() {
    usual_.reset();
    kept_.clear();
}

DUCTILE_INLINE auto FrontSolver::borrow() -> std::unique_ptr<Room> {
    const std::lock_guard lock(mutex_);
    if (idle_.empty()) return std::make_unique<Room>();
    std::unique_ptr<Room> room = std::move(idle_.back());
    idle_.pop_back();
    return room;
}
DUCTILE_INLINE void FrontSolver::give_back(std::unique_ptr<Room> room) {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(room));
}

DUCTILE_INLINE auto FrontSolver::solver_of(const btTypedConstraint& first)
    -> std::shared_ptr<Kept> {
    const std::lock_guard lock(mutex_);
    std::shared_ptr<Kept>& kept = kept_[&first];
    if (kept == nullptr) kept = std::make_shared<Kept>();
    kept->used = true;
    return kept;
}

} // namespace ductile::bullet
