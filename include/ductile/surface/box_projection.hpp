// SPDX-License-Identifier: MIT
//
// What a converged solver of independent rows makes of a force: the closest point of a box in the
// metric of the inverse stiffness (the inverse effective mass of the rows).
//
//   minimise ½ (g - g_t)ᵀ K⁻¹ (g - g_t),  lower ≤ g ≤ upper;  slip e = K⁻¹ (g_t - g):
//   e_i = 0 strictly inside, e_i ≥ 0 at the upper, e_i ≤ 0 at the lower bound
//
// Principal pivoting by the least index: only K_BB of the rows at a bound is factorised. Finite for
// every positive definite K.
//
// Source: Murty (1974), Note on a Bard-type scheme, Opsearch 11; with two bounds Júdice & Pires (1994),
// doi:10.1016/0305-0548(94)90106-6.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <concepts>
#include <limits>

#include "ductile/numeric/ldlt.hpp"
#include "ductile/surface/row_box.hpp"

namespace ductile {

/// lower ≤ upper; equal ones prescribe the force. Infinite bounds are allowed.
template <std::floating_point S, int N>
[[nodiscard]] Eigen::Matrix<S, N, 1> project_on_box(
    const Eigen::Matrix<S, N, 1>& trial, const Eigen::Matrix<S, N, 1>& lower,
    const Eigen::Matrix<S, N, 1>& upper, const Eigen::Matrix<S, N, N>& stiffness) noexcept {
    using Vector = Eigen::Matrix<S, N, 1>;
    using Matrix = Eigen::Matrix<S, N, N>;
    enum class Row { free, at_lower, at_upper };
    constexpr int max_pivots = 1000;
    constexpr S epsilon = 16 * std::numeric_limits<S>::epsilon();

    std::array<Row, std::size_t(N)> rows;
    rows.fill(Row::free);
    const auto state = [&](int i) -> Row& { return rows[std::size_t(i)]; };
    const auto bound = [&](int i) { return state(i) == Row::at_upper ? upper[i] : lower[i]; };

    Vector force = trial;
    for (int pivot = 0; pivot < max_pivots; ++pivot) {
        Matrix k = Matrix::Identity();
        Vector excess = Vector::Zero();
        for (int i = 0; i < N; ++i) {
            if (state(i) == Row::free) continue;
            excess[i] = trial[i] - bound(i);
            for (int j = 0; j < N; ++j) k(i, j) = state(j) == Row::free ? S(0) : stiffness(i, j);
        }
        const Vector slip = numeric::solve_semidefinite(k, excess);
        const Vector given = stiffness * slip;
        force = trial - given;
        bool solved = true;
        for (int i = 0; i < N && solved; ++i) {
            const S noise = epsilon * (std::abs(trial[i]) + given.norm());
            if (state(i) == Row::free) {
                if (force[i] > upper[i] + noise) state(i) = Row::at_upper;
                if (force[i] < lower[i] - noise) state(i) = Row::at_lower;
                solved = state(i) == Row::free;
            } else {
                const S outward = state(i) == Row::at_upper ? slip[i] : -slip[i];
                if (outward * stiffness(i, i) < -noise) {
                    state(i) = Row::free;
                    solved = false;
                }
            }
        }
        if (solved) break;
    }
    for (int i = 0; i < N; ++i) {
        if (state(i) != Row::free) force[i] = bound(i);
    }
    return force.cwiseMax(lower).cwiseMin(upper);
}

/// The force a converged solver of the rows answers to `trial`, the force that would stop them all.
template <std::floating_point S, int N>
[[nodiscard]] Eigen::Matrix<S, N, 1> enforce(const RowBox<S, N>& box,
                                             const Eigen::Matrix<S, N, 1>& trial,
                                             const Eigen::Matrix<S, N, N>& mass) noexcept {
    return project_on_box<S, N>(trial, box.lower, box.upper, mass);
}

} // namespace ductile
