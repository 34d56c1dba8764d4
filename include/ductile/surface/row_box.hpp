// SPDX-License-Identifier: MIT
//
// A yield surface as bounds of independent rows.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>
#include <Eigen/QR>
#include <concepts>
#include <limits>

#include "ductile/surface/box_projection.hpp"
#include "ductile/surface/surface.hpp"

namespace ductile {

/// Bounds of rows: force = basis g, lower ≤ g ≤ upper; the rows' velocities are basisᵀ u. Plain value.
template <std::floating_point S, int N>
struct RowBox {
    Eigen::Matrix<S, N, N> basis = Eigen::Matrix<S, N, N>::Identity(); ///< column i: row i [-]
    Eigen::Matrix<S, N, 1> lower = Eigen::Matrix<S, N, 1>::Zero();     ///< [N | N m]
    Eigen::Matrix<S, N, 1> upper = Eigen::Matrix<S, N, 1>::Zero();     ///< [N | N m]
};

/// The force a converged solver of the rows answers to `trial`, the force that would stop all rows.
template <std::floating_point S, int N>
[[nodiscard]] Eigen::Matrix<S, N, 1> enforce(const RowBox<S, N>& box,
                                             const Eigen::Matrix<S, N, 1>& trial,
                                             const Eigen::Matrix<S, N, N>& stiffness) noexcept {
    const Eigen::Matrix<S, N, N> inverse = box.basis.inverse();
    const Eigen::Matrix<S, N, N> k = inverse * stiffness * inverse.transpose();
    return box.basis * project_on_box<S, N>(inverse * trial, box.lower, box.upper, k);
}

/// How far one can go from `point` inside or on the surface along `along` before leaving it, >= 0.
template <YieldSurface T>
[[nodiscard]] typename T::Scalar reach(const T& surface, const typename T::Vector& point,
                                       const typename T::Vector& along) noexcept {
    using S = typename T::Scalar;
    constexpr int max_steps = 100;
    const S rate = surface.value(along);
    if (!(rate > 0)) return 0;
    S t = (1 + surface.value(point)) / rate; // γ(p + t b) >= t γ(b) - γ(p) = 1
    for (int step = 0; step < max_steps; ++step) {
        const typename T::Vector there = point + t * along;
        const S slope = surface.normal(there).dot(along);
        const S next = t - (surface.value(there) - 1) / slope; // convex: from above, monotone
        if (!(next < t)) break;
        if (!(next > 0)) return 0;
        t = next;
    }
    return t;
}

template <YieldSurface T>
[[nodiscard]] RowBox<typename T::Scalar, T::dimension> box_along(
    const T& surface, const typename T::Vector& predicted) noexcept {
    RowBox<typename T::Scalar, T::dimension> box;
    const typename T::Vector point = project_radially(surface, predicted);
    for (int i = 0; i < T::dimension; ++i) {
        const typename T::Vector axis = box.basis.col(i);
        box.upper[i] = point[i] + reach(surface, point, axis);
        box.lower[i] = point[i] - reach(surface, point, (-axis).eval());
    }
    return box;
}

template <YieldSurface T>
[[nodiscard]] RowBox<typename T::Scalar, T::dimension> turned_box(
    const T& surface, const typename T::Vector& predicted,
    const typename T::Matrix& stiffness) noexcept {
    using Vector = typename T::Vector;
    using Matrix = typename T::Matrix;
    RowBox<typename T::Scalar, T::dimension> box;
    const Vector normal = surface.normal(predicted);
    if (!(normal.squaredNorm() > 0)) {
        return box_along(surface, predicted);
    }
    const Matrix factor = stiffness.llt().matrixL();
    const Vector turned = factor.transpose() * normal;
    const Matrix rotation = turned.householderQr().householderQ() * Matrix::Identity();
    box.basis = factor * rotation;
    const Matrix covectors = box.basis.inverse();
    for (int i = 0; i < T::dimension; ++i) {
        const Vector flow = covectors.row(i).transpose();
        box.upper[i] = flow.dot(surface.support(flow));
        box.lower[i] = -box.upper[i];
    }
    return box;
}

} // namespace ductile
