// SPDX-License-Identifier: MIT
//
// Small symmetric systems that may be singular, such as those of two bodies that cannot move along
// some axis, by L D Lᵀ with diagonal pivoting: the largest of what is left on the diagonal goes
// first.
//
//   Π A Πᵀ = L D Lᵀ,   x = Πᵀ L⁻ᵀ D⁺ L⁻¹ Π b,   D⁺: 1/d, and 0 where |d| is zero or denormal
//
// Where A is positive definite and far from singular the order of the pivots does not matter, and
// none is looked for (cholesky.hpp).
//
// Limit cases: A positive definite: the solution; a row and column of zeros: its entry of x is
// zero, whatever b, and the others are those of the system without it, so that a matrix of fewer
// rows than N is filled up with zeros; A = 0: x = 0.
//
// Symbols
//   A   symmetric, N×N, positive semidefinite: an indefinite one is solved without defence against
//       the growth of round-off
//   Π   permutation;  L  unit lower triangular;  D  diagonal, falling
//
// Source: Golub & Van Loan (2013), Matrix Computations, 4th edition, algorithm 4.1.1 and, on the
// pivots, section 4.2.8.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <utility>

#include "ductile/numeric/cholesky.hpp"

namespace ductile::numeric {

/// x with A x = b; a solution of the least-squares kind is not sought where there is none. Not
/// finite where A or b is not. Cost: N³/6 multiplications.
template <std::floating_point S, int N>
[[nodiscard]] Eigen::Matrix<S, N, 1> solve_semidefinite(const Eigen::Matrix<S, N, N>& a,
                                                        const Eigen::Matrix<S, N, 1>& b) noexcept {
    if (const Cholesky<S, N> plain(a); plain.regular()) return plain.solve(b);
    std::array<int, std::size_t(N)> order; // row i of Π A is row order[i] of A
    const auto of = [&](int i) { return order[std::size_t(i)]; };
    Eigen::Matrix<S, N, N> l;
    Eigen::Matrix<S, N, 1> d, inverse;
    for (int i = 0; i < N; ++i) {
        order[std::size_t(i)] = i;
        d[i] = a(i, i);
    }
    int rank = 0;
    for (; rank < N; ++rank) {
        const int k = rank;
        int pivot = k;
        for (int i = k + 1; i < N; ++i) {
            if (std::abs(d[i]) > std::abs(d[pivot])) pivot = i;
        }
        if (std::abs(d[pivot]) <= std::numeric_limits<S>::min()) break; // so are all that are left
        if (pivot != k) {
            std::swap(order[std::size_t(k)], order[std::size_t(pivot)]);
            std::swap(d[k], d[pivot]);
            for (int j = 0; j < k; ++j) std::swap(l(k, j), l(pivot, j));
        }
        std::array<S, std::size_t(N)> scaled{}; // row k of L D
        for (int j = 0; j < k; ++j) scaled[std::size_t(j)] = l(k, j) * d[j];
        inverse[k] = 1 / d[k];
        for (int i = k + 1; i < N; ++i) {
            S left = a(of(i), of(k));
            for (int j = 0; j < k; ++j) left -= l(i, j) * scaled[std::size_t(j)];
            l(i, k) = left * inverse[k];
            d[i] -= left * l(i, k);
        }
    }
    Eigen::Matrix<S, N, 1> y;
    for (int i = 0; i < rank; ++i) {
        y[i] = b[of(i)];
        for (int j = 0; j < i; ++j) y[i] -= l(i, j) * y[j];
    }
    Eigen::Matrix<S, N, 1> x = Eigen::Matrix<S, N, 1>::Zero();
    for (int i = rank - 1; i >= 0; --i) {
        y[i] *= inverse[i];
        for (int j = i + 1; j < rank; ++j) y[i] -= l(j, i) * y[j];
        x[of(i)] = y[i];
    }
    return x;
}

} // namespace ductile::numeric
