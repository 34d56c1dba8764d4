// SPDX-License-Identifier: MIT
//
// Boxed linear complementarity problem, solved exactly by an active set:
//
//   w = A λ + g,   lower <= λ <= upper,   w >= 0 at lower, w <= 0 at upper, w = 0 in between,
//
// which is the optimum of ½ λᵀA λ + gᵀλ in the box. A = J M⁻¹ Jᵀ + C is symmetric and positive
// semidefinite, singular as soon as a structure is statically indeterminate: λ is then not unique,
// but w and the velocities are.
//
// Method. A set F of free rows solves A_FF λ_F = -(g + A λ_rest)_F; a row that meets its bound on
// the way leaves F, and the row outside F that violates its condition most enters. A row enters
// only where w ≠ 0, and w vanishes for every row that depends on F, so A_FF stays regular although
// A is not. The objective falls at every entry also where several rows sit exactly on their bounds
// (the ties of symmetric problems: such a row leaves F in a step of length zero, the entering one
// never does), so no set comes back.
//
// Certificate. Every solution is checked on its own terms, w against λ, and std::runtime_error is
// thrown where a condition is violated by more than `tolerance` of the largest velocity involved.
//
// Symbols
//   λ  impulses of the rows            [N s | N m s]
//   w  u' + C λ - b after the solve    [m/s | rad/s]
//   g  the same at λ = 0               [m/s | rad/s]
//
// Source: Lawson and Hanson (1974), Solving Least Squares Problems, chapter 23 (NNLS); Stark and
// Parker (1995), Computational Statistics 10, 129-141 (bounds on both sides). Deviation: rows may
// rest between their bounds, which lets a solve start from λ = 0 or from the step before.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <type_traits>
#include <vector>

namespace ductile::reference {

template <std::floating_point S>
using Vector = Eigen::Matrix<S, Eigen::Dynamic, 1>;
template <std::floating_point S>
using Matrix = Eigen::Matrix<S, Eigen::Dynamic, Eigen::Dynamic>;

/// Largest violation of a row's condition, as a share of the largest |g| or |A λ|.
template <std::floating_point S>
inline constexpr S lcp_tolerance = std::is_same_v<S, float> ? S(2e-5) : S(1e-10);

/// Violation of one row's condition, >= 0 [m/s | rad/s].
template <std::floating_point S>
[[nodiscard]] S lcp_violation(S w, S lambda, S lower, S upper) {
    if (w < 0) return lambda < upper ? -w : S(0);
    return lambda > lower ? w : S(0);
}

/// Remembers the last free set and solution, and starts the next solve of the same size there.
template <std::floating_point S>
class BoxedLcp {
  public:
    /// @throws std::runtime_error where no solution within lcp_tolerance is found.
    const Vector<S>& solve(const Matrix<S>& a, const Vector<S>& g, const Vector<S>& lower,
                           const Vector<S>& upper);

    /// w of the last solve [m/s | rad/s].
    [[nodiscard]] const Vector<S>& slack() const noexcept { return w_; }

  private:
    void restart(Eigen::Index n);

    bool factorise(const Matrix<S>& a);

    /// Moves λ to the optimum over the free set, dropping every row that meets a bound on the way.
    void relax(const Matrix<S>& a, const Vector<S>& g, const Vector<S>& lower,
               const Vector<S>& upper);

    /// Share of `step` that row i can go before it meets its bound; above 1 where it does not.
    S share_to_bound(Eigen::Index i, S step, const Vector<S>& lower, const Vector<S>& upper) const;

    /// The row that violates its condition most and does not depend on the free ones; -1: none.
    Eigen::Index most_violated(const Matrix<S>& a, const Vector<S>& lower,
                               const Vector<S>& upper) const;

    bool independent(const Matrix<S>& a, Eigen::Index i) const {
        if (std::find(free_.begin(), free_.end(), i) != free_.end()) return false;
        S pivot = a(i, i);
        if (!free_.empty()) {
            const Vector<S> column = a(free_, i);
            pivot -= column.dot(factor_.solve(column));
        }
        return pivot > S(100) * std::numeric_limits<S>::epsilon() * a(i, i);
    }

    S velocity_scale(const Matrix<S>& a, const Vector<S>& g) const;

    void certify(const Vector<S>& lower, const Vector<S>& upper) const;

    Vector<S> lambda_;
    Vector<S> w_;
    S scale_ = 0;
    std::vector<Eigen::Index> free_;
    Eigen::LLT<Matrix<S>> factor_;
};

template <std::floating_point S>
const Vector<S>& BoxedLcp<S>::solve(const Matrix<S>& a, const Vector<S>& g, const Vector<S>& lower,
                                    const Vector<S>& upper) {
    const Eigen::Index n = g.size();
    if (lambda_.size() != n) restart(n);
    lambda_ = lambda_.cwiseMax(lower).cwiseMin(upper);
    std::erase_if(
        free_, [&](Eigen::Index i) { return !(lambda_[i] > lower[i] && lambda_[i] < upper[i]); });
    if (!factorise(a)) restart(n);

    const int most = 50 * int(n) + 100;
    for (int entries = 0; entries <= most; ++entries) {
        relax(a, g, lower, upper);
        w_ = a * lambda_ + g;
        scale_ = velocity_scale(a, g);
        const Eigen::Index entering = most_violated(a, lower, upper);
        if (entering < 0) {
            certify(lower, upper);
            return lambda_;
        }
        free_.push_back(entering);
        if (!factorise(a)) throw std::runtime_error("BoxedLcp: an entering row is dependent");
    }
    throw std::runtime_error("BoxedLcp: no solution after " + std::to_string(most) + " entries");
}

template <std::floating_point S>
void BoxedLcp<S>::restart(Eigen::Index n) {
    lambda_ = Vector<S>::Zero(n);
    free_.clear();
}

template <std::floating_point S>
bool BoxedLcp<S>::factorise(const Matrix<S>& a) {
    if (free_.empty()) return true;
    factor_.compute(a(free_, free_));
    return factor_.info() == Eigen::Success;
}

template <std::floating_point S>
void BoxedLcp<S>::relax(const Matrix<S>& a, const Vector<S>& g, const Vector<S>& lower,
                        const Vector<S>& upper) {
    while (!free_.empty()) {
        // from the other rows alone, not as a change of λ, which would leave the round-off of
        // what λ was; refined once, because chains are ill conditioned, ~N⁴
        Vector<S> reached = lambda_;
        reached(free_).setZero();
        const Vector<S> solved = factor_.solve(-(a(free_, Eigen::all) * reached + g(free_)));
        reached(free_) = solved;
        const Vector<S> left = factor_.solve(-(a(free_, Eigen::all) * reached + g(free_)));
        reached(free_) += left;

        S share = 1;
        for (const Eigen::Index i : free_) {
            share = std::min(share, share_to_bound(i, reached[i] - lambda_[i], lower, upper));
        }
        if (share == 1) {
            for (const Eigen::Index i : free_) {
                lambda_[i] = std::clamp(reached[i], lower[i], upper[i]);
            }
            return;
        }
        std::erase_if(free_, [&](Eigen::Index i) {
            const S step = reached[i] - lambda_[i];
            const bool blocks = share_to_bound(i, step, lower, upper) <= share;
            lambda_[i] = blocks ? (step > 0 ? upper[i] : lower[i])
                                : std::clamp(lambda_[i] + share * step, lower[i], upper[i]);
            return blocks;
        });
        if (!factorise(a)) throw std::runtime_error("BoxedLcp: the free set became singular");
    }
}

template <std::floating_point S>
S BoxedLcp<S>::share_to_bound(Eigen::Index i, S step, const Vector<S>& lower,
                              const Vector<S>& upper) const {
    if (step == 0) return std::numeric_limits<S>::infinity();
    const S room = step > 0 ? upper[i] - lambda_[i] : lambda_[i] - lower[i];
    return room / std::abs(step);
}

template <std::floating_point S>
S BoxedLcp<S>::velocity_scale(const Matrix<S>& a, const Vector<S>& g) const {
    const S pushed = (a.cwiseAbs() * lambda_.cwiseAbs()).maxCoeff();
    return std::max({g.cwiseAbs().maxCoeff(), pushed, std::numeric_limits<S>::min()});
}

template <std::floating_point S>
Eigen::Index BoxedLcp<S>::most_violated(const Matrix<S>& a, const Vector<S>& lower,
                                        const Vector<S>& upper) const {
    Eigen::Index worst = -1;
    S most = S(0.1) * lcp_tolerance<S> * scale_;
    for (Eigen::Index i = 0; i < w_.size(); ++i) {
        const S violation = lcp_violation(w_[i], lambda_[i], lower[i], upper[i]);
        if (violation > most && independent(a, i)) {
            most = violation;
            worst = i;
        }
    }
    return worst;
}

template <std::floating_point S>
void BoxedLcp<S>::certify(const Vector<S>& lower, const Vector<S>& upper) const {
    for (Eigen::Index i = 0; i < w_.size(); ++i) {
        const bool inside = lambda_[i] >= lower[i] && lambda_[i] <= upper[i];
        const S violation = lcp_violation(w_[i], lambda_[i], lower[i], upper[i]);
        if (!inside || !(violation <= lcp_tolerance<S> * scale_)) {
            std::ostringstream message;
            message << "BoxedLcp: row " << i << " violates its condition by " << violation
                    << ", velocities are of the order of " << scale_;
            throw std::runtime_error(message.str());
        }
    }
}

#ifdef DUCTILE_COMPILED
extern template class BoxedLcp<double>; // tests/support/reference_world.cpp
#endif

} // namespace ductile::reference
