// SPDX-License-Identifier: MIT
//
// In how many rigid segments a cantilever is to be cut that is struck at its tip, and how finely it
// is to be stepped.
//
// The continuum (Parkes 1955): a plastic hinge travels from the tip to the root and stays there.
// Outboard of it the beam turns as a rigid bar; inboard it is at rest and M = M_p all along, so the
// shear is zero and the momentum G V₀ stays what it is:
//
//   V(x) = V₀/(1 + β x/L),   μ V x²/6 = M_p t,   then rotation about the root alone
//   d = (G V₀² L/2M_p) (1/3β) [β/(1 + β) + 2 ln(1 + β)]
//
// A chain of N ≥ 2 equal rigid segments, a hinge at the root and between them, does the same
// exactly if each segment's mass sits at its two ends, half and half: a body of the segment's mass
// with inertia m s²/4 about its middle. Then loads act at the joints only, the moment is linear
// between them, and no section is beyond M_p while its joint is not. While the hinge "travels"
// between the joints j - 1 and j from the tip, both turn; at the instant t_j all outboard of joint
// j turns as one. The sums that replace the integrals are trapezoidal,
//
//   Σ μ s (1 - d/x) over the nodes = μ x/2                  exact: V_j = V(x_j), x_j = j L/N
//   Σ μ s d (1 - d/x)              = μ x²/6 (1 - 1/j²):      μ V_j x_j²/6 (1 - 1/j²) = M_p t_j
//   d_N = Σ_{j=1}^{N-1} (V_j + V_{j+1})/2 (t_{j+1} - t_j) + V_N² (G + μL/3 (1 + 1/(2N²))) L/(2 M_p)
//
// so the error falls as 1/N². Segments as uniform rods (inertia m s²/12) carry a moment between
// their ends that no joint sees: at β = 1 they are off by 7 % with 5 segments and by 5 % with 20,
// where these are off by 1.5 % and 0.1 %. One segment alone keeps its own inertia, that of a rod:
// there is no joint in it, and it turns about the root with V₀/(1 + 2β/3).
//
// With 1/4 exactly every joint inboard carries just M_p and does not turn: whether such a row slips
// or holds is a tie, which direct solvers lose now and then (and the certificate reports). A little
// more inertia, 0.251 m s², leaves those joints just below M_p and d_N where it is (0.05 %).
//
// The step. The chain starts with its tip at V_1 and, as any engine that moves with the velocity at
// the end of a step, stops short by V_1 dt/2.
//
// Limits: N → ∞ is Parkes; β → 0 one segment is enough; t_f = G V₀ L/M_p for every N (moment of
// momentum about the root).
//
// Source: Parkes, Proc. R. Soc. A 228 (1955) 462; chain derived here.
//
// Symbols
//   L, μ, M_p  length [m], mass per length [kg/m], plastic moment [N m]
//   G, V₀      mass at the tip [kg] and its speed after the blow, free of the beam [m/s]
//   β          μ L/(2 G) [-];   d: deflection of the tip [m];   s = L/N [m]
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <string>

#include "ductile/fidelity/joint_detail.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile {

template <std::floating_point S>
struct StruckCantilever {
    S length = std::numeric_limits<S>::quiet_NaN();          ///< L [m], > 0
    S mass_per_length = std::numeric_limits<S>::quiet_NaN(); ///< μ [kg/m], > 0
    S plastic_moment = std::numeric_limits<S>::quiet_NaN();  ///< M_p [N m], > 0
    S tip_mass = std::numeric_limits<S>::quiet_NaN();        ///< G [kg], > 0
    S speed = std::numeric_limits<S>::quiet_NaN();           ///< V₀ [m/s], > 0

    /// β [-].
    [[nodiscard]] S mass_ratio() const noexcept {
        return mass_per_length * length / (2 * tip_mass);
    }
};

/// @throws std::invalid_argument where a number is missing or out of range.
template <std::floating_point S>
void check_cantilever(const StruckCantilever<S>& c) {
    check::positive("StruckCantilever.length", c.length, "m");
    check::positive("StruckCantilever.mass_per_length", c.mass_per_length, "kg/m");
    check::positive("StruckCantilever.plastic_moment", c.plastic_moment, "N m");
    check::positive("StruckCantilever.tip_mass", c.tip_mass, "kg");
    check::positive("StruckCantilever.speed", c.speed, "m/s");
}

/// Inertia of a segment of the chain about its middle [kg m²]: half its mass at either end and a
/// little more, or that of a rod where it is the only one.
template <std::floating_point S>
[[nodiscard]] constexpr S segment_inertia(S mass, S length, int segments) noexcept {
    return mass * length * length * (segments > 1 ? S(0.251) : S(1) / 12);
}

/// d of the continuum [m].
template <std::floating_point S>
[[nodiscard]] S continuum_deflection(const StruckCantilever<S>& c) noexcept {
    const S beta = c.mass_ratio();
    const S whole = c.tip_mass * c.speed * c.speed * c.length / (2 * c.plastic_moment);
    return whole * (beta / (1 + beta) + 2 * std::log1p(beta)) / (3 * beta);
}

/// V_1: speed of the chain's tip after the blow [m/s].
template <std::floating_point S>
[[nodiscard]] S chain_start_speed(const StruckCantilever<S>& c, int segments) noexcept {
    const S beta = c.mass_ratio();
    return c.speed / (1 + (segments > 1 ? beta / S(segments) : 2 * beta / 3));
}

/// d_N of a chain of `segments` >= 1 [m]. O(segments).
template <std::floating_point S>
[[nodiscard]] S chain_deflection(const StruckCantilever<S>& c, int segments) noexcept {
    const S n = S(segments), rod = c.mass_per_length * c.length / 3;
    const auto about_root = [&](S speed, S mass) {
        return speed * speed * mass * c.length / (2 * c.plastic_moment);
    };
    if (segments == 1) return about_root(chain_start_speed(c, 1), c.tip_mass + rod);
    const auto speed = [&](S j) { return c.speed / (1 + c.mass_ratio() * j / n); };
    const auto time = [&](S j) {
        const S x = j * c.length / n;
        return c.mass_per_length * speed(j) * x * x / (6 * c.plastic_moment) * (1 - 1 / (j * j));
    };
    S sum = 0;
    for (int i = 1; i < segments; ++i) {
        const S j = S(i);
        sum += (speed(j) + speed(j + 1)) / 2 * (time(j + 1) - time(j));
    }
    return sum + about_root(speed(n), c.tip_mass + rod * (1 + 1 / (2 * n * n)));
}

template <std::floating_point S>
struct SegmentParameters {
    S tolerance = S(0.05);        ///< of the tip's deflection [-], in (0, 1)
    S reserve = S(0.05);          ///< share of it that is not used [-], in [0, 1)
    S longest_step = S(1.0 / 60); ///< [s], > 0
    /// What a step costs grows with this power of the number of joints [-], >= 0: 1 for an
    /// iterative solver; a direct one on the six rows each of 1 to 10 joints comes to 1.3.
    S cost_power = S(1.3);
    int most = 100; ///< segments, >= 1
};

template <std::floating_point S>
struct SegmentChoice {
    int segments = 0;                             ///< 0: none within the tolerance
    S dt = 0;                                     ///< [s]
    S error = std::numeric_limits<S>::infinity(); ///< of segments and step together [-]
    std::string reason;
};

/// The cheapest number of segments and step within the tolerance: of all N the one for which
/// N^cost_power/dt is least, dt using up what the segments leave of the tolerance.
/// @throws std::invalid_argument where a number is missing or out of range.
template <std::floating_point S>
[[nodiscard]] SegmentChoice<S> choose_segments(const StruckCantilever<S>& c,
                                               const SegmentParameters<S>& p = {}) {
    check_cantilever(c);
    check::between("Segments.tolerance", p.tolerance, S(0), S(1), "");
    if (p.reserve != S(0)) check::between("Segments.reserve", p.reserve, S(0), S(1), "");
    check::positive("Segments.longest_step", p.longest_step, "s");
    check::non_negative("Segments.cost_power", p.cost_power, "");
    if (p.most < 1) check::fail("Segments.most", S(p.most), "", ">= 1");
    const S exact = continuum_deflection(c), target = p.tolerance * (1 - p.reserve);
    SegmentChoice<S> best;
    S least = std::numeric_limits<S>::infinity(), cut = 0;
    for (int n = 1; n <= p.most; ++n) {
        const S error = 1 - chain_deflection(c, n) / exact; // all of them are short
        const S per_step = chain_start_speed(c, n) / (2 * exact);
        if (!(error < target)) continue;
        const S dt = std::min((target - error) / per_step, p.longest_step);
        const S cost = std::pow(S(n), p.cost_power) / dt;
        if (!(cost < least)) continue;
        least = cost;
        cut = error;
        best.segments = n;
        best.dt = dt;
        best.error = error + per_step * dt;
    }
    using namespace detail_choice;
    best.reason = best.segments == 0
                      ? "no number up to " + std::to_string(p.most) + " leaves an error of " +
                            percent(target) + " or less"
                      : std::to_string(best.segments) + " segments are off by " + percent(cut) +
                            ", steps of " + number(best.dt) + " s by " + percent(best.error - cut);
    return best;
}

} // namespace ductile
