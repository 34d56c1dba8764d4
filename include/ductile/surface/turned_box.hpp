// SPDX-License-Identifier: MIT
//
// Rows turned so that the first is the normal of the yield surface at the predicted force, all of
// them orthogonal in M⁻¹: they decouple, which iterative solvers like, and the flow has the direction
// of the predicted normal. But rows tangent to the surface hold that direction like constraints, also
// where the flow should turn: a `window` ends their grip where the surface would be exceeded by about
// that much. box_along (row_box.hpp, where both are measured) is the mapping to use.
//
// With M/tr M = C Cᵀ the basis is C Q, Q orthogonal with its first column along Cᵀ∇γ: then
// basisᵀ M⁻¹ basis is a multiple of 1, and the first covector is a multiple of ∇γ.
//
// Symbols as in row_box.hpp.
//
// Source: the tangent plane of turned rows is one step of the cutting-plane return of Ortiz & Simo
// (1986), doi:10.1002/nme.1620230303; derived here.
#pragma once

#include <Eigen/Core>
#include <algorithm>

#include "ductile/numeric/cholesky.hpp"
#include "ductile/numeric/householder.hpp"
#include "ductile/numeric/lu.hpp"
#include "ductile/surface/chords.hpp"
#include "ductile/surface/row_box.hpp"
#include "ductile/surface/surface.hpp"

namespace ductile {

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
