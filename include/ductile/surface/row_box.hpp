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
//   predicted_force (stopping_force.hpp)
//       the force that would stop the rows if everybody else pushed as in the last step, projected.
//   box_along
//       the chords of the surface through the predicted force, along each row: exact where only one
//       row strays from the prediction. A corner of the box where the prediction is on the surface,
//       room on all sides where it is inside, and no jump between. This is the mapping to use.
//
// A force far inside the surface still gets its own chords, not a box that is cheaper to find: a
// smaller one would flow below the surface, a larger one leave it, where a load comes that was not
// predicted. The chords are cheap instead, where the surface has a closed form (ChordedSurface).
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
//   independent   -                           0.51   (0.51)       0.50  (0.49)
//
// In one step, a prediction off by 5 degrees costs box_along at most 0.11 of a capacity in force,
// never outside the surface, and the rest is made up by the next prediction.
//
// Symbols
//   f_t    force that would stop all rows                                         [N | N m]
//   u      velocities along the axes of the surface                               [m/s | rad/s]
//   M      effective mass, (J m⁻¹ Jᵀ)⁻¹; symmetric, positive definite             [kg | kg m²]
//
// Source: derived here.
#pragma once

#include <Eigen/Core>
#include <concepts>

#include "ductile/surface/chords.hpp"
#include "ductile/surface/surface.hpp"

namespace ductile {

/// Bounds of rows: lower ≤ f ≤ upper. Plain value.
template <std::floating_point S, int N>
struct RowBox {
    Eigen::Matrix<S, N, 1> lower = Eigen::Matrix<S, N, 1>::Zero();     ///< [N | N m], <= upper
    Eigen::Matrix<S, N, 1> upper = Eigen::Matrix<S, N, 1>::Zero();     ///< [N | N m]
};

/// The chords of the surface through `predicted` along the axes. A prediction outside is
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

} // namespace ductile
