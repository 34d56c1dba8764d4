// SPDX-License-Identifier: MIT
//
// Whether a blow yields a member, and how much of its energy goes into flow. A rigid member takes a
// blow's impulses at once, and its sections moments without bound: told from those every blow
// yields, however weak. An elastic one takes up the energy E that the rigid contact annihilates as
// strain energy of the very profile M̂(s) of moments,
//
//   E = M_1² A,   A = ∫ (M̂/M̂_1)²/(2 EI) ds,   so   M(s) = M̂(s)/τ,   1/τ = √(E / ∫ M̂²/(2 EI) ds)
//
// (a cantilever under a heavy striker: the bound of mass and spring, F = v √(k m)). Before there is
// a profile a light striker sends a bending wave: a beam moved suddenly at V carries M = V √(μ EI)
// beside it, constant in time. Both together, next to the contact:
//
//   n = max [ |M̂|/τ + V √(μ EI) φ ] / M_p,   φ = 1 next to the contact, else 0
//
//   n <= 1   it stays whole: a blow that it bears
//   n > 1    it yields, as a rigid-plastic member would, and of what this absorbs the share
//            1 - 1/N² is flow; E/N² is left in vibration:
//
//   N² = max [ n², (max |M̂|/(τ M_p))² + (V √(μ EI)/M_p)² ]
//
// N grows with the speed, so 1/N² is the part below the speed at which N = 1; what a light striker
// sends out as a wave and what it bends come one after the other, at places of their own.
//
// Limits: EI → ∞: n → ∞, every blow yields it and all of E flows (Parkes); E → 0: n → 0. Against a
// chain of elastic-plastic joints: bullet_member_physics_test.cpp.
//
// Sources: the wave: Laplace transform of the Euler-Bernoulli beam, w = V/s² e^{-ax}(cos ax + sin
// ax), a⁴ = μ s²/(4 EI); the quasi-static profile as in Stronge and Yu (1993), Dynamic Models for
// Structural Plasticity, ch. 7; the share is derived here.
//
// Symbols
//   E, V   energy that the contact takes, closing speed of the struck place [J], [m/s]
//   M̂      impulse of the moment                                           [N m s]
//   EI, μ  bending stiffness, mass per length                              [N m²], [kg/m]
//   n, N   utilisation by the blow, where it first yields and in all       [-]
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "ductile/member/active_sections.hpp"

namespace ductile {

struct MemberBlow {
    double energy = 0;          ///< E [J]
    double speed = 0;           ///< V [m/s]; 0: no wave
    int segment = 0;            ///< struck
    double impulse_energy = 0;  ///< ∫ M̂²/(2 EI) ds [J s²]
    double peak_per_moment = 0; ///< 1/τ [1/s]
    double utilisation = 0;     ///< n
    double in_all = 0;          ///< N >= n

    [[nodiscard]] bool yields() const noexcept { return utilisation > 1; }
};

/// `forces` are those of the blow in a whole member, `energy` what its contacts took [J]; `speed`:
/// of what strikes, against the struck `segment` [m/s].
[[nodiscard]] inline MemberBlow member_blow(const Member& member, const MemberState& state,
                                            const InternalForces& forces, double energy,
                                            double speed, int segment) {
    MemberBlow blow{.energy = energy, .speed = speed, .segment = segment};
    const double stiffness = member.bending_stiffness();
    if (stiffness == std::numeric_limits<double>::infinity()) {
        for (const SectionForce& carried : forces.sections) {
            if (carried.bending != 0) blow.utilisation = blow.in_all = stiffness;
        }
        return blow;
    }
    // linear between sections, no moment at an end that is free
    double beyond = 0;
    for (const SectionForce& carried : forces.sections) {
        const double length = member.segment(carried.section + 1).length, m = carried.bending;
        blow.impulse_energy += length * (m * m + m * beyond + beyond * beyond) / (6 * stiffness);
        beyond = m;
    }
    if (forces.sections.empty()) return blow;
    const double first = member.segment(forces.sections.back().section).length;
    blow.impulse_energy += first * beyond * beyond / (6 * stiffness);
    if (!(blow.impulse_energy > 0)) return blow;
    blow.peak_per_moment = std::sqrt(std::max(energy, 0.0) / blow.impulse_energy);
    const double wave =
        speed * std::sqrt(member.mass_per_length() * member.bending_stiffness()); // next to it
    double profile = 0, sent = 0;
    for (const SectionForce& carried : forces.sections) {
        const auto used_by = [&](double moment) { // as for a step of one second
            SectionForce peak = carried;
            peak.bending = std::copysign(moment, carried.bending);
            return utilisation_of(member, state, peak, 1);
        };
        const double bent = std::abs(carried.bending) * blow.peak_per_moment;
        const bool beside = carried.section == segment || carried.section == segment - 1;
        blow.utilisation = std::max(blow.utilisation, used_by(beside ? bent + wave : bent));
        profile = std::max(profile, used_by(bent));
        if (beside) sent = std::max(sent, used_by(wave));
    }
    blow.in_all = std::max(blow.utilisation, std::hypot(profile, sent));
    return blow;
}

} // namespace ductile
