// SPDX-License-Identifier: MIT
//
// Cholesky factorisation of a small symmetric, positive definite matrix, for use with one or a few
// right-hand sides; without square roots.
//
//   A = L D Lᵀ,   A x = b  ⇔  L y = b, D z = y, Lᵀ x = z;   the factor of A = C Cᵀ is C = L √D
//
// Why not Eigen's: for matrices this small its blocked kernels are compiled and never run, which
// was a good part of the time that a program with a joint took to compile. Sums of products, row by
// column, suit a compiler that knows N: it keeps them in registers.
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
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
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
        for (int j = 0; j < N; ++j) {
            std::array<S, std::size_t(N)> scaled{}; // row j of L D
            S pivot = a(j, j);
            for (int k = 0; k < j; ++k) {
                scaled[std::size_t(k)] = l_(j, k) * d_[k];
                pivot -= l_(j, k) * scaled[std::size_t(k)];
            }
            succeeded_ = succeeded_ && pivot > 0;
            regular_ = regular_ && pivot * pivot > epsilon * a(j, j) * a(j, j);
            d_[j] = pivot;
            inverse_d_[j] = 1 / pivot;
            for (int i = j + 1; i < N; ++i) {
                S left = a(i, j);
                for (int k = 0; k < j; ++k) left -= l_(i, k) * scaled[std::size_t(k)];
                l_(i, j) = left * inverse_d_[j];
            }
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
        for (int i = 0; i < N; ++i) {
            for (int k = 0; k < i; ++k) x[i] -= l_(i, k) * x[k];
        }
        for (int i = 0; i < N; ++i) x[i] *= inverse_d_[i];
        for (int i = N - 1; i >= 0; --i) {
            for (int k = i + 1; k < N; ++k) x[i] -= l_(k, i) * x[k];
        }
        return x;
    }

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
