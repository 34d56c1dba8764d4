// SPDX-License-Identifier: MIT
//
// Whether a blow yields a member, and how much of its energy goes into flow. A rigid member takes a
// blow's impulses at once, and its sections moments without bound: told from those every blow
// yields, however weak. An elastic one takes up the energy E that the rigid contact annihilates as
// strain energy of the very profile M̂(s) of moments,
//
//   E = M_1² A,   A = ∫ (M̂/M̂_1)²/(2 EI) ds,   so   M(s) = M̂(s)/τ,   1/τ = √(E / ∫ M̂²/(2 EI) ds)
//
// (a cantilever under a heavy striker: the bound of mass and spring, F = v √(k m)), and in shear,
// Q̂²/(2 κGA), where the member knows its section in all axes. Before there is a profile a striker
// sends a bending wave: a beam moved suddenly at V carries M = V √(μ EI) beside it, constant in
// time. Where it moves no more of the member than the section is wide, shear and the turning of
// the sections let that pass. With p = |M̂|/(τ M_p), w = c V √(μ EI)/M_p:
//
//   n = max [ p, f (p + w) next to the contact ]
//   N² = max [ n^(4/3), n^(7/4) where nothing holds it, (f max (p + w))^(11/10),
//              (max p)² + w², (max p)² (1 + 2 R/((1 + R) c_p)) ]
//   f = l/(l + 2.3 ρ),   l = 2 E/(μ V²) by each side
//
//   n <= 1   it stays whole: a blow that it bears
//   n > 1    it yields, as a rigid-plastic member would, and of what this absorbs the share
//            1 - 1/N² is flow; E/N² is left in vibration
//
// N grows with the speed, so 1/N² is the part below the speed at which N = 1. R is the share of E
// that does not go into the profile's shape (Rayleigh),
//
//   R = m_w/(m_w + 2 E/V²),   m_w = ∫ μ (w/w_c)² ds,   w_c = A M_1² V/E of w (the force's work)
//
// with w(s) the deflection under the profile, w_c where it is struck: an overhang that a striker
// has to carry with it, or a span beside a support that it strikes, makes m_w many times the
// member's mass. What is held more than once stores more than its profile at first yield, as
// moments are shared anew, at most that of M_p at the struck section and at the supports beside it,
// a length l_s apart:
//
//   c_p = U_c/U_y = M̂_1² l_s/(6 EI A),   U_c = M_p² l_s/(6 EI);   1 where it is held on one side
//
// A striker that pushes is thrown back by that; one that sticks swings with the member until
// moments are shared so that it stores U_y. So of what pushes N²/min (c_p, N^1.2) counts in place
// of N².
//
// A light striker, w > 2/3 c max p, yields it wherever both together come to a section, as the wave
// goes through all of it and is turned back at its ends:
//
//   n = f max (p + w),   N² = max [ n^(4/3), f² ((max p)² + w²) ]
//
// c = 0.487 at an end that is free, where nothing holds the other one, of one side, else 1. Fitted
// to Timoshenko's beam with plastic sections, its striker sticking and pushing, 0.03 to 30 times
// the member, wherever it strikes and however that is held: blow_test.cpp. What it may be off by is
// told as `astray`, from a band of
//
//   N² (1 - 0.7 R) to 1.06 N²,   of a free one that is pushed at one place from (1 - 8 U_s/U) of it
//   on, of a free one that is struck e of its length off its middle from (1 - 0.9 √e) of it, of a
//   clamped one that is struck a from there, with b > a behind it, from a/b of it
//
// as halves of a free one that are not alike, and what hangs over by more than what bends, go on
// swinging by themselves.
//
// The exponents of n and N² keep to a chain of joints where a cantilever is struck at its end,
// which is to bear E up to that of its profile (P39).
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
//   Q̂, κGA impulse of the shear force, shear stiffness                       [N s], [N]
//   n, N   utilisation by the blow, where it first yields and in all       [-]
//   ρ, l   radius of gyration of its section, length as heavy as the striker [m], [m]
//   U_y, U_c  strain energy at first yield, at collapse                    [J]
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "ductile/member/redundant_forces.hpp"

namespace ductile {

namespace detail {

/// 1 - 1/N², if that is more than nothing.
[[nodiscard]] inline double flow(double n) noexcept { return n > 1 ? 1 - 1 / (n * n) : 0; }

/// How the wave of a blow of `energy` [J] at `speed` [m/s] on a `segment` of a member spreads.
struct Wave {
    double turned_back = 1; ///< c
    double kept = 1;        ///< f
    double taken = 0;       ///< of the energy: what the contact took as the segment is rigid

    Wave(const Member& member, double energy, double speed, int segment) {
        constexpr double near_end = 0.125, at_end = 0.487, shear = 2.3;
        const MemberSegment& struck = member.segment(segment);
        const double middle = member.place(segment) - struck.length / 2, length = member.length(),
                     end = near_end * length;
        const bool one_side = middle > length - end || (middle < end && !member.clamped());
        if (one_side && !member.clamped()) turned_back = at_end;
        if (!(speed > 0)) return;
        const double per_length = member.mass_per_length(),
                     reach = 2 * energy / (per_length * speed * speed) / (one_side ? 1 : 2),
                     gyration = std::sqrt(struck.inertia[2] / (2 * struck.mass)); // about either
        kept = reach / (reach + shear * gyration);
        taken = struck.length / (struck.length + 2 * reach);
    }
};

/// ∫ μ w² ds [kg m² by 1/(EI)²], w being the deflection of what is clamped, else less the rigid
/// motion next to it that supports allow.
[[nodiscard]] inline double mass_of_shape(const Member& member, const InternalForces& forces,
                                          std::span<const MemberSupport> supports) {
    constexpr double held = 1e6;            // of its mass: does not move
    const auto& sections = forces.sections; // from the last to the first
    const int first = sections.back().section, last = sections.front().section + 1;
    double m = 0, mx = 0, mxx = 0, mw = 0, mxw = 0, mww = 0; // sums
    const auto add = [&](double mass, double x, double w) {
        m += mass;
        mx += mass * x;
        mxx += mass * x * x;
        mw += mass * w;
        mxw += mass * x * w;
        mww += mass * w * w;
    };
    double x = 0, w = 0, slope = 0, before = 0;
    for (int k = first; k <= last; ++k) {
        const MemberSegment& of = member.segment(k);
        const double s = of.length,
                     behind = k < last ? sections[std::size_t(last - 1 - k)].bending : 0,
                     to = w + s * (slope + s * (2 * before + behind) / 6);
        add(of.mass, x + s / 2, (w + to) / 2);
        for (const MemberSupport& support : supports) {
            const double along = s / 2 + support.at[2];
            if (support.segment == k && support.bears[0]) {
                add(held * member.mass(), x + along, w + (to - w) * along / s);
            }
        }
        slope += s * (before + behind) / 2;
        before = behind;
        w = to;
        x += s;
    }
    if (member.segment(first).held) return mww;
    const double b = (m * mxw - mx * mw) / (m * mxx - mx * mx), a = (mw - b * mx) / m;
    return mww - a * mw - b * mxw; // of the motion a + b x
}

/// U_c/U_y, >= 1; `per_impulse`: ∫ M̂²/(2 EI) + Q̂²/(2 κGA) ds [J s²].
[[nodiscard]] inline double stored_at_collapse(const Member& member, const InternalForces& forces,
                                               int segment, std::span<const MemberSupport> supports,
                                               double per_impulse) {
    const double at = member.place(segment) - member.segment(segment).length / 2;
    const bool clamped = member.segment(forces.sections.back().section).held;
    double before = clamped ? at : 0, behind = 0, most = 0; // 0: nothing there
    for (const MemberSupport& support : supports) {
        if (!support.bears[0]) continue;
        const MemberSegment& of = member.segment(support.segment);
        const double ahead = member.place(support.segment) - of.length / 2 + support.at[2] - at;
        double& next = ahead > 0 ? behind : before;
        if (next == 0 || std::abs(ahead) < next) next = std::abs(ahead);
    }
    for (const SectionForce& carried : forces.sections) {
        most = std::max(most, std::abs(carried.bending));
    }
    if (before == 0 || behind == 0) return 1;
    return std::max(
        1.0, most * most * (before + behind) / (6 * member.bending_stiffness() * per_impulse));
}

/// Of N², from which the band of a member begins that is clamped at one end or not held at all.
[[nodiscard]] inline double least_of_one_sided(const Member& member, int segment) {
    const double half = member.segment(segment).length / 2, middle = member.place(segment) - half,
                 before = middle + half, behind = member.length() - middle - half;
    if (member.clamped()) return behind > before ? before / behind : 1;
    const double off = std::abs(middle - member.length() / 2) - half;
    return off > 0 ? 1 - 0.9 * std::sqrt(off / member.length()) : 1;
}

} // namespace detail

enum class Striker {
    sticks,
    pushes,
    pushes_alone ///< nothing else touches it
};

struct MemberBlow {
    double energy = 0;          ///< E [J]
    double speed = 0;           ///< V [m/s]; 0: no wave
    int segment = 0;            ///< struck
    double impulse_energy = 0;  ///< ∫ M̂²/(2 EI) + Q̂²/(2 κGA) ds [J s²]
    double peak_per_moment = 0; ///< 1/τ [1/s]
    double utilisation = 0;     ///< n
    double in_all = 0;          ///< N
    double astray = 0;          ///< of E, that may have flowed or not [J]
    bool light = false;         ///< the striker
    double taken = 0;           ///< of E, by the contact as the segment is rigid [J]

    [[nodiscard]] bool yields() const noexcept { return utilisation > 1; }
    /// Of E.
    [[nodiscard]] double flows() const noexcept { return yields() ? detail::flow(in_all) : 0; }
    [[nodiscard]] bool is_rough() const noexcept {
        constexpr double roughly = 0.12;
        return astray > roughly * energy || (yields() && taken > (light ? 0.05 : roughly) * energy);
    }
};

/// `forces` are those of the blow in a whole member that `supports` hold, `energy` what its
/// contacts took [J]; `speed`: of what strikes, against the struck `segment` [m/s].
[[nodiscard]] inline MemberBlow member_blow(const Member& member, const MemberState& state,
                                            const InternalForces& forces, double energy,
                                            double speed, int segment,
                                            std::span<const MemberSupport> supports = {},
                                            Striker striker = Striker::sticks) {
    MemberBlow blow{.energy = energy, .speed = speed, .segment = segment};
    const double stiffness = member.bending_stiffness();
    if (stiffness == std::numeric_limits<double>::infinity()) {
        for (const SectionForce& carried : forces.sections) {
            if (carried.bending != 0) blow.utilisation = blow.in_all = stiffness;
        }
        return blow;
    }
    if (forces.sections.empty()) return blow;
    // linear between sections, no moment at an end that is free
    const double shear = member.all_axes() ? 1 / member.all_axes()->stiffness[1] : 0;
    double beyond = 0, sheared = 0;
    for (const SectionForce& carried : forces.sections) {
        const double length = member.segment(carried.section + 1).length, m = carried.bending;
        blow.impulse_energy += length * (m * m + m * beyond + beyond * beyond) / (6 * stiffness);
        const bool at_end = &carried == &forces.sections.front();
        if (!at_end) sheared += shear * (m - beyond) * (m - beyond) / (2 * length);
        beyond = m;
    }
    const double first = member.segment(forces.sections.back().section).length;
    blow.impulse_energy += first * beyond * beyond / (6 * stiffness) + sheared;
    if (!(blow.impulse_energy > 0)) return blow;
    blow.peak_per_moment = std::sqrt(std::max(energy, 0.0) / blow.impulse_energy);
    const double wave = speed * std::sqrt(member.mass_per_length() * stiffness);
    const detail::Wave sent_out(member, energy, speed, segment);
    double profile = 0, near = 0, all = 0, both = 0;
    for (const SectionForce& carried : forces.sections) {
        const auto used_by = [&](double moment) { // as for a step of one second
            SectionForce peak = carried;
            peak.bending = std::copysign(moment, carried.bending);
            return utilisation_of(member, state, peak, 1);
        };
        const double bent = std::abs(carried.bending) * blow.peak_per_moment,
                     with_wave = used_by(bent + sent_out.turned_back * wave);
        const bool next = carried.section == segment || carried.section == segment - 1;
        profile = std::max(profile, used_by(bent));
        if (next) near = std::max(near, with_wave);
        all = std::max(all, used_by(sent_out.turned_back * wave));
        both = std::max(both, with_wave);
    }
    const double f = sent_out.kept;
    double in_shape = 0; // R
    if (speed > 0 && energy > 0 && segment >= forces.sections.back().section &&
        segment <= forces.sections.front().section + 1) {
        // w_c by the work of the blow's force (Clapeyron)
        const double there = blow.impulse_energy * stiffness * speed / energy,
                     shape = detail::mass_of_shape(member, forces, supports) / (there * there);
        in_shape = shape / (shape + 2 * energy / (speed * speed));
    }
    const bool held = member.clamped() || !supports.empty();
    blow.light = 3 * all > 2 * sent_out.turned_back * profile;
    double least = 1; // of N²
    if (blow.light) {
        blow.utilisation = f * both;
        blow.in_all = std::max(std::pow(f * both, 2.0 / 3), f * std::hypot(profile, all));
    } else {
        const double collapse =
            detail::stored_at_collapse(member, forces, segment, supports, blow.impulse_energy);
        blow.utilisation = std::max(profile, f * near);
        blow.in_all =
            std::max({std::pow(blow.utilisation, held ? 2.0 / 3 : 7.0 / 8),
                      std::pow(f * both, 0.55), std::hypot(profile, all),
                      profile * std::sqrt(1 + 2 * in_shape / ((1 + in_shape) * collapse))});
        if (striker != Striker::sticks && blow.in_all > 1) {
            blow.in_all /= std::min(std::sqrt(collapse), std::pow(blow.in_all, 0.6));
        }
        if (supports.empty()) least = detail::least_of_one_sided(member, segment);
        if (striker == Striker::pushes_alone && !held) {
            least = std::clamp(1 - 8 * sheared / blow.impulse_energy, 0.0, least);
        }
    }
    if (in_shape > 0) {
        least *= 1 - 0.7 * in_shape;
        const double of_most = detail::flow(blow.in_all * std::sqrt(1.06)),
                     of_least = detail::flow(blow.in_all * std::sqrt(least));
        blow.astray = energy * std::max(of_most - blow.flows(), blow.flows() - of_least);
    }
    if (speed > 0) blow.taken = energy * sent_out.taken;
    return blow;
}

} // namespace ductile
