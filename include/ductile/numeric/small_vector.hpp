// SPDX-License-Identifier: MIT
//
// The few operations on vectors of any fixed size that a coupled joint does in every step. They have
// names so that each is compiled once per size: every further shape of an Eigen expression costs a
// compiler some dozens of types.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <concepts>
#include <limits>

namespace ductile::numeric {

/// Σ a_i b_i.
template <std::floating_point S, int N>
[[nodiscard]] S dot(const Eigen::Matrix<S, N, 1>& a, const Eigen::Matrix<S, N, 1>& b) noexcept {
    return a.dot(b);
}

/// A x.
template <std::floating_point S, int N>
[[nodiscard]] Eigen::Matrix<S, N, 1> times(const Eigen::Matrix<S, N, N>& a,
                                           const Eigen::Matrix<S, N, 1>& x) noexcept {
    return a.lazyProduct(x);
}

/// max |x_i|.
template <std::floating_point S, int N>
[[nodiscard]] S largest(const Eigen::Matrix<S, N, 1>& x) noexcept {
    return x.cwiseAbs().maxCoeff();
}

/// |x|, whatever its size: where the squares would leave the range of S they are scaled.
template <std::floating_point S, int N>
[[nodiscard]] S length(const Eigen::Matrix<S, N, 1>& x) noexcept {
    constexpr S least = std::numeric_limits<S>::min() / std::numeric_limits<S>::epsilon();
    const S square = dot(x, x);
    if ((square > least && square < 1 / least) || square != square) return std::sqrt(square);
    const S scale = largest(x);
    if (!(scale > 0 && scale <= std::numeric_limits<S>::max())) return scale;
    S sum = 0;
    for (int i = 0; i < N; ++i) sum += (x[i] / scale) * (x[i] / scale);
    return scale * std::sqrt(sum);
}

} // namespace ductile::numeric
