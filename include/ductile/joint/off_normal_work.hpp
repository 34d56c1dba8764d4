// SPDX-License-Identifier: MIT
//
// How much of a step's plastic work was done along another direction than associated flow: more than
// round-off where the bounds of the rows were set around the wrong force (row_box.hpp).
//
//   ½ Σ_i |f_i (Δ_i - Δ*_i)|,   Δ* = -D/γ(f) ∇γ(f): the associated flow of the same work, f·Δ* = -D
//
// Symbols
//   f   forces of the rows                                  [N | N m]
//   Δ   plastic travel of the rows in the step, f·Δ = -D    [m | rad]
//   D   work of flow in the step                            [J]
//   γ   gauge of the yield surface                          [-]
#pragma once

#include <cmath>

#include "ductile/surface/surface.hpp"

namespace ductile {

/// [J], >= 0; zero where nothing flowed.
template <YieldSurface Surface>
[[nodiscard]] typename Surface::Scalar off_normal_work(const Surface& surface,
                                                       const typename Surface::Vector& force,
                                                       const typename Surface::Vector& travel,
                                                       typename Surface::Scalar work) noexcept {
    if (!(work > 0)) return 0;
    const typename Surface::Vector normal = surface.normal(force);
    const typename Surface::Scalar length = work / surface.value(force);
    typename Surface::Scalar sum = 0;
    for (int i = 0; i < Surface::dimension; ++i) {
        sum += std::abs(force[i] * (travel[i] + length * normal[i]));
    }
    return sum / 2;
}

} // namespace ductile
