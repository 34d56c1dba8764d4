// SPDX-License-Identifier: MIT
//
// Cholesky factorisation of a small symmetric, positive definite matrix, for use with one or a few
// right-hand sides; without square roots.
//
//   A = L D Lᵀ,   A x = b  ⇔  L y = b, D z = y, Lᵀ x = z;   the factor of A = C Cᵀ is C = L √D
//
// Why not Eigen's: for matrices this small its blocked kernels are compiled and never run, which
// was a good part of the time that a program with a joint took to compile. Columns as a whole, in
// loops that are written out, suit a compiler that knows N: two rows a register, no counting.
//
// A matrix of fewer rows than N is filled up with those of 1, and solved as fast as one of N.
//
// Symbols
//   A   symmetric, N×N; only its lower triangle is read
//   L   unit lower triangular;  D  diagonal, positive where A is positive definite
//
// Source: Golub & Van Loan (2013), Matrix Computations, 4th edition, algorithm 4.1.1.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <concepts>
#include <limits>

namespace ductile::numeric {

/// Plain value. Cost: N³/6 multiplications, N² for each solution.
template <std::floating_point S, int N>
class Cholesky {
  public:
    using Vector = Eigen::Matrix<S, N, 1>;
    using Matrix = Eigen::Matrix<S, N, N>;

    /// To be assigned to; not a factorisation.
    Cholesky() = default;
    explicit Cholesky(const Matrix& a) noexcept : succeeded_(true), regular_(true) {
        constexpr S epsilon = std::numeric_limits<S>::epsilon();
#pragma GCC unroll 6
        for (int j = 0; j < N; ++j) { // column j of L D, and of L
            Vector column;
#pragma GCC unroll 6
            for (int i = j; i < N; ++i) column[i] = a(i, j);
#pragma GCC unroll 6
            for (int k = 0; k < j; ++k) {
                const S share = l_(j, k) * d_[k];
#pragma GCC unroll 6
                for (int i = j; i < N; ++i) column[i] -= l_(i, k) * share;
            }
            const S pivot = column[j];
            succeeded_ = succeeded_ && pivot > 0;
            regular_ = regular_ && pivot * pivot > epsilon * a(j, j) * a(j, j);
            d_[j] = pivot;
            inverse_d_[j] = 1 / pivot;
#pragma GCC unroll 6
            for (int i = j + 1; i < N; ++i) l_(i, j) = column[i] * inverse_d_[j];
        }
    }

    /// True where A was positive definite, to round-off; else solutions mean nothing.
    [[nodiscard]] bool succeeded() const noexcept { return succeeded_; }
    /// True where A is so far from singular that no more than half of the digits of any entry of D
    /// cancelled.
    [[nodiscard]] bool regular() const noexcept { return succeeded_ && regular_; }

    /// x with A x = b.
    [[nodiscard]] Vector solve(const Vector& b) const noexcept {
        Vector x = b;
#pragma GCC unroll 6
        for (int j = 0; j < N; ++j) {
#pragma GCC unroll 6
            for (int i = j + 1; i < N; ++i) x[i] -= l_(i, j) * x[j];
        }
        for (int i = 0; i < N; ++i) x[i] *= inverse_d_[i];
#pragma GCC unroll 6
        for (int i = N - 1; i >= 0; --i) {
#pragma GCC unroll 6
            for (int k = i + 1; k < N; ++k) x[i] -= l_(k, i) * x[k];
        }
        return x;
    }

    /// Entry of L below its diagonal, and of D⁻¹.
    [[nodiscard]] S below(int i, int j) const noexcept { return l_(i, j); }
    [[nodiscard]] S inverse_pivot(int i) const noexcept { return inverse_d_[i]; }

    /// C = L √D, with zeros above its diagonal.
    [[nodiscard]] Matrix lower() const noexcept {
        Matrix result = Matrix::Zero();
        for (int j = 0; j < N; ++j) {
            result(j, j) = std::sqrt(d_[j]);
            for (int i = j + 1; i < N; ++i) result(i, j) = l_(i, j) * result(j, j);
        }
        return result;
    }

  private:
    Matrix l_; ///< below the diagonal
    Vector d_;
    Vector inverse_d_;
    bool succeeded_ = false, regular_ = false;
};

} // namespace ductile::numeric
