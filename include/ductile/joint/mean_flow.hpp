// SPDX-License-Identifier: MIT
//
// The velocity with which rigid rows that share an ellipsoid begin a step that they flow through:
// the mean of it and that of the end is along the normal (coupled_joint.hpp, `meet_surface`).
//
// What is not along the normal decays. With u_i = f_i P/R_i² on the surface and m_i du_i/dt = -f_i
//
//   du_i/dt = -u_i R_i²/(m_i P),   over the mean of a step: u_i' = u_i (1 - z/2)/(1 + z/2),
//   z = h R_i²/(m_i P)
//
// A row far stronger than the one that flows has z >> 2: its velocity would change sign in every
// step and hardly become less. Of what is not along the normal such a row begins with 2/z, so that
// the step ends without.
//
// Symbols
//   u, u'  velocities at the start and end of the step       [m/s | rad/s]
//   f, R   forces on the surface, its semi-axes there        [N | N m]
//   m      effective mass of a row by itself                 [kg | kg m²]
//   P      power of the flow, |f·u|                          [W]
//   h      length of the step                                [s]
//
// Limit cases: z <= 2, as of axes of like strength: u. P → 0 or R_i → ∞: nothing but what is along
// the normal. Source: derived here.
#pragma once

#include <algorithm>
#include <cmath>

#include "ductile/numeric/small_vector.hpp"
#include "ductile/surface/surface.hpp"

namespace ductile {

/// @param force  on the surface, against `start`  @param mass  of the rows, symmetric
/// @param dt     > 0 [s]
template <YieldSurface Surface>
requires requires(const Surface& surface) { surface.semi_axes(); }
[[nodiscard]] typename Surface::Vector flow_at_start(const Surface& surface,
                                                     const typename Surface::Vector& force,
                                                     const typename Surface::Vector& start,
                                                     const typename Surface::Matrix& mass,
                                                     typename Surface::Scalar dt) noexcept {
    using Scalar = typename Surface::Scalar;
    const Scalar gauge = surface.value(force), power = numeric::dot(force, start);
    typename Surface::Vector flow = surface.normal(force);
    flow *= power / gauge;
    for (int i = 0; i < Surface::dimension; ++i) {
        const Scalar strength = surface.semi_axes()[i] * gauge;
        const Scalar kept = 2 * mass(i, i) * std::abs(power) / (dt * strength * strength);
        flow[i] += std::min(kept, Scalar(1)) * (start[i] - flow[i]);
    }
    return flow;
}

} // namespace ductile
