// SPDX-License-Identifier: MIT
//
// Every surface once, and random vectors and stiffnesses for the properties they share.
#pragma once

#include <rapidcheck.h>

#include <Eigen/Core>
#include <limits>

#include "ductile/surface/bending_torsion.hpp"
#include "ductile/surface/biaxial_rectangle.hpp"
#include "ductile/surface/ellipsoid.hpp"
#include "ductile/surface/i_axial_bending.hpp"
#include "ductile/surface/independent_axes.hpp"
#include "ductile/surface/rectangle_axial_bending.hpp"
#include "ductile/surface/scaled.hpp"
#include "ductile/surface/surface.hpp"
#include "ductile/surface/tube_axial_bending.hpp"

namespace ductile::test {

/// 200 x 200 x 15 x 9 mm, the one of the tabulated interaction curves.
template <class S>
inline constexpr IAxialBendingParameters<S> i_200{
    .height = S(0.2), .width = S(0.2), .web_thickness = S(0.009), .flange_thickness = S(0.015)};

/// Calls visit(name, surface) for every kind of surface.
template <class S, class Visit>
void for_every_surface(Visit&& visit) {
    visit("rectangle n-m", RectangleAxialBending<S>());
    visit("circle n-m", CircleAxialBending<S>());
    visit("thin tube n-m", ThinTubeAxialBending<S>());
    visit("tube n-m", TubeAxialBending<S>({.outer_radius = S(0.05), .inner_radius = S(0.04)}));
    visit("I strong n-m", IAxialBending<S>(i_200<S>, BendingAxis::strong));
    visit("I weak n-m", IAxialBending<S>(i_200<S>, BendingAxis::weak));
    visit("rectangle n-mx-my", BiaxialRectangle<S>());
    visit("bending-torsion",
          BendingTorsion<S>({.plastic_moment = S(1.2), .plastic_torque = S(0.8)}));
    visit("ellipsoid", Ellipsoid<S, 6>({.capacity = {S(1), S(2), S(0.5), S(1.5), S(0.7), S(1)}}));
    visit("independent axes", IndependentAxes<S, 3>({.capacity = {S(1), S(2), S(0.5)}}));
    visit("scaled rectangle n-m",
          Scaled(RectangleAxialBending<S>(), ScaledParameters<S, 2>{.capacity = {S(2), S(0.6)}}));
    visit(
        "scaled rectangle n-mx-my",
        Scaled(BiaxialRectangle<S>(), ScaledParameters<S, 3>{.capacity = {S(3), S(0.8), S(0.5)}}));
}

/// Uniform in [low, high].
template <class S>
S any_number(S low, S high) {
    constexpr int cells = 1 << 23; // exact in float
    return low + (high - low) * S(*rc::gen::inRange(0, cells + 1)) / S(cells);
}

/// Entries in [-1, 1], now and then exactly 0.
template <class Vector>
Vector any_vector() {
    using S = typename Vector::Scalar;
    Vector v;
    for (int i = 0; i < v.size(); ++i) {
        v[i] = *rc::gen::inRange(0, 8) == 0 ? S(0) : any_number(S(-1), S(1));
    }
    return v;
}

/// Not zero.
template <class Vector>
Vector any_direction() {
    Vector v = any_vector<Vector>();
    RC_PRE(v.norm() > typename Vector::Scalar(0.01));
    return v;
}

/// Symmetric, positive definite, fully coupled, condition up to about 100.
template <class Matrix>
Matrix any_stiffness() {
    using S = typename Matrix::Scalar;
    Matrix root;
    for (int i = 0; i < root.rows(); ++i) {
        for (int j = 0; j < root.cols(); ++j) root(i, j) = any_number(S(-1), S(1));
    }
    return root * root.transpose() + S(0.1) * Matrix::Identity();
}

} // namespace ductile::test
