// SPDX-License-Identifier: MIT
//
// Makes any of Bullet's LCP solvers (Dantzig, Lemke, PGS) fit for rows whose bounds do not enclose
// zero, and tells whether it solved what it was given:
//
//   w = A x - b,   lower <= x <= upper,   w >= 0 at lower, w <= 0 at upper, w = 0 in between.
//
// Why
//   - btDantzigSolver takes lower <= 0 <= upper for granted and does not check it. A row of given
//     force (lower = upper ≠ 0) and the bounds of a row that hardens kinematically break that. With
//     s = clamp(0, lower, upper), x = s + y turns the problem into the same one for y with
//     b - A s and bounds that enclose zero.
//   - btLemkeSolver fails on rows whose bounds are equal, a degenerate case for its pivoting. Rows
//     of given force are nothing to be solved and are left out: the inner problem is smaller.
//   - btDantzigSolver gives up where a *starting* impulse is 1000 N s or more, btLemkeSolver where
//     a result passes 1e5 N s. The problem is therefore handed on in units of its own impulses, by
//     a power of two, which changes no digit.
//   - btLemkeSolver returns true where its pivoting ended without a solution. So each solution
//     is checked; what fails the check is reported as failed, and btMLCPSolver goes back to
//     sequential impulse for that island and counts it (`getNumFallbacks`).
//
// Friction rows (`limit_dependency` >= 0) hold coefficients for bounds, not impulses: they are
// neither shifted nor scaled. They are not checked either, because every solver has a friction rule
// of its own: Dantzig freezes the normal impulses when it meets the first friction row, PGS follows
// them, Lemke takes the coefficient for an impulse [N s].
//
// Symbols
//   x, s, y  impulses                            [N s | N m s]
//   b, w     velocities                          [m/s | rad/s]
//   A        J M⁻¹ Jᵀ + C, symmetric, row-major  [1/kg | 1/(kg m²)]
#pragma once

#include <BulletDynamics/MLCPSolvers/btMLCPSolverInterface.h>
#include <LinearMath/btMatrixX.h>

#include <type_traits>
#include <vector>

#include "ductile/vocabulary/linkage.hpp"

namespace ductile::bullet {

/// What is asked of an LCP solver's answer.
enum class Answer {
    exact,   ///< of a direct solver: what violates its conditions has failed
    iterated ///< of an iterative one: every finite answer is accepted
};

/// Largest violation of an exact answer, as a share of the velocities involved: far above the
/// round-off of a chain of joints and far below what a failed pivoting leaves, which is of order 1.
template <class Scalar>
inline constexpr Scalar lcp_acceptance = std::is_same_v<Scalar, float> ? Scalar(1e-2)
                                                                       : Scalar(1e-6);

/// Scratch memory is kept between solves. Not thread-safe: one per solver.
class ShiftedLcp final : public btMLCPSolverInterface {
  public:
    /// `inner` must outlive this.
    ShiftedLcp(btMLCPSolverInterface& inner, Answer answer) noexcept
        : inner_(&inner), answer_(answer) {}

    DUCTILE_INLINE bool solveMLCP(const btMatrixXu& a, const btVectorXu& b, btVectorXu& x,
                                  const btVectorXu& lower, const btVectorXu& upper,
                                  const btAlignedObjectArray<int>& limit_dependency, int iterations,
                                  bool use_sparsity = true) override;

  private:
    static constexpr int closed = -1;

    /// All rows but those of given force. Friction may depend on one of those, which then stays.
    void find_open_rows(const btVectorXu& lower, const btVectorXu& upper,
                        const btAlignedObjectArray<int>& limit_dependency);

    /// Writes the open rows of answer_x_.
    bool solve_open(const btMatrixXu& a, const btVectorXu& b, const btVectorXu& x,
                    const btVectorXu& lower, const btVectorXu& upper,
                    const btAlignedObjectArray<int>& limit_dependency, int iterations,
                    bool use_sparsity);

    const btMatrixXu& open_part(const btMatrixXu& a);

    static btScalar clamped(btScalar value, btScalar lower, btScalar upper) noexcept;

    /// Bullet writes "no bound" as ±SIMD_INFINITY, a finite number that must survive the scaling.
    static btScalar scaled(btScalar bound, btScalar unit) noexcept;

    static void multiply(const btMatrixXu& a, const btVectorXu& x, btVectorXu& result);

    /// Power of two of the order of the impulses: what each row would take alone, or starts from.
    btScalar impulse_unit(const btMatrixXu& a, const btVectorXu& b, const btVectorXu& x) const;

    /// True where answer_x_ meets the conditions of every row but those of friction. A row's
    /// violation is how far a step to its own optimum would still take it, as a velocity.
    /// Velocities are those asked for, those by which rows push each other, and A_ii x_i of rows
    /// between their bounds: at a bound, the compliance's share in it is of no consequence and may
    /// be huge.
    /// Rows that belong on a bound are then put there to the last bit: who reads an impulse asks
    /// whether it is at its bound, and shift, scale and Lemke's inverse each leave it beside.
    bool settle(const btMatrixXu& a, const btVectorXu& b, const btVectorXu& lower,
                const btVectorXu& upper, const btAlignedObjectArray<int>& limit_dependency);

    btMLCPSolverInterface* inner_;
    Answer answer_;
    btVectorXu shift_, answer_x_;
    btVectorXu pushed_;      ///< A x [m/s]; then each row's own optimum [N s]
    std::vector<int> open_;  ///< rows that are solved
    std::vector<int> place_; ///< of a row among the open ones
    btMatrixXu open_a_;
    btVectorXu b_, x_, lower_, upper_; ///< of the open rows, in units of the impulses
    btAlignedObjectArray<int> dependency_;
};

} // namespace ductile::bullet

#ifndef DUCTILE_COMPILED
#include "ductile/bullet/shifted_lcp.ipp"
#endif
