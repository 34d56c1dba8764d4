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
// A light striker, whose wave carries more than 2/3 of the profile, yields it where both together
// come to a section, as the wave goes through all of it and is turned back at its ends; what they
// leave is less than the squares say, and where it moves no more of the member than the section is
// wide, shear and the turning of the sections let it pass:
//
//   n = f max [ |M̂|/τ + c V √(μ EI) ] / M_p,   f = l/(l + 2.3 ρ),   l = 2 E/(μ V²) by each side
//   N² = max [ n^(4/3), f² ((max |M̂|/(τ M_p))² + (c V √(μ EI)/M_p)²) ]
//
// c = 0.487 at an end that is free, where nothing holds the other one, of one side, else 1. Fitted
// to Timoshenko's beam with plastic sections, the striker 0.03 to 20 times the member, wherever it
// strikes and however that is held: within 0.04 of E in the mean, 0.2 where it just yields. What
// it may be off by is told as `astray`.
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
//   ρ, l   radius of gyration of its section, length as heavy as the striker [m], [m]
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
    double in_all = 0;          ///< N; >= n where that is > 1
    double astray = 0;          ///< of E, that may have flowed or not [J]

    [[nodiscard]] bool yields() const noexcept { return utilisation > 1; }
    [[nodiscard]] bool is_rough() const noexcept {
        constexpr double noticed = 0.05;
        return astray > noticed * energy;
    }
};

namespace detail {

/// How the wave of a blow of `energy` [J] at `speed` [m/s] on a `segment` of a member spreads.
struct Wave {
    double turned_back = 1; ///< c
    double kept = 0;        ///< f
    double taken = 0;       ///< of the energy: what the contact took as the segment is rigid

    Wave(const Member& member, double energy, double speed, int segment) {
        constexpr double near_end = 0.125, at_end = 0.487, shear = 2.3;
        const MemberSegment& struck = member.segment(segment);
        const double middle = member.place(segment) - struck.length / 2, length = member.length(),
                     end = near_end * length;
        const bool one_side = middle > length - end || (middle < end && !member.clamped());
        if (one_side && !member.clamped()) turned_back = at_end;
        if (!(energy > 0 && speed > 0)) return;
        const double per_length = member.mass_per_length(),
                     reach = 2 * energy / (per_length * speed * speed) / (one_side ? 1 : 2),
                     gyration = std::sqrt(struck.inertia[2] / (2 * struck.mass)); // about either
        kept = reach / (reach + shear * gyration);
        taken = struck.length / (struck.length + 2 * reach);
    }
};

} // namespace detail

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
    const double wave = speed * std::sqrt(member.mass_per_length() * stiffness);
    const detail::Wave sent_out(member, energy, speed, segment);
    double profile = 0, beside = 0, all = 0, both = 0;
    for (const SectionForce& carried : forces.sections) {
        const auto used_by = [&](double moment) { // as for a step of one second
            SectionForce peak = carried;
            peak.bending = std::copysign(moment, carried.bending);
            return utilisation_of(member, state, peak, 1);
        };
        const double bent = std::abs(carried.bending) * blow.peak_per_moment;
        const bool next = carried.section == segment || carried.section == segment - 1;
        blow.utilisation = std::max(blow.utilisation, used_by(next ? bent + wave : bent));
        profile = std::max(profile, used_by(bent));
        if (next) beside = std::max(beside, used_by(wave));
        all = std::max(all, used_by(wave));
        both = std::max(both, used_by(bent + sent_out.turned_back * wave));
    }
    blow.in_all = std::max(blow.utilisation, std::hypot(profile, beside));
    if (3 * all > 2 * profile) {
        constexpr double off = 0.2;
        const double n = sent_out.kept * both,
                     squares = sent_out.kept * std::hypot(profile, sent_out.turned_back * all);
        blow.utilisation = n;
        blow.in_all = std::max(std::pow(n, 2.0 / 3), squares);
        const double share = off / (blow.in_all * blow.in_all) + sent_out.taken;
        if (blow.yields()) blow.astray = energy * share;
    }
    return blow;
}

} // namespace ductile
