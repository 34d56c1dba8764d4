// SPDX-License-Identifier: MIT
//
// btMLCPSolver, which solves all rows of an island at once, made to honour the compliance of
// SoftRows (soft_rows.hpp) and bounds that do not enclose zero (shifted_lcp.hpp).
//
//   btDantzigSolver dantzig;
//   ductile::bullet::SoftMlcpSolver solver(dantzig, ductile::bullet::Answer::exact);
//
// With btDantzigSolver it is the solver for chains of joints: exact, and for islands of some dozen
// rows as cheap as sequential impulse. btLemkeSolver is slower and needs a regular A;
// btSolveProjectedGaussSeidel (Answer::iterated) is sequential impulse in another form.
//
// `getNumFallbacks()` counts the islands that the LCP solver failed to solve since
// `setNumFallbacks(0)`: those were handed to sequential impulse, compliance included, and are given
// at least `fallback_sweeps`.
//
// Traps of Bullet 3.24 that this header deals with
//   - createMLCP and createMLCPFast leave each row's cfm out of A.
//   - createMLCPFast drops the right side of a row whose m_jacDiagABInv is below SIMD_EPSILON (in
//     float, a row softer than 8e6/kg), so rows are softened after it.
//   - createMLCPFast indexes an array as long as the rows by constraint, also by those without
//     rows: once more joints have broken than rows are left, it writes past the end. Constraints
//     without rows are taken out before.
//   - With split impulse (the default) everything is solved twice, and a row of given force would
//     push in the second solve too, which is about positions. There, the bounds are what is left
//     of them beyond the given force; and where no contact asks for anything, the second solve
//     is left out.
#pragma once

#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>
#include <BulletDynamics/MLCPSolvers/btMLCPSolver.h>

#include <algorithm>
#include <array>
#include <type_traits>
#include <vector>

#include "ductile/bullet/shifted_lcp.hpp"
#include "ductile/bullet/soft_rows.hpp"

namespace ductile::bullet {

/// Shares of its own effect by which a row yields, tried in turn [-]. Rows that repeat each other, as
/// those of a beam held at both ends, would leave a direct solver to divide by round-off; they then
/// share their force, and a single row is off by this share. Only where Dantzig's method failed
/// without: what it can solve changes no bit. In float, structures of up to 30 rows are solved best
/// from 1e-7, its round-off, to 3e-6, and less and less well beyond.
template <class Scalar>
inline constexpr auto row_softness = [] {
    if constexpr (std::is_same_v<Scalar, float>) {
        return std::array{1e-6F};
    } else {
        return std::array{1e-12, 1e-10, 1e-8};
    }
}();

/// Sweeps for an island that a direct solver did not solve. The ten of Bullet's default leave a
/// struck bar with up to 90 times its energy, where 50 leave none that it did not have.
inline constexpr int fallback_sweeps = 200;

class SoftMlcpSolver : public btMLCPSolver {
  public:
    /// `lcp` must outlive this. `answer`: whether it is a direct solver, whose answers are checked.
    SoftMlcpSolver(btMLCPSolverInterface& lcp, Answer answer)
        : btMLCPSolver(nullptr),
          shifted_(lcp, answer),
          direct_(answer == Answer::exact),
          pivots_(dynamic_cast<btDantzigSolver*>(&lcp) != nullptr) {
        btMLCPSolver::setMLCPSolver(&shifted_);
    }
    SoftMlcpSolver(const SoftMlcpSolver&) = delete;
    SoftMlcpSolver& operator=(const SoftMlcpSolver&) = delete;

    void setMLCPSolver(btMLCPSolverInterface*) = delete; // it would take the shift away

  protected:
    btScalar solveGroupCacheFriendlyIterations(btCollisionObject** bodies, int body_count,
                                               btPersistentManifold** manifolds,
                                               int manifold_count, btTypedConstraint** constraints,
                                               int constraint_count,
                                               const btContactSolverInfo& info,
                                               btIDebugDraw* drawer) override {
        btContactSolverInfo enough = info;
        if (direct_) { // and does not read it
            enough.m_numIterations = std::max(info.m_numIterations, fallback_sweeps);
        }
        return btMLCPSolver::solveGroupCacheFriendlyIterations(
            bodies, body_count, manifolds, manifold_count, constraints, constraint_count, enough,
            drawer);
    }

    void convertJoints(btTypedConstraint** constraints, int count,
                       const btContactSolverInfo& info) override {
        soft_.mark(constraints, count);
        btMLCPSolver::convertJoints(constraints, count, info);
        soft_.unmark();
        compliant_.clear();
        soft_.for_each_row(m_tmpConstraintSizesPool, m_tmpSolverNonContactConstraintPool,
                           [this](btSolverConstraint& row) {
                               if (row.m_cfm > 0) compliant_.push_back(row_index(row));
                           });
        drop_constraints_without_rows();
    }

    void createMLCP(const btContactSolverInfo& info) override {
        btMLCPSolver::createMLCP(info);
        add_compliance();
    }
    void createMLCPFast(const btContactSolverInfo& info) override {
        btMLCPSolver::createMLCPFast(info);
        add_compliance();
    }

    bool solveMLCP(const btContactSolverInfo& info) override {
        if (m_A.rows() == 0) return true;
        if (!solved_with_ties([&] { return solve_velocities(info); })) {
            if (direct_) sweep_joints(info.m_numIterations);
            return false;
        }
        if (info.m_splitImpulse) push_apart(info);
        return true;
    }

  private:
    /// Sequential impulse, which takes over, leaves each joint's rows after a number of their own.
    void sweep_joints(int at_least) {
        for (int i = 0; i < m_tmpSolverNonContactConstraintPool.size(); ++i) {
            int& sweeps = m_tmpSolverNonContactConstraintPool[i].m_overrideNumSolverIterations;
            sweeps = std::max(sweeps, at_least);
        }
    }

    [[nodiscard]] int row_index(const btSolverConstraint& row) const {
        return int(&row - &m_tmpSolverNonContactConstraintPool[0]);
    }

    void drop_constraints_without_rows() {
        int kept = 0;
        for (int i = 0; i < m_tmpConstraintSizesPool.size(); ++i) {
            if (m_tmpConstraintSizesPool[i].m_numConstraintRows == 0) continue;
            m_tmpConstraintSizesPool[kept++] = m_tmpConstraintSizesPool[i];
        }
        m_tmpConstraintSizesPool.resizeNoInitialize(kept);
    }

    /// In A, and in the rows in case sequential impulse has to take over.
    void add_compliance() {
        for (const int i : compliant_) {
            btSolverConstraint& row = m_tmpSolverNonContactConstraintPool[i];
            m_A.setElem(i, i, m_A(i, i) + row.m_cfm);
            soften(row);
        }
    }

    /// Whether `solve` succeeds, at last with every row yielding to its own impulse by a share too small
    /// to matter: rows that repeat each other, joints' or contacts', become independent.
    template <class Solve>
    bool solved_with_ties(const Solve& solve) {
        if (solve()) return true;
        if (!pivots_) return false;
        for (const btScalar share : row_softness<btScalar>) {
            for (int i = 0; i < m_A.rows(); ++i) m_A.setElem(i, i, m_A(i, i) * (1 + share));
            if (solve()) return true;
        }
        return false;
    }

    bool solve_velocities(const btContactSolverInfo& info) {
        return shifted_.solveMLCP(m_A, m_b, m_x, m_lo, m_hi, m_limitDependencies,
                                  info.m_numIterations);
    }

    /// The push apart of what overlaps: the same rows, whose right side is a contact's depth. Where it
    /// cannot be solved nothing is pushed in this step; the velocities, which are, stay.
    void push_apart(const btContactSolverInfo& info) {
        bool nothing_to_push = true;
        for (int i = 0; i < m_bSplit.rows(); ++i) {
            nothing_to_push = nothing_to_push && m_bSplit[i] == 0;
        }
        m_xSplit.setZero();
        if (nothing_to_push) return;
        for (int i = 0; i < m_lo.rows(); ++i) {
            if (m_limitDependencies[i] >= 0) continue;
            const btScalar given = std::min(std::max(btScalar(0), m_lo[i]), m_hi[i]);
            m_lo[i] -= given;
            m_hi[i] -= given;
        }
        const bool solved = solved_with_ties([&] {
            return shifted_.solveMLCP(m_A, m_bSplit, m_xSplit, m_lo, m_hi, m_limitDependencies,
                                      info.m_numIterations);
        });
        if (!solved) m_xSplit.setZero();
    }

    ShiftedLcp shifted_;
    bool direct_;
    /// Dantzig's method. Lemke's, which inverts A, is left as it is: with every row softened, it
    /// made nonsense of a contact in float.
    bool pivots_;
    SoftConstraints soft_;
    std::vector<int> compliant_; ///< rows with C > 0
};

} // namespace ductile::bullet
