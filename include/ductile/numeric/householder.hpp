// SPDX-License-Identifier: MIT
//
// A vector completed to an orthonormal basis, by the reflection that turns it onto the first axis.
//
//   H = 1 - τ v vᵀ,  H x = β e₁,  β = -sign(x₁)|x|,  v = (1, x₂/(x₁-β), ..., x_N/(x₁-β)),
//   τ = (β - x₁)/β
//
// H is symmetric and orthogonal, so that its first column is x/β: along x, but against it where the
// first entry of x is not negative, as then nothing cancels in x₁ - β.
//
// Limit cases: x along the first axis: the axes; x = 0: the axes.
//
// Source: Golub & Van Loan (2013), Matrix Computations, 4th edition, algorithm 5.1.1.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <concepts>
#include <limits>

namespace ductile::numeric {

/// H: columns of unit length at right angles to each other, the first along `x`, in either sense.
template <std::floating_point S, int N>
[[nodiscard]] Eigen::Matrix<S, N, N> basis_along(const Eigen::Matrix<S, N, 1>& x) noexcept {
    Eigen::Matrix<S, N, N> result = Eigen::Matrix<S, N, N>::Identity();
    S rest = 0;
    for (int i = 1; i < N; ++i) rest += x[i] * x[i];
    if (!(rest > std::numeric_limits<S>::min())) return result;
    const S length = std::sqrt(x[0] * x[0] + rest);
    const S beta = x[0] >= 0 ? -length : length;
    Eigen::Matrix<S, N, 1> v = x / (x[0] - beta);
    v[0] = 1;
    const S tau = (beta - x[0]) / beta;
    for (int j = 0; j < N; ++j) {
        for (int i = 0; i < N; ++i) result(i, j) -= tau * v[i] * v[j];
    }
    return result;
}

} // namespace ductile::numeric
