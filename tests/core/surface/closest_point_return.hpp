// SPDX-License-Identifier: MIT
//
// One increment of an elastic, perfectly plastic joint whose axes share a yield surface:
//
//   trial = f + K Δq,   f' = project(trial),   Δq_p = K⁻¹ (trial - f')
//
// The increment may be of any size; the error of a path that turns is of first order in it. In
// constant direction the answer is exact. The radial return puts f' = trial/γ(trial); it equals the
// closest point only where the surface is an ellipsoid of the shape of K.
//
// Source: Simo & Hughes (1998), Computational Inelasticity, section 3.6; radial: Wilkins (1964).
#pragma once

#include "ductile/numeric/ldlt.hpp"
#include "ductile/surface/surface.hpp"

namespace ductile {

/// What an increment left. Plain value.
template <class Vector>
struct Return {
    Vector force; ///< f', inside or on the surface [N | N m]
    Vector flow;  ///< Δq_p [m | rad]
};

/// Closest-point return: associated flow. `stiffness` symmetric, positive definite [N/m | N m/rad].
template <YieldSurface T>
[[nodiscard]] Return<typename T::Vector> return_closest(
    const T& surface, const typename T::Vector& force, const typename T::Vector& increment,
    const typename T::Matrix& stiffness) noexcept {
    const typename T::Vector trial = force + stiffness * increment;
    const typename T::Vector next = surface.project(trial, stiffness);
    return {next, numeric::solve_semidefinite(stiffness, typename T::Vector(trial - next))};
}

/// Radial return.
template <YieldSurface T>
[[nodiscard]] Return<typename T::Vector> return_radially(
    const T& surface, const typename T::Vector& force, const typename T::Vector& increment,
    const typename T::Matrix& stiffness) noexcept {
    const typename T::Vector trial = force + stiffness * increment;
    const typename T::Vector next = project_radially(surface, trial);
    return {next, numeric::solve_semidefinite(stiffness, typename T::Vector(trial - next))};
}

} // namespace ductile
