// SPDX-License-Identifier: MIT
//
// Small square matrices without symmetry: L U factorisation with partial pivoting, inverse and
// determinant. Up to 3×3 the last two are in closed form, by cofactors.
//
//   Π A = L U,   A x = b  ⇔  L y = Π b, U x = y,   det A = ± u_11 ... u_NN
//
// Symbols
//   A   N×N
//   Π   permutation;  L  unit lower triangular;  U  upper triangular
//
// Source: Golub & Van Loan (2013), Matrix Computations, 4th edition, algorithm 3.4.1, with the sums
// taken as in section 3.2.9 (Crout, Doolittle).
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <utility>

namespace ductile::numeric {

/// Plain value. Cost: N³/3 multiplications, N² for each solution.
template <std::floating_point S, int N>
class Lu {
  public:
    using Vector = Eigen::Matrix<S, N, 1>;
    using Matrix = Eigen::Matrix<S, N, N>;

    /// To be assigned to; not a factorisation.
    Lu() = default;
    explicit Lu(const Matrix& a) noexcept : factors_(a) {
        for (int i = 0; i < N; ++i) order_[std::size_t(i)] = i;
        for (int k = 0; k < N; ++k) {
            for (int i = 1; i < N; ++i) { // column k of U, and below it of L times the pivot
                for (int j = 0; j < (i < k ? i : k); ++j) {
                    factors_(i, k) -= factors_(i, j) * factors_(j, k);
                }
            }
            int pivot = k;
            for (int i = k + 1; i < N; ++i) {
                if (std::abs(factors_(i, k)) > std::abs(factors_(pivot, k))) pivot = i;
            }
            if (pivot != k) {
                odd_ = !odd_;
                std::swap(order_[std::size_t(k)], order_[std::size_t(pivot)]);
                for (int j = 0; j < N; ++j) std::swap(factors_(k, j), factors_(pivot, j));
            }
            inverse_pivots_[k] = 1 / factors_(k, k);
            if (factors_(k, k) == 0) continue; // and so is all below it
            for (int i = k + 1; i < N; ++i) factors_(i, k) *= inverse_pivots_[k];
        }
    }

    /// x with A x = b; not finite where A is singular.
    [[nodiscard]] Vector solve(const Vector& b) const noexcept {
        Vector x;
        for (int i = 0; i < N; ++i) {
            x[i] = b[order_[std::size_t(i)]];
            for (int k = 0; k < i; ++k) x[i] -= factors_(i, k) * x[k];
        }
        for (int i = N - 1; i >= 0; --i) {
            for (int k = i + 1; k < N; ++k) x[i] -= factors_(i, k) * x[k];
            x[i] *= inverse_pivots_[i];
        }
        return x;
    }

    /// A⁻¹; not finite where A is singular.
    [[nodiscard]] Matrix inverse() const noexcept {
        Matrix result;
        Vector unit = Vector::Zero();
        for (int j = 0; j < N; ++j) {
            unit[j] = 1;
            const Vector column = solve(unit);
            for (int i = 0; i < N; ++i) result(i, j) = column[i];
            unit[j] = 0;
        }
        return result;
    }

    [[nodiscard]] S determinant() const noexcept {
        S result = odd_ ? S(-1) : S(1);
        for (int k = 0; k < N; ++k) result *= factors_(k, k);
        return result;
    }

  private:
    Matrix factors_;                        ///< L below the diagonal, U on and above it
    Vector inverse_pivots_;                 ///< 1/u_ii
    std::array<int, std::size_t(N)> order_; ///< row i of Π A is this row of A
    bool odd_ = false;                      ///< Π swaps an odd number of rows
};

template <std::floating_point S>
[[nodiscard]] S determinant(const Eigen::Matrix<S, 3, 3>& a) noexcept {
    return a(0, 0) * (a(1, 1) * a(2, 2) - a(1, 2) * a(2, 1)) +
           a(1, 0) * (a(2, 1) * a(0, 2) - a(2, 2) * a(0, 1)) +
           a(2, 0) * (a(0, 1) * a(1, 2) - a(0, 2) * a(1, 1));
}

/// A⁻¹; not finite where A is singular. Up to 3×3 it loses as many digits as det A is small beside
/// |A|ᴺ: enough for masses and inertias; where A may be nearly singular, Lu loses fewer.
template <std::floating_point S, int N>
[[nodiscard]] Eigen::Matrix<S, N, N> inverse(const Eigen::Matrix<S, N, N>& a) noexcept {
    Eigen::Matrix<S, N, N> result;
    if constexpr (N == 1) {
        result(0, 0) = 1 / a(0, 0);
    } else if constexpr (N == 2) {
        const S scale = 1 / (a(0, 0) * a(1, 1) - a(1, 0) * a(0, 1));
        result(0, 0) = a(1, 1) * scale;
        result(1, 0) = -a(1, 0) * scale;
        result(0, 1) = -a(0, 1) * scale;
        result(1, 1) = a(0, 0) * scale;
    } else if constexpr (N == 3) {
        const S xx = a(0, 0), yx = a(1, 0), zx = a(2, 0);
        const S xy = a(0, 1), yy = a(1, 1), zy = a(2, 1);
        const S xz = a(0, 2), yz = a(1, 2), zz = a(2, 2);
        const S x = yy * zz - yz * zy, y = zy * xz - zz * xy, z = xy * yz - xz * yy;
        const S scale = 1 / (xx * x + yx * y + zx * z);
        result(0, 0) = x * scale;
        result(1, 0) = (yz * zx - yx * zz) * scale;
        result(2, 0) = (yx * zy - yy * zx) * scale;
        result(0, 1) = y * scale;
        result(1, 1) = (zz * xx - zx * xz) * scale;
        result(2, 1) = (zx * xy - zy * xx) * scale;
        result(0, 2) = z * scale;
        result(1, 2) = (xz * yx - xx * yz) * scale;
        result(2, 2) = (xx * yy - xy * yx) * scale;
    } else {
        result = Lu<S, N>(a).inverse();
    }
    return result;
}

} // namespace ductile::numeric
