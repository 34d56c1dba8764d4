// SPDX-License-Identifier: MIT
//
// Rows that a constraint solves by itself. Bullet's sequential impulse and NNCG call each
// constraint once in every sweep (solveConstraintObsolete) with its two bodies: enough for a
// constraint to take up its rows there (joint/row_sweep.hpp), instead of handing them to Bullet.
// Then
//   - compliance is exact whatever its size, also in Bullet's stock solver;
//   - all reactions are exact, without joint feedback;
//   - the rows cost a third of Bullet's, and no sweep is made that changes nothing.
// For constraints that were added by `add_to`, in SoftSequentialImpulseSolver, also one of many in
// a pool, and in Bullet's own where world and solver are of Bullet's plain classes; otherwise the
// rows go to Bullet.
//
// What Bullet does for its own rows is done here: the impulse of the last row is left in the
// constraint, and joint feedback that the user asked for is filled.
#pragma once

#include <BulletDynamics/ConstraintSolver/btSolverBody.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>
#include <BulletDynamics/Dynamics/btDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <memory>

#include "ductile/bullet/soft_rows.hpp"
#include "ductile/bullet/sweep_group.hpp"
#include "ductile/joint/row_sweep.hpp"

namespace ductile::bullet {

/// Base beside PlasticConstraint, and one constraint's rows in the current solve.
class SelfSolvedRows {
  protected:
    using Impulses = RowSweep<double>::Impulses;

    SelfSolvedRows() = default;
    ~SelfSolvedRows() = default;

    /// The constraint is about to be added to `world`.
    void join(btDynamicsWorld& world);
    void leave() noexcept {
        close();
        group_ = nullptr;
        of_world_.reset();
    }
    /// Of the solver that asks this constraint, which is in `world` or not yet (null), for its
    /// rows, where it calls in each sweep; else null.
    [[nodiscard]] SweepGroup* sweeps_of_solver(const SoftRows& asked, btDynamicsWorld* world) const;

    /// Before the first sweep of a solve: the rows, none yet. `arm_a`, `arm_b`: of RowSweep.
    RowSweep<double>& open(SweepGroup& group, const btRigidBody& a, const btRigidBody& b,
                           const Vector3<double>& arm_a, const Vector3<double>& arm_b);
    void close() noexcept { open_ = false; }
    /// True from open to close: the last solve was the constraint's own.
    [[nodiscard]] bool is_open() const noexcept { return open_; }

    /// In each sweep.
    void sweep(btSolverBody& a, btSolverBody& b);

    /// Of the rows in the last solve, in the order in which they were added [N s | N m s].
    [[nodiscard]] const Impulses& impulses() const noexcept { return impulses_; }

  private:
    /// What the sweeps share of Bullet's own solver in the world that was joined; null: nothing may
    /// be shared there.
    std::shared_ptr<SweepGroup> of_world_;
    SweepGroup* group_ = nullptr; ///< of the open solve
    SweepGroup::Place place_;     ///< in the group
    Impulses impulses_ = Impulses::Zero();
    int sweep_ = -1; ///< the last; -1: none yet
    bool open_ = false;
};

/// A wrench on A at the joint, acting for a tick, as Bullet's joint feedback; world axes.
void write_feedback(btJointFeedback& feedback, const btRigidBody& a, const btRigidBody& b,
                    const Vector3<double>& arm_a, const Vector3<double>& arm_b,
                    const Vector3<double>& force, const Vector3<double>& moment);

} // namespace ductile::bullet

#ifndef DUCTILE_COMPILED
#include "ductile/bullet/self_solved_rows.ipp"
#endif
