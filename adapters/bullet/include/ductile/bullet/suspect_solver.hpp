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

#include <memory>
#include <mutex>
#include <vector>

#include "ductile/bullet/soft_mlcp_solver.hpp"
#include "ductile/bullet/sweep_group.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::bullet {

class SuspectSolver final : public btConstraintSolver, public ProxySolver {
  public:
    /// `usual` must outlive this.
    explicit SuspectSolver(btConstraintSolver& usual) : usual_(usual) {}
    SuspectSolver(const SuspectSolver&) = delete;
    SuspectSolver& operator=(const SuspectSolver&) = delete;

    [[nodiscard]] btConstraintSolver& usual() const noexcept override { return usual_; }

    /// From now on the constraint's island is solved directly. Only its address is kept.
    void suspect(const void* constraint);
    void trust(const void* constraint);
    void trust_all() noexcept { suspects_.clear(); }

    /// Islands that a direct solver was given and did not solve: the iterative one took over.
    [[nodiscard]] int fallbacks() const;

    // ---- Bullet's side

    void prepareSolve(int bodies, int manifolds) override {
        usual_.prepareSolve(bodies, manifolds);
    }
    DUCTILE_INLINE btScalar solveGroup(btCollisionObject** bodies, int body_count,
                                       btPersistentManifold** manifolds, int manifold_count,
                                       btTypedConstraint** constraints, int constraint_count,
                                       const btContactSolverInfo& info, btIDebugDraw* drawer,
                                       btDispatcher* dispatcher) override;
    void allSolved(const btContactSolverInfo& info, btIDebugDraw* drawer) override {
        usual_.allSolved(info, drawer);
    }
    DUCTILE_INLINE void reset() override;
    [[nodiscard]] btConstraintSolverType getSolverType() const override {
        return usual_.getSolverType();
    }

  private:
    struct Direct {
        btDantzigSolver dantzig;
        SoftMlcpSolver solver{dantzig, Answer::exact};
        std::unique_ptr<Direct> next; ///< idle
    };

    [[nodiscard]] bool is_suspect(const void* constraint) const;
    std::unique_ptr<Direct> borrow();
    void give_back(std::unique_ptr<Direct> direct);

    btConstraintSolver& usual_;
    std::vector<const void*> suspects_; ///< sorted
    mutable std::mutex mutex_;          ///< of idle_
    std::unique_ptr<Direct> idle_;      ///< the first of them
};

} // namespace ductile::bullet

#ifndef DUCTILE_COMPILED
#include "ductile/bullet/suspect_solver.ipp"
#endif
