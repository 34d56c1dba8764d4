// SPDX-License-Identifier: MIT
//
// Bending with torsion: the ellipse (M/M_p)² + (T/T_p)² = 1. Exact for a thin round tube with von Mises
// yield; for solid sections a lower bound that is a few per cent low.
//
// Source: Hill & Siebel (1951), doi:10.1080/14786445108561272.
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
