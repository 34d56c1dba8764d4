// SPDX-License-Identifier: MIT
//
// The closest-point return to a curved yield surface, in the metric of the inverse stiffness.
//
// Solved for the flow e instead of the force, because corners of the surface are smooth there:
//
//   minimise  φ(e) = ½ eᵀ K e - eᵀ f_trial + h(e),   h(e) = support(e)·e
//   ∇φ = K e - f_trial + support(e) = 0   ⇔   f = f_trial - K e = support(e), e normal there
//
// φ is strictly convex and its Hessian K + support_slope(e) is positive definite, so Newton with
// backtracking converges from anywhere; the answer support(e) is on the surface whatever is left of
// the residual. Corners of h, which flat parts of a surface cause, are not allowed: a box has its
// own projection.
//
// Limit cases: f_trial → surface: e → 0, f → f_trial; f_trial → ∞: f → support of K⁻¹ f_trial.
//
// Source: closest-point projection: Simo & Hughes (1998), Computational Inelasticity, section 3.6;
// the dual form in e after Moreau (1965), doi:10.24033/bsmf.1625, written out here. Cost: 4-10
// Newton steps of one Cholesky factorisation each.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <concepts>
#include <limits>

#include "ductile/numeric/ldlt.hpp"
#include "ductile/numeric/small_vector.hpp"
#include "ductile/surface/surface.hpp"

namespace ductile {

/// `support_slope(flow)` is the derivative of `support`, symmetric, positive semidefinite.
template <class T>
concept CurvedSurface = requires(const T surface, const typename T::Vector& vector) {
    { surface.value(vector) }
    noexcept->std::same_as<typename T::Scalar>;
    { surface.normal(vector) }
    noexcept->std::same_as<typename T::Vector>;
    { surface.support(vector) }
    noexcept->std::same_as<typename T::Vector>;
    { surface.support_slope(vector) }
    noexcept->std::same_as<typename T::Matrix>;
};

/// The closest force and the flow that leads there. Plain value.
template <class Vector>
struct ClosestPoint {
    Vector force;                 ///< [N | N m]
    Vector flow = Vector::Zero(); ///< e
    bool inside = false;          ///< the trial itself
};

/// `trial` where it is inside, else the closest force on the surface, with its flow. `stiffness`
/// symmetric, positive definite.
template <CurvedSurface T>
[[nodiscard]] ClosestPoint<typename T::Vector> find_closest(
    const T& surface, const typename T::Vector& trial,
    const typename T::Matrix& stiffness) noexcept {
    using S = typename T::Scalar;
    using Vector = typename T::Vector;
    using Matrix = typename T::Matrix;
    constexpr int N = T::dimension;
    constexpr S epsilon = std::numeric_limits<S>::epsilon();
    constexpr int max_steps = 60;
    constexpr int max_halvings = 40;

    const S value = surface.value(trial);
    if (!(value > 1 + on_surface<S>)) return {.force = trial, .inside = true};

    // a stiffness of order one keeps K e, f and h(e) comparable whatever the units
    S mean = 0;
    for (int i = 0; i < N; ++i) mean += stiffness(i, i) / S(N);
    Matrix k;
    for (int i = 0; i < N; ++i) {
        for (int j = 0; j < N; ++j) k(i, j) = stiffness(i, j) / mean;
    }
    const auto potential = [&](const Vector& e, const Vector& force) {
        return numeric::dot(e, numeric::times(k, e)) / 2 - numeric::dot(e, trial) +
               numeric::dot(e, force);
    };
    const auto norm = [](const Vector& x) { return std::sqrt(numeric::dot(x, x)); };
    const auto moved = [](const Vector& from, S by, const Vector& along) {
        Vector to;
        for (int i = 0; i < N; ++i) to[i] = from[i] + by * along[i];
        return to;
    };

    const Vector normal = surface.normal(trial);
    const S first = (value - 1) / numeric::dot(normal, numeric::times(k, normal));
    Vector e = moved(Vector::Zero(), first, normal);
    Vector force = surface.support(e);
    const S size = norm(trial);
    for (int step = 0; step < max_steps; ++step) {
        const Vector downhill = moved(moved(trial, -1, force), -1, numeric::times(k, e)); // -∇φ
        if (norm(downhill) <= 4 * epsilon * size) return {force, Vector(e / mean)};
        Matrix hessian = surface.support_slope(e);
        for (int i = 0; i < N; ++i) {
            for (int j = 0; j < N; ++j) hessian(i, j) += k(i, j);
        }
        const Vector change = numeric::solve_semidefinite(hessian, downhill);
        const S descent = -numeric::dot(change, downhill);
        const S phi = potential(e, force);
        const S noise = 8 * epsilon * (std::abs(phi) + norm(e) * size);
        S part = 1;
        Vector next = moved(e, 1, change);
        Vector next_force = surface.support(next);
        for (int halving = 0; halving < max_halvings; ++halving) {
            if (potential(next, next_force) <= phi + S(1e-4) * part * descent + noise) break;
            part /= 2;
            next = moved(e, part, change);
            next_force = surface.support(next);
        }
        const bool settled = part * norm(change) <= epsilon * norm(e);
        e = next;
        force = next_force;
        if (settled) break;
    }
    // where the surface is curved so sharply that round-off of e moves the support point
    const Vector elastic = moved(trial, -1, numeric::times(k, e));
    if (norm(moved(elastic, -1, force)) > 64 * epsilon * size) {
        force = elastic / surface.value(elastic);
    }
    return {force, Vector(e / mean)};
}

template <CurvedSurface T>
[[nodiscard]] typename T::Vector closest_point(const T& surface, const typename T::Vector& trial,
                                               const typename T::Matrix& stiffness) noexcept {
    return find_closest(surface, trial, stiffness).force;
}

} // namespace ductile
