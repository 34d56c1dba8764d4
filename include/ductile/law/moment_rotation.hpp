// SPDX-License-Identifier: MIT
//
// From the moment-curvature curve of a section to the law of a hinge: the curvature is taken as
// constant over a hinge length, the elastic part becomes the hinge's spring, the rest its backbone.
//
//   θ = κ L_p,   k = EI/L_p,   θ_p = θ - M/k,   R(θ_p) = M
//
// Symbols
//   κ, M  curvature, moment              [1/m], [N m]
//   L_p   hinge length                   [m]
//   k     elastic stiffness of the hinge [N m/rad]
//   θ_p   plastic rotation               [rad]
//
// Knots. The first is the proof moment, where the plastic share of the rotation reaches `proof`;
// there plastic rotation is taken to start, which a rigid-plastic row needs and which costs that
// share of accuracy at the knee. The others lie in geometric progression up to `curvature_max`,
// close together where the backbone bends. The error between knots is of order 2 in their number.
// Beyond the last knot the moment stays constant.
//
// A hinge length is an assumption, not a property of the section: half the depth of the section up
// to its depth is usual for steel. Energy and rotation capacity scale with it.
//
// Source: plastic hinge length after Baker (1956), The Steel Skeleton II; proof stress as in
// tensile tests, here on the curvature.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <span>
#include <string>

#include "ductile/law/moment_curvature.hpp"
#include "ductile/law/multilinear.hpp"
#include "ductile/law/root.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile {

template <std::floating_point S>
struct HingeParameters {
    S length = std::numeric_limits<S>::quiet_NaN(); ///< L_p [m], > 0
    S curvature_max =
        std::numeric_limits<S>::quiet_NaN(); ///< of the last knot [1/m], > the proof one
    S proof = S(1e-3);      ///< plastic share of the curvature at the first knot [-], in (0, 0.5)
    std::size_t knots = 16; ///< in [2, Capacity]
};

/// The law of a hinge: a spring and a backbone in series.
template <std::floating_point S, std::size_t Capacity = 32>
struct MomentRotation {
    S stiffness;                       ///< k [N m/rad]
    Multilinear<S, Capacity> backbone; ///< R(θ_p) [N m]
};

/// Law of a hinge that bends in the direction of positive curvature.
/// @throws std::invalid_argument where a parameter is missing (NaN) or out of range, or where the
/// section stays elastic up to the largest curvature, or flows under its axial force alone.
template <std::size_t Capacity = 32, class Section, class Curve, class Rule>
[[nodiscard]] MomentRotation<typename Section::Scalar, Capacity> moment_rotation(
    const MomentCurvature<Section, Curve, Rule>& bending,
    const HingeParameters<typename Section::Scalar>& parameters) {
    using S = typename Section::Scalar;
    const S length = check::positive("Hinge.length", parameters.length, "m");
    const S last = check::positive("Hinge.curvature_max", parameters.curvature_max, "1/m");
    const S proof = check::between("Hinge.proof", parameters.proof, S(0), S(0.5), "");
    const std::size_t knots = parameters.knots;
    if (knots < 2 || knots > Capacity) {
        check::fail("Hinge.knots", S(knots), "", "in [2, " + std::to_string(Capacity) + "]");
    }

    const S stiffness = bending.bending_stiffness();
    const auto plastic_excess = [&](S curvature) {
        return bending.residual_curvature(curvature) - proof * curvature;
    };
    if (!(plastic_excess(last) > 0)) {
        check::fail("Hinge.curvature_max", last, "1/m",
                    "beyond the proof curvature of the section");
    }
    // walk down by halves: the excess has a second root at zero
    S below = last;
    while (plastic_excess(below) > 0 && below > S(1e-6) * last) below /= 2;
    if (plastic_excess(below) > 0) {
        check::fail("Hinge.proof", proof, "",
                    "more than the plastic share under axial force and no curvature");
    }
    const S first =
        bracketed_root(below, std::min(2 * below, last), S(1e-6) * below, plastic_excess);

    std::array<StrengthPoint<S>, Capacity> points;
    for (std::size_t i = 0; i < knots; ++i) {
        const S share = S(i) / S(knots - 1);
        const S curvature = first * std::pow(last / first, share);
        const S moment = bending.moment(curvature);
        const S plastic = length * (curvature - moment / stiffness);
        points[i] = {i == 0 ? S(0) : plastic, moment};
    }
    return {.stiffness = stiffness / length,
            .backbone =
                Multilinear<S, Capacity>(std::span<const StrengthPoint<S>>(points.data(), knots))};
}

} // namespace ductile
