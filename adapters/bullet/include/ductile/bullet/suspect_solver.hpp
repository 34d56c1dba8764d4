// SPDX-License-Identifier: MIT
//
// A solver that hands each island to the user's own solver, or, where one of its constraints is
// suspect, to a direct one (SoftMlcpSolver with Dantzig's method). World installs it where the user
// chose OnUnconverged::direct_solver.
//
// Bullet gathers small islands to groups of m_minimumSolverBatchSize constraints; the decision is
// for the group.
//
// Thread-safety: `solveGroup` may be called by several threads at once as far as the user's solver
// allows it (btConstraintSolverPoolMt does): each call borrows a direct solver of its own. Suspects
// are changed between steps only.
#pragma once

#include <BulletDynamics/ConstraintSolver/btConstraintSolver.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>
#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <unordered_set>
#include <utility>
#include <vector>

#include "ductile/bullet/soft_mlcp_solver.hpp"
#include "ductile/bullet/sweep_group.hpp"

namespace ductile::bullet {

class SuspectSolver final : public btConstraintSolver, public ProxySolver {
  public:
    /// `usual` must outlive this.
    explicit SuspectSolver(btConstraintSolver& usual) : usual_(usual) {}
    SuspectSolver(const SuspectSolver&) = delete;
    SuspectSolver& operator=(const SuspectSolver&) = delete;

    [[nodiscard]] btConstraintSolver& usual() const noexcept override { return usual_; }

    /// From now on the constraint's island is solved directly. Only its address is kept.
    void suspect(const void* constraint) { suspects_.insert(constraint); }
    void trust(const void* constraint) { suspects_.erase(constraint); }
    void trust_all() noexcept { suspects_.clear(); }

    /// Islands that a direct solver was given and did not solve: the iterative one took over.
    [[nodiscard]] int fallbacks() const {
        const std::lock_guard lock(mutex_);
        int sum = 0;
        for (const auto& direct : idle_) sum += direct->solver.getNumFallbacks();
        return sum;
    }

    // ---- Bullet's side

    void prepareSolve(int bodies, int manifolds) override {
        usual_.prepareSolve(bodies, manifolds);
    }
    btScalar solveGroup(btCollisionObject** bodies, int body_count,
                        btPersistentManifold** manifolds, int manifold_count,
                        btTypedConstraint** constraints, int constraint_count,
                        const btContactSolverInfo& info, btIDebugDraw* drawer,
                        btDispatcher* dispatcher) override {
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
    void allSolved(const btContactSolverInfo& info, btIDebugDraw* drawer) override {
        usual_.allSolved(info, drawer);
    }
    void reset() override {
        usual_.reset();
        for (auto& direct : idle_) direct->solver.reset();
    }
    [[nodiscard]] btConstraintSolverType getSolverType() const override {
        return usual_.getSolverType();
    }

  private:
    struct Direct {
        btDantzigSolver dantzig;
        SoftMlcpSolver solver{dantzig, Answer::exact};
    };

    std::unique_ptr<Direct> borrow() {
        const std::lock_guard lock(mutex_);
        if (idle_.empty()) return std::make_unique<Direct>();
        auto result = std::move(idle_.back());
        idle_.pop_back();
        return result;
    }
    void give_back(std::unique_ptr<Direct> direct) {
        const std::lock_guard lock(mutex_);
        idle_.push_back(std::move(direct));
    }

    btConstraintSolver& usual_;
    std::unordered_set<const void*> suspects_;
    mutable std::mutex mutex_; ///< of idle_
    std::vector<std::unique_ptr<Direct>> idle_;
};

} // namespace ductile::bullet
