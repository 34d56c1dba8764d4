// SPDX-License-Identifier: MIT
//
// A row of the core as a motor of ODE. The core's row is  u' + C λ = b,  lower dt <= λ <= upper dt;
// a motor or friction row of ODE, with the force f, is
//
//   u' + CFM f = Vel,   |f| <= FMax.
//
// With the centre c and the half width h of the bounds, c is applied to both bodies as an outside
// force or couple for the step, and the row does the rest:
//
//   f = λ/dt - c,   FMax = h,   CFM = C dt,   Vel = b - C dt c.
//
// Limit cases: bounds that are equal leave a given force and no row, h = 0; without bounds c = 0.
#pragma once

#include <cmath>

#include "ductile/vocabulary/row.hpp"

namespace ductile::ode {

struct SymmetricRow {
    double centre = 0;   ///< c, to be applied from outside [N | N m]
    double strength = 0; ///< h [N | N m]
    double velocity = 0; ///< Vel [m/s | rad/s]
    double cfm = 0;      ///< [s/kg | s/(kg m²)]
};

/// For a step of `dt` > 0 [s], for the share `share` of which the row's forces act.
[[nodiscard]] inline SymmetricRow symmetric_row(const RowLimits<double>& limits, double dt,
                                                double share) noexcept {
    const double half = share * (limits.upper - limits.lower) / 2;
    const double centre = std::isfinite(half) ? share * (limits.lower + limits.upper) / 2 : 0;
    const double cfm = limits.compliance * dt;
    return {.centre = centre, .strength = half, .velocity = limits.bias - cfm * centre, .cfm = cfm};
}

} // namespace ductile::ode
