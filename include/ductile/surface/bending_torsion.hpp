// SPDX-License-Identifier: MIT
//
// Bending with torsion: the ellipse (M/M_p)² + (T/T_p)² = 1. Exact for a thin round tube with von
// Mises yield; for any other section a safe (lower) bound, since the stresses of pure bending scaled
// by M/M_p and those of pure torsion scaled by T/T_p are in equilibrium and nowhere beyond yield.
//
// Source: Hill & Siebel (1951), Philosophical Magazine 42; (1953), J. Mech. Phys. Solids 1.
#pragma once

#include <concepts>
#include <limits>

#include "ductile/surface/ellipsoid.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile {

template <std::floating_point S>
struct BendingTorsionParameters {
    S plastic_moment = std::numeric_limits<S>::quiet_NaN(); ///< M_p [N m], > 0
    S plastic_torque = std::numeric_limits<S>::quiet_NaN(); ///< T_p [N m], > 0
};

/// Surface in (M, T) [N m].
template <std::floating_point S>
class BendingTorsion : public Ellipsoid<S, 2> {
  public:
    /// @throws std::invalid_argument where a capacity is missing (NaN), infinite or not positive.
    explicit BendingTorsion(const BendingTorsionParameters<S>& parameters)
        : Ellipsoid<S, 2>({.capacity = {check::positive("BendingTorsion.plastic_moment",
                                                        parameters.plastic_moment, "N m"),
                                        check::positive("BendingTorsion.plastic_torque",
                                                        parameters.plastic_torque, "N m")}}) {}
};

template <std::floating_point S>
BendingTorsion(const BendingTorsionParameters<S>&) -> BendingTorsion<S>;

static_assert(YieldSurface<BendingTorsion<double>> && YieldSurface<BendingTorsion<float>>);

} // namespace ductile
