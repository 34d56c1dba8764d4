// SPDX-License-Identifier: MIT
//
// Spares sequential impulse the sweeps over a constraint's rows that would change nothing any more.
//
// Bullet sweeps over all rows as often as the world says, also those of a joint that has long been
// solved. But each row carries the number of sweeps that it takes part in, and after each sweep
// Bullet calls the constraint (solveConstraintObsolete) with its two bodies. Where neither body's
// velocity changed since the sweep before, by whomever, the rows are left out of the next ones, and
// as soon as it changes again they take part again. Where no row of a group has anything left to
// do, Bullet ends the sweeps by itself.
//
// "Not changed" is: by no more than round-off of what the sweeps have changed so far. What the
// sweeps left out could still have done is at most their number times that.
//
// For solvers that take each row by itself, one after the other: conjugate gradients go on from one
// sweep to the next and must not miss any. A solver that never calls back leaves out nothing.
#pragma once

#include <BulletDynamics/ConstraintSolver/btConstraintSolver.h>
#include <BulletDynamics/ConstraintSolver/btSolverBody.h>
#include <BulletDynamics/ConstraintSolver/btSolverConstraint.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>
#include <BulletDynamics/Dynamics/btDynamicsWorld.h>

#include <array>
#include <cstddef>
#include <limits>

namespace ductile::bullet {

class SweepWatch {
  public:
    /// Forgets the rows of the last solve.
    void close() noexcept { rows_ = nullptr; }

    /// The `count` > 0 rows that a solver of `world` asks for in `info`. Null: not known, nothing
    /// is left out.
    void open(const btTypedConstraint::btConstraintInfo2& info, int count,
              btDynamicsWorld* world) noexcept {
        rows_ = nullptr;
        if (world == nullptr ||
            world->getConstraintSolver()->getSolverType() != BT_SEQUENTIAL_IMPULSE_SOLVER) {
            return;
        }
        // the info points into the first of the solver's rows, or into something else's
        auto* first = reinterpret_cast<btSolverConstraint*>(
            reinterpret_cast<char*>(info.m_constraintError) - offsetof(btSolverConstraint, m_rhs));
        const bool is_row = std::size_t(info.rowskip) * sizeof(btScalar) == sizeof(*first) &&
                            info.cfm == &first->m_cfm &&
                            info.m_lowerLimit == &first->m_lowerLimit &&
                            info.m_J1linearAxis == &first->m_contactNormal1[0] &&
                            info.m_J2angularAxis == &first->m_relpos2CrossNormal[0];
        if (!is_row) return;
        rows_ = first;
        count_ = count;
        sweeps_ = first->m_overrideNumSolverIterations;
        left_out_ = false;
        for (btVector3& change : last_) change.setZero();
    }

    /// After each sweep.
    void look(btSolverBody& a, btSolverBody& b) noexcept {
        if (rows_ == nullptr) return;
        const std::array<const btVector3*, 4> now{
            &a.internalGetDeltaLinearVelocity(), &a.internalGetDeltaAngularVelocity(),
            &b.internalGetDeltaLinearVelocity(), &b.internalGetDeltaAngularVelocity()};
        btScalar whole = 0, change = 0; // squares
        for (std::size_t i = 0; i < now.size(); ++i) {
            change += (*now[i] - last_[i]).length2();
            whole += now[i]->length2();
            last_[i] = *now[i];
        }
        const bool settled = change <= round_off * round_off * whole;
        if (settled == left_out_) return;
        left_out_ = settled;
        for (int row = 0; row < count_; ++row) {
            rows_[row].m_overrideNumSolverIterations = settled ? 0 : sweeps_;
        }
    }

  private:
    static constexpr btScalar round_off = 8 * std::numeric_limits<btScalar>::epsilon();

    btSolverConstraint* rows_ = nullptr; ///< the solver's; null: nobody's
    int count_ = 0;
    int sweeps_ = 0; ///< that the rows take part in at most
    bool left_out_ = false;
    std::array<btVector3, 4> last_; ///< changes of velocity after the last sweep, as in look
};

} // namespace ductile::bullet
