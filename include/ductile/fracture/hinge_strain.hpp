// SPDX-License-Identifier: MIT
//
// From the travel of a plastic row to the strain of its material, as fatigue laws want it.
//
//   hinge   ε = θ (h/2) / L_p     outermost fibre, curvature θ/L_p uniform over the hinge length
//   bar     ε = Δl / l            uniform elongation
//
// Symbols
//   θ    plastic rotation                                                  [rad]
//   h    depth of the section across the bending axis, neutral axis midway [m]
//   L_p  length over which the rotation is spread, about h/2 to h          [m]
//   l    length that elongates plastically                                 [m]
//
// Source: equivalent hinge length as in Priestley, Seible & Calvi (1996), Seismic Design and
// Retrofit of Bridges; strain by Bernoulli's hypothesis (plane sections). L_p is an assumption, and
// the fatigue life goes with its power 1/|c|, about 1.67: state it with every life.
#pragma once

#include <concepts>
#include <limits>

#include "ductile/vocabulary/check.hpp"

namespace ductile {

template <std::floating_point S>
struct HingeStrainParameters {
    S height = std::numeric_limits<S>::quiet_NaN();       ///< h [m], > 0
    S hinge_length = std::numeric_limits<S>::quiet_NaN(); ///< L_p [m], > 0
};

template <std::floating_point S>
struct BarStrainParameters {
    S length = std::numeric_limits<S>::quiet_NaN(); ///< l [m], > 0
};

/// Strain of the outermost fibre per plastic rotation, (h/2)/L_p [1/rad].
/// @throws std::invalid_argument where a length is missing (NaN), infinite or not positive.
template <std::floating_point S>
[[nodiscard]] S hinge_strain(const HingeStrainParameters<S>& parameters) {
    const S height = check::positive("HingeStrain.height", parameters.height, "m");
    return height / 2 / check::positive("HingeStrain.hinge_length", parameters.hinge_length, "m");
}

/// Strain per plastic elongation, 1/l [1/m].
/// @throws std::invalid_argument where the length is missing (NaN), infinite or not positive.
template <std::floating_point S>
[[nodiscard]] S bar_strain(const BarStrainParameters<S>& parameters) {
    return 1 / check::positive("BarStrain.length", parameters.length, "m");
}

} // namespace ductile
