// SPDX-License-Identifier: MIT
//
// A row for engines whose bounds are the same both ways, as motors and friction are in most of
// them. The core's row is  u' + C λ = b,  lower dt <= λ <= upper dt;  the engine's, with the force
// f, is
//
//   u' + C dt f = v,   |f| <= h.
//
// With c midway between the bounds and h half their distance, c is applied to both bodies as a
// force or couple from outside for the step, and the engine's row does the rest:
//
//   f = λ/dt - c,   v = b - C dt c,   and the force of the joint is f + c.
//
// Limit cases: bounds that are equal leave a given force and no row, h = 0; without bounds c = 0,
// and likewise with a bound one way only, which a symmetric row cannot say. Where the engine's row
// is rigid (C dt has nowhere to go) only joints without an elastic part fit.
//
// Symbols as in row.hpp; c, h, f in [N | N m], v in [m/s | rad/s].
#pragma once

#include <cmath>

#include "ductile/vocabulary/row.hpp"

namespace ductile {

struct SymmetricRow {
    double centre = 0;   ///< c, to be applied from outside [N | N m]
    double strength = 0; ///< h; infinite: no bounds [N | N m]
    double velocity = 0; ///< v [m/s | rad/s]
    double cfm = 0;      ///< C dt, "constraint force mixing" in ODE [s/kg | s/(kg m²)]
};

/// For a step of `dt` > 0 [s].
[[nodiscard]] inline SymmetricRow symmetric_row(const RowLimits<double>& limits,
                                                double dt) noexcept {
    const double half = (limits.upper - limits.lower) / 2;
    const double centre = std::isfinite(half) ? (limits.lower + limits.upper) / 2 : 0;
    const double cfm = limits.compliance * dt;
    return {.centre = centre, .strength = half, .velocity = limits.bias - cfm * centre, .cfm = cfm};
}

} // namespace ductile
