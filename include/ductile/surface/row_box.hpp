// SPDX-License-Identifier: MIT
//
// A yield surface as bounds of independent rows, which is all that a velocity solver can enforce.
//
// What the solver does. With the effective mass M of the rows, its answer inside a box is the force
// closest to f_t, the one that would stop the rows, in the metric M⁻¹; the slip of a row at its
// bound is the flow. The surface itself would answer f* = project(f_t, M). A box that has f* as a
// corner gives that very answer: the solver stays in the corner, as ∇γ(f*) points into its cone,
// and the slips M⁻¹(f_t - f*)/dt are the associated flow. All that is left is to predict f*.
//
//   predicted_force
//       f' = f - Z (2u - u₀), projected in the metric of Z: the force that would stop the rows if
//       everybody else pushed as in the last step. Exact where Z is and the load is steady; where
//       Z is wrong, flow with a finite velocity still gets the force whose normal is that velocity,
//       as Z u outweighs f.
//   box_along
//       the chords of the surface through the predicted force, along each row: exact where only one
//       row strays from the prediction. A corner of the box where the prediction is on the surface,
//       room on all sides where it is inside, and no jump between. This is the mapping to use.
//   turned_box
//       rows turned so that the first is the normal at the predicted force, all of them orthogonal
//       in M⁻¹: they decouple, which iterative solvers like, and the flow has the direction of the
//       predicted normal. But rows tangent to the surface hold that direction like constraints,
//       also where the flow should turn: a `window` ends their grip where the surface would be
//       exceeded by about that much.
//
// A force far inside the surface still gets its own chords, not a box that is cheaper to find: a
// smaller one would flow below the surface, a larger one leave it, where a load comes that was not
// predicted. The chords are cheap instead, where the surface has a closed form (ChordedSurface).
//
// Do not predict from the last force alone, f' = f: a row without force would get the bound 0, flow
// freely, carry no force, and so keep the bound 0.
//
// Measured (bench/surface_mapping prints all of it): plastic travel of a joint after a load that
// turns and then rests inside the surface, largest relative error over ellipse, rectangle, I and
// biaxial rectangle at dt = 1/240 s, and at 1/3840 s in brackets:
//
//   mapping       prediction                  rigid rows          elastic rows
//   exact         - (closest point)           0.0045 (0.00028)    0.015 (0.0010)
//   box_along     predicted_force             0.0036 (0.00027)    0.015 (0.0010)
//   box_along     same, mass wrong by 4       0.0094 (0.00067)    0.016 (0.0010)
//   box_along     last force                  1.2    (1.1)        1.4   (1.4)
//   turned_box    predicted_force             0.017  (0.0024)     0.016 (0.0011)
//   turned_box    same, mass wrong by 4       0.029  (0.0024)     0.016 (0.0011)
//   turned_box    last force                  0.051  (0.048)      0.021 (0.0013)
//   half-space    predicted_force             0.96   (0.99)       0.017 (0.0011)
//   independent   -                           0.51   (0.51)       0.50  (0.49)
//
// In one step, a prediction off by 5 degrees costs box_along at most 0.11 of a capacity in force,
// never outside the surface, and the rest is made up by the next prediction.
//
// Symbols
//   u, u₀  velocities of the rows at the start of this step and of the last one   [m/s | rad/s]
//   M      effective mass, (J m⁻¹ Jᵀ)⁻¹; symmetric, positive definite             [kg | kg m²]
//   Z      impedance (M⁻¹ + K⁻¹/dt²)⁻¹/dt; M/dt for rigid rows                    [N s/m | N m s]
//   g      forces of the rows, f = basis g; their velocities are basisᵀ u         [N | N m]
//
// Source: derived here; the tangent plane of turned rows is one step of the cutting-plane return of
// Ortiz & Simo (1986), doi:10.1002/nme.1620230303.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <concepts>
#include <limits>

#include "ductile/numeric/cholesky.hpp"
#include "ductile/numeric/householder.hpp"
#include "ductile/numeric/lu.hpp"
#include "ductile/surface/box_projection.hpp"
#include "ductile/surface/surface.hpp"

namespace ductile {

/// Bounds of rows: f = basis g, lower ≤ g ≤ upper. Plain value.
template <std::floating_point S, int N>
struct RowBox {
    Eigen::Matrix<S, N, N> basis = Eigen::Matrix<S, N, N>::Identity(); ///< column i: force of row i
    Eigen::Matrix<S, N, 1> lower = Eigen::Matrix<S, N, 1>::Zero();     ///< [N | N m], <= upper
    Eigen::Matrix<S, N, 1> upper = Eigen::Matrix<S, N, 1>::Zero();     ///< [N | N m]
};

/// The force a converged solver of the rows answers to `trial`, the force that would stop them all.
template <std::floating_point S, int N>
[[nodiscard]] Eigen::Matrix<S, N, 1> enforce(const RowBox<S, N>& box,
                                             const Eigen::Matrix<S, N, 1>& trial,
                                             const Eigen::Matrix<S, N, N>& mass) noexcept {
    const Eigen::Matrix<S, N, N> inverse = numeric::inverse(box.basis);
    const Eigen::Matrix<S, N, N> turned = inverse * mass * inverse.transpose();
    return box.basis * project_on_box<S, N>(inverse * trial, box.lower, box.upper, turned);
}

/// The force that would stop the rows in this step if nothing flowed: what the prediction projects.
/// @param impedance  a matrix, or an Impedance
template <class Vector, class Impedance>
[[nodiscard]] Vector stopping_force(const Vector& last_force, const Vector& velocity,
                                    const Vector& last_velocity,
                                    const Impedance& impedance) noexcept {
    Vector ahead = velocity - last_velocity;
    ahead += velocity;
    const Vector met = impedance * ahead;
    return last_force - met;
}

/// Prediction of the force at the end of this step, inside or on the surface.
template <YieldSurface T>
[[nodiscard]] typename T::Vector predicted_force(const T& surface,
                                                 const typename T::Vector& last_force,
                                                 const typename T::Vector& velocity,
                                                 const typename T::Vector& last_velocity,
                                                 const typename T::Matrix& impedance) noexcept {
    return surface.project(stopping_force(last_force, velocity, last_velocity, impedance),
                           impedance);
}

/// Largest t ≥ 0 with `point` + t·`along` not outside; `point` not outside. `along` of any length.
/// By Newton from outside, where the line leaves the tangent plane: 4-8 normals where it crosses
/// the surface, up to 60 where it only touches.
template <YieldSurface T>
[[nodiscard]] typename T::Scalar reach(const T& surface, const typename T::Vector& point,
                                       const typename T::Vector& along) noexcept {
    using S = typename T::Scalar;
    constexpr int max_steps = 100;
    const S rate = surface.value(along);
    if (!(rate > 0)) return 0;
    S t = (1 + surface.value(point)) / rate; // γ(p + t b) ≥ t γ(b) - γ(p) = 1: outside
    for (int step = 0; step < max_steps; ++step) {
        const typename T::Vector normal = surface.normal(point + t * along);
        const S next = (1 - normal.dot(point)) / normal.dot(along);
        if (!(next < t)) break; // convex: falls until round-off
        if (!(next > 0)) return 0;
        t = next;
    }
    return t;
}

/// The chords of the surface through `point` along the axes, in closed form where the surface has
/// one, else by `reach` in both directions. `point` not outside by more than round-off, and never
/// left out by the chords' own: lower ≤ point ≤ upper.
template <YieldSurface T>
[[nodiscard]] Chords<typename T::Vector> chords_through(const T& surface,
                                                        const typename T::Vector& point) noexcept {
    using Vector = typename T::Vector;
    if constexpr (ChordedSurface<T>) {
        const auto [lower, upper] = surface.chords(point);
        return {lower.cwiseMin(point), upper.cwiseMax(point)};
    } else {
        Chords<Vector> chords{point, point};
        for (int i = 0; i < T::dimension; ++i) {
            chords.upper[i] += reach(surface, point, Vector(Vector::Unit(i)));
            chords.lower[i] -= reach(surface, point, Vector(-Vector::Unit(i)));
        }
        return chords;
    }
}

/// The chords of the surface through `predicted` along the axes; basis 1. A prediction outside is
/// drawn in along its ray.
template <YieldSurface T>
[[nodiscard]] RowBox<typename T::Scalar, T::dimension> box_along(
    const T& surface, const typename T::Vector& predicted) noexcept {
    RowBox<typename T::Scalar, T::dimension> box;
    const auto chords = chords_through(surface, project_radially(surface, predicted));
    box.lower = chords.lower;
    box.upper = chords.upper;
    return box;
}

/// Row 0 along the normal at `predicted`, bounded by the tangent planes there and opposite; the
/// others tangent, bounded by the chords through (1 - window) × the predicted force on the surface.
/// @param mass    shape of the effective mass, symmetric, positive definite
/// @param window  in [0, 1]
template <YieldSurface T>
[[nodiscard]] RowBox<typename T::Scalar, T::dimension> turned_box(
    const T& surface, const typename T::Vector& predicted, const typename T::Matrix& mass,
    typename T::Scalar window = typename T::Scalar(0.01)) noexcept {
    using S = typename T::Scalar;
    using Vector = typename T::Vector;
    using Matrix = typename T::Matrix;
    const Vector normal = surface.normal(predicted);
    if (!(normal.squaredNorm() > 0)) return box_along(surface, predicted);

    RowBox<S, T::dimension> box;
    const Matrix root = numeric::Cholesky<S, T::dimension>(mass / mass.trace()).lower();
    const Vector turned = root.transpose() * normal;
    box.basis = root * numeric::basis_along(turned);
    const Matrix covectors = numeric::inverse(box.basis);

    const S value = surface.value(predicted);
    const Vector point =
        value > 1 - window ? Vector(predicted * ((1 - window) / value)) : predicted;
    const Vector g = covectors * point;
    const Vector wanted = covectors * project_radially(surface, predicted); // is never shut out
    const Vector flow = covectors.row(0).transpose();
    box.upper[0] = flow.dot(surface.support(flow));
    box.lower[0] = -box.upper[0];
    for (int i = 1; i < T::dimension; ++i) {
        const Vector along = box.basis.col(i);
        box.upper[i] = std::max(wanted[i], g[i] + reach(surface, point, along));
        box.lower[i] = std::min(wanted[i], g[i] - reach(surface, point, Vector(-along)));
    }
    return box;
}

} // namespace ductile
