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

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <type_traits>
#include <vector>

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

    bool solveMLCP(const btMatrixXu& a, const btVectorXu& b, btVectorXu& x, const btVectorXu& lower,
                   const btVectorXu& upper, const btAlignedObjectArray<int>& limit_dependency,
                   int iterations, bool use_sparsity = true) override {
        const int n = b.rows();
        if (n == 0) return true;
        for (btVectorXu* v : {&shift_, &pushed_, &answer_x_}) v->resize(n);
        find_open_rows(lower, upper, limit_dependency);
        for (int i = 0; i < n; ++i) {
            shift_[i] = limit_dependency[i] < 0 ? clamped(0, lower[i], upper[i]) : btScalar(0);
            answer_x_[i] = shift_[i];
        }
        if (!open_.empty() &&
            !solve_open(a, b, x, lower, upper, limit_dependency, iterations, use_sparsity)) {
            return false;
        }
        if (answer_ == Answer::exact && !settle(a, b, lower, upper, limit_dependency)) return false;
        for (int i = 0; i < n; ++i) x[i] = answer_x_[i];
        return true;
    }

  private:
    static constexpr int closed = -1;

    /// All rows but those of given force. Friction may depend on one of those, which then stays.
    void find_open_rows(const btVectorXu& lower, const btVectorXu& upper,
                        const btAlignedObjectArray<int>& limit_dependency) {
        const int n = lower.rows();
        place_.assign(std::size_t(n), closed);
        for (int i = 0; i < n; ++i) {
            const int on = limit_dependency[i];
            if (on >= 0) place_[std::size_t(on)] = 0;
            if (on >= 0 || lower[i] < upper[i]) place_[std::size_t(i)] = 0;
        }
        open_.clear();
        for (int i = 0; i < n; ++i) {
            if (place_[std::size_t(i)] == closed) continue;
            place_[std::size_t(i)] = int(open_.size());
            open_.push_back(i);
        }
    }

    /// Writes the open rows of answer_x_.
    bool solve_open(const btMatrixXu& a, const btVectorXu& b, const btVectorXu& x,
                    const btVectorXu& lower, const btVectorXu& upper,
                    const btAlignedObjectArray<int>& limit_dependency, int iterations,
                    bool use_sparsity) {
        const int m = int(open_.size());
        multiply(a, shift_, pushed_);
        const btScalar unit = impulse_unit(a, b, x);
        for (btVectorXu* v : {&b_, &x_, &lower_, &upper_}) v->resize(m);
        dependency_.resizeNoInitialize(m);
        for (int k = 0; k < m; ++k) {
            const int i = open_[std::size_t(k)];
            const int on = limit_dependency[i];
            b_[k] = (b[i] - pushed_[i]) / unit;
            x_[k] = (x[i] - shift_[i]) / unit;
            lower_[k] = on < 0 ? scaled(lower[i] - shift_[i], unit) : lower[i];
            upper_[k] = on < 0 ? scaled(upper[i] - shift_[i], unit) : upper[i];
            dependency_[k] = on < 0 ? on : place_[std::size_t(on)];
        }
        if (!inner_->solveMLCP(m == b.rows() ? a : open_part(a), b_, x_, lower_, upper_,
                               dependency_, iterations, use_sparsity)) {
            return false;
        }
        for (int k = 0; k < m; ++k) {
            const int i = open_[std::size_t(k)];
            const btScalar impulse = shift_[i] + unit * x_[k];
            if (!std::isfinite(impulse)) return false;
            answer_x_[i] = limit_dependency[i] < 0 ? clamped(impulse, lower[i], upper[i]) : impulse;
        }
        return true;
    }

    const btMatrixXu& open_part(const btMatrixXu& a) {
        const int m = int(open_.size());
        open_a_.resize(m, m);
        for (int row = 0; row < m; ++row) {
            for (int column = 0; column < m; ++column) {
                open_a_.setElem(row, column,
                                a(open_[std::size_t(row)], open_[std::size_t(column)]));
            }
        }
        return open_a_;
    }

    static btScalar clamped(btScalar value, btScalar lower, btScalar upper) noexcept {
        return std::min(std::max(value, lower), upper);
    }

    /// Bullet writes "no bound" as ±SIMD_INFINITY, a finite number that must survive the scaling.
    static btScalar scaled(btScalar bound, btScalar unit) noexcept {
        return clamped(std::abs(bound) < SIMD_INFINITY ? bound / unit : bound, -SIMD_INFINITY,
                       SIMD_INFINITY);
    }

    static void multiply(const btMatrixXu& a, const btVectorXu& x, btVectorXu& result) {
        const int n = x.rows();
        for (int i = 0; i < n; ++i) result[i] = 0;
        for (int j = 0; j < n; ++j) {
            if (x[j] == 0) continue;
            for (int i = 0; i < n; ++i) result[i] += a(i, j) * x[j];
        }
    }

    /// Power of two of the order of the impulses: what each row would take alone, or starts from.
    btScalar impulse_unit(const btMatrixXu& a, const btVectorXu& b, const btVectorXu& x) const {
        btScalar largest = 0;
        for (int i = 0; i < b.rows(); ++i) {
            const btScalar alone =
                a(i, i) > 0 ? std::abs(b[i] - pushed_[i]) / a(i, i) : btScalar(0);
            largest = std::max({largest, alone, std::abs(x[i] - shift_[i])});
        }
        if (!(largest > 0) || !std::isfinite(largest)) return 1;
        return std::ldexp(btScalar(1), std::ilogb(largest));
    }

    /// True where answer_x_ meets the conditions of every row but those of friction. A row's
    /// violation is how far a step to its own optimum would still take it, as a velocity.
    /// Velocities are those asked for, those by which rows push each other, and A_ii x_i of rows
    /// between their bounds: at a bound, the compliance's share in it is of no consequence and may
    /// be huge.
    /// Rows that belong on a bound are then put there to the last bit: who reads an impulse asks
    /// whether it is at its bound, and shift, scale and Lemke's inverse each leave it beside.
    bool settle(const btMatrixXu& a, const btVectorXu& b, const btVectorXu& lower,
                const btVectorXu& upper, const btAlignedObjectArray<int>& limit_dependency) {
        multiply(a, answer_x_, pushed_);
        btScalar most = 0, scale = 0;
        for (int i = 0; i < b.rows(); ++i) {
            scale = std::max(scale, std::abs(b[i]));
            for (int j = 0; j < b.rows(); ++j) {
                if (i != j) scale = std::max(scale, std::abs(a(i, j) * answer_x_[j]));
            }
            if (limit_dependency[i] >= 0 || !(a(i, i) > 0)) continue;
            if (lower[i] < answer_x_[i] && answer_x_[i] < upper[i]) {
                scale = std::max(scale, std::abs(a(i, i) * answer_x_[i]));
            }
            const btScalar optimum = answer_x_[i] - (pushed_[i] - b[i]) / a(i, i);
            pushed_[i] = clamped(optimum, lower[i], upper[i]);
            most = std::max(most, std::abs(pushed_[i] - answer_x_[i]) * a(i, i));
        }
        if (!(most <= lcp_acceptance<btScalar> * scale)) return false;
        for (int i = 0; i < b.rows(); ++i) {
            if (limit_dependency[i] >= 0 || !(a(i, i) > 0)) continue;
            if (pushed_[i] == lower[i] || pushed_[i] == upper[i]) answer_x_[i] = pushed_[i];
        }
        return true;
    }

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
