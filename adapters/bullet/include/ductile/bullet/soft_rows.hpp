// SPDX-License-Identifier: MIT
//
// How a constraint and a solver agree on compliant rows. A row asks for
//
//   u' + C λ = b,   lower <= λ <= upper.
//
// Bullet has a field for C, `cfm`, but its solvers do not mean the same by it: sequential impulse
// and NNCG multiply λ by it without the row's effective mass m, as if it were C m, and diverge from
// C m = 1 on; btMLCPSolver does not read it. soft_solvers.hpp and soft_mlcp_solver.hpp hold
// solvers that honour C for every value.
//
// The protocol, once per internal tick
//   1. An exact solver marks every constraint of its island that is a SoftRows.
//   2. Bullet asks each for its rows: buildJacobian, getInfo1, getInfo2. There, and only there,
//      `compliance_is_exact()` tells the constraint who asks:
//        true:  write C itself [1/kg | 1/(kg m²)] into `cfm` of *every* row, zero for a rigid one
//               (the first row is preset to the world's m_globalCfm);
//        false: a solver of Bullet's own, or somebody else's. Write C m where C m < 1 and the
//        solver
//               is an iterative one, or do without the compliance and say so.
//      `sweeps()` tells besides that the solver is sequential impulse, so that a constraint may
//      solve its rows by itself (self_solved_rows.hpp) and ask for none.
//   3. The marks are taken back. Who needs it later keeps what getInfo2 saw.
// A constraint that is no SoftRows is handed to Bullet untouched.
//
// Symbols
//   u'  row velocity after the solve   [m/s | rad/s]
//   λ   impulse of the row             [N s | N m s]
//   C   compliance, finite, >= 0       [1/kg | 1/(kg m²)]
//   m   effective mass 1/(J M⁻¹ Jᵀ)    [kg | kg m²]
#pragma once

#include <BulletDynamics/ConstraintSolver/btSolverConstraint.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>
#include <LinearMath/btAlignedObjectArray.h>

#include <cstddef>
#include <vector>

namespace ductile::bullet {

class SweepGroup;

/// Base beside btTypedConstraint of a constraint that has compliant rows.
class SoftRows {
  public:
    /// True while an exact solver asks for the rows; see the protocol above.
    [[nodiscard]] bool compliance_is_exact() const noexcept { return exact_; }
    /// While an exact solver asks that calls each constraint in each of its sweeps: what its sweeps
    /// share. Else null.
    [[nodiscard]] SweepGroup* sweeps() const noexcept { return sweeps_; }

  protected:
    SoftRows() = default;
    ~SoftRows() = default;

  private:
    friend class SoftConstraints;
    bool exact_ = false;
    SweepGroup* sweeps_ = nullptr;
};

/// The constraints of one solve, and which of them have compliant rows. Kept by a solver between
/// solves, so that nothing is allocated once the largest island was seen. Not thread-safe; every
/// solver has its own.
class SoftConstraints {
  public:
    /// `sweeps`: of a solver that calls each constraint in each of its sweeps.
    void mark(btTypedConstraint* const* constraints, int count, SweepGroup* sweeps = nullptr) {
        soft_.clear();
        for (int i = 0; i < count; ++i) {
            soft_.push_back(dynamic_cast<SoftRows*>(constraints[i]));
            if (soft_.back() == nullptr) continue;
            soft_.back()->exact_ = true;
            soft_.back()->sweeps_ = sweeps;
        }
    }
    void unmark() noexcept {
        for (SoftRows* soft : soft_) {
            if (soft == nullptr) continue;
            soft->exact_ = false;
            soft->sweeps_ = nullptr;
        }
    }

    /// Calls visit(row) for every row of a SoftRows constraint. `sizes` holds the rows per
    /// constraint, `rows` the rows in the constraints' order.
    template <class Visit>
    void for_each_row(const btAlignedObjectArray<btTypedConstraint::btConstraintInfo1>& sizes,
                      btConstraintArray& rows, const Visit& visit) const {
        int row = 0;
        for (int i = 0; i < int(soft_.size()); ++i) {
            const int end = row + sizes[i].m_numConstraintRows;
            if (soft_[std::size_t(i)] == nullptr) row = end;
            for (; row < end; ++row) visit(rows[row]);
        }
    }

  private:
    std::vector<SoftRows*> soft_; ///< per constraint; null: not ours
};

/// Turns a row whose `m_cfm` holds C [1/kg | 1/(kg m²)] into one that sequential impulse iterates
/// to u' + C λ = b. One sweep sets λ += rhs - cfm λ - Δu D, with D = `m_jacDiagABInv`; it rests
/// where
///
///   rhs = cfm λ + D Δu,   and for D = 1/(1/m + C), rhs = D (b - u), cfm = C D:   b = C λ + u',
///
/// and goes there from any λ, since D is then the exact inverse of the row's own diagonal. C = 0
/// changes no bit. A row that no body can follow (D = 0) stays dead.
inline void soften(btSolverConstraint& row) noexcept {
    const btScalar slack = row.m_cfm * row.m_jacDiagABInv; // C m
    const btScalar share = 1 / (1 + slack);
    row.m_jacDiagABInv *= share;
    row.m_rhs *= share;
    row.m_rhsPenetration *= share;
    row.m_cfm = slack * share;
}

} // namespace ductile::bullet
