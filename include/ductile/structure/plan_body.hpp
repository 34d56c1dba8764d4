// SPDX-License-Identifier: MIT
//
// A rigid body of a structure: about its centre of mass, in its principal axes, of which x is the
// one nearest to the world's x and so on. The box that others touch need be in neither.
//
// So the boxes of members along the world's axes are turned by nothing at all. It matters: box
// against box, an engine may take the cross product of two edges that are parallel but for
// round-off for an axis that parts them (ODE 0.16 does), and a crate loses its contact for a step.
#pragma once

#include <array>
#include <cmath>
#include <string>

#include "ductile/joint/link_types.hpp"
#include "ductile/numeric/lu.hpp"
#include "ductile/numeric/symmetric_axes.hpp"
#include "ductile/structure/structure_model.hpp"
#include "ductile/vocabulary/vector.hpp"

namespace ductile {

/// A rigid body to be made.
struct PlanBody {
    std::string name;
    double mass = 0;                                        ///< [kg]
    Vector3<double> inertia = Vector3<double>::Zero();      ///< about the body's axes [kg m²]
    JointFrame<double> pose;                                ///< of centre of mass and axes, world
    JointFrame<double> box;                                 ///< of the shape, in the body
    Vector3<double> half_lengths = Vector3<double>::Zero(); ///< of the shape, along its axes [m]
    bool collides = true;
};

namespace detail {

/// Of a uniform box about its middle [kg m²].
[[nodiscard]] inline Matrix3<double> box_inertia(double mass, const Vector3<double>& half) {
    Matrix3<double> tensor = Matrix3<double>::Zero();
    for (int i = 0; i < 3; ++i) {
        const double u = half[(i + 1) % 3], v = half[(i + 2) % 3];
        tensor(i, i) = mass / 3 * (u * u + v * v);
    }
    return tensor;
}

/// Of a uniform bar of a section about its middle, in the member's axes [kg m²].
[[nodiscard]] inline Matrix3<double> bar_inertia(double mass, double length,
                                                 const MemberSection& s) {
    Matrix3<double> tensor = Matrix3<double>::Zero();
    tensor(0, 0) = mass * (length * length / 12 + s.second_moment_x / s.area);
    tensor(1, 1) = mass * (length * length / 12 + s.second_moment_y / s.area);
    tensor(2, 2) = mass * (s.second_moment_x + s.second_moment_y) / s.area;
    tensor(0, 1) = tensor(1, 0) = -mass * s.product / s.area;
    return tensor;
}

/// The axes (columns) in the order and with the signs in which they are nearest to the world's: a
/// signed permutation P, to be used as axes P, right-handed.
[[nodiscard]] inline Matrix3<double> nearest_order(const Matrix3<double>& axes) {
    Matrix3<double> order = Matrix3<double>::Zero();
    std::array<bool, 3> taken_row{}, taken_column{};
    for (int count = 0; count < 3; ++count) {
        int row = -1, column = -1;
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j < 3; ++j) {
                if (taken_row[std::size_t(i)] || taken_column[std::size_t(j)]) continue;
                if (row >= 0 && !(std::abs(axes(i, j)) > std::abs(axes(row, column)))) continue;
                row = i;
                column = j;
            }
        }
        taken_row[std::size_t(row)] = taken_column[std::size_t(column)] = true;
        order(column, row) = axes(row, column) < 0 ? -1 : 1;
    }
    if (numeric::determinant(order) < 0) order.col(2) *= -1;
    return order;
}

/// Puts a body, whose inertia in its present axes is `tensor`, into its principal axes.
inline void turn_to_principal(PlanBody& body, const Matrix3<double>& tensor) {
    const auto principal = numeric::symmetric_axes(tensor);
    const Matrix3<double> order = nearest_order(times(body.pose.axes, principal.axes));
    const Matrix3<double> turn = times(principal.axes, order);
    for (int i = 0; i < 3; ++i) {
        body.inertia[i] = 0;
        for (int j = 0; j < 3; ++j) body.inertia[i] += std::abs(order(j, i)) * principal.values[j];
    }
    body.pose.axes = times(body.pose.axes, turn);
    body.box.origin = transposed_times(turn, body.box.origin);
    body.box.axes = transposed_times(turn, body.box.axes);
    // a box that lies along the body's axes is described by these
    const bool along = body.box.axes.cwiseAbs2() == body.box.axes.cwiseAbs();
    if (!along) return;
    body.half_lengths = times(Matrix3<double>(body.box.axes.cwiseAbs()), body.half_lengths);
    body.box.axes = Matrix3<double>::Identity();
}

} // namespace detail

} // namespace ductile
