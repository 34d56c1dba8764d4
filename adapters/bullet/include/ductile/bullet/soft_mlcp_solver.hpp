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

#include <BulletDynamics/MLCPSolvers/btMLCPSolver.h>

#include <array>
#include <type_traits>
#include <vector>

#include "ductile/bullet/shifted_lcp.hpp"
#include "ductile/bullet/soft_rows.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::bullet {

/// Shares of its own effect by which a row yields, tried in turn [-]. Rows that repeat each other,
/// as those of a beam held at both ends, would leave a direct solver to divide by round-off; they
/// then share their force, and a single row is off by this share. Only where Dantzig's method
/// failed without: what it can solve changes no bit. In float, structures of up to 30 rows are
/// solved best from 1e-7, its round-off, to 3e-6, and less and less well beyond.
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
    SoftMlcpSolver(btMLCPSolverInterface& lcp, Answer answer);
    SoftMlcpSolver(const SoftMlcpSolver&) = delete;
    SoftMlcpSolver& operator=(const SoftMlcpSolver&) = delete;

    void setMLCPSolver(btMLCPSolverInterface*) = delete; // it would take the shift away

  protected:
    DUCTILE_INLINE btScalar solveGroupCacheFriendlyIterations(
        btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds,
        int manifold_count, btTypedConstraint** constraints, int constraint_count,
        const btContactSolverInfo& info, btIDebugDraw* drawer) override;

    DUCTILE_INLINE void convertJoints(btTypedConstraint** constraints, int count,
                                      const btContactSolverInfo& info) override;

    DUCTILE_INLINE void createMLCP(const btContactSolverInfo& info) override;
    DUCTILE_INLINE void createMLCPFast(const btContactSolverInfo& info) override;

    DUCTILE_INLINE bool solveMLCP(const btContactSolverInfo& info) override;

  private:
    /// Sequential impulse, which takes over, leaves each joint's rows after a number of their own.
    void sweep_joints(int at_least);

    [[nodiscard]] int row_index(const btSolverConstraint& row) const;

    void drop_constraints_without_rows();

    /// In A, and in the rows in case sequential impulse has to take over.
    void add_compliance();

    /// Whether `solve` succeeds, at last with every row yielding to its own impulse by a share too
    /// small to matter: rows that repeat each other, joints' or contacts', become independent.
    template <class Solve>
    bool solved_with_ties(const Solve& solve);

    bool solve_velocities(const btContactSolverInfo& info);

    /// The push apart of what overlaps: the same rows, whose right side is a contact's depth. Where
    /// it cannot be solved nothing is pushed in this step; the velocities, which are, stay.
    void push_apart(const btContactSolverInfo& info);

    ShiftedLcp shifted_;
    bool direct_;
    /// Dantzig's method. Lemke's, which inverts A, is left as it is: with every row softened, it
    /// made nonsense of a contact in float.
    bool pivots_;
    SoftConstraints soft_;
    std::vector<int> compliant_; ///< rows with C > 0
};

} // namespace ductile::bullet

#ifndef DUCTILE_COMPILED
#include "ductile/bullet/soft_mlcp_solver.ipp"
#endif
