// SPDX-License-Identifier: MIT
//
// The force at the end of a step, predicted before the solve: what the bounds of the rows are made
// around (row_box.hpp).
//
//   f_t = f - Z (2u - u₀),   f' = project(f_t) in the metric of Z
//
// f_t is the force that would stop the rows if everybody else pushed as in the last step. Exact where
// Z is and the load is steady; where Z is wrong, flow with a finite velocity still gets the force
// whose normal is that velocity, as Z u outweighs f.
//
// Do not predict from the last force alone, f' = f: a row without force would get the bound 0, flow
// freely, carry no force, and so keep the bound 0.
//
// Symbols
//   f      force of the last step                                                 [N | N m]
//   u, u₀  velocities of the rows at the start of this step and of the last one   [m/s | rad/s]
//   Z      impedance (M⁻¹ + K⁻¹/dt²)⁻¹/dt; M/dt for rigid rows (impedance.hpp)    [N s/m | N m s]
//
// Source: derived here.
#pragma once

#include "ductile/surface/surface.hpp"

namespace ductile {

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

} // namespace ductile
