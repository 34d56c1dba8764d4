// SPDX-License-Identifier: MIT
//
// A spring as a row: the force -k (q_e + θ u' dt), with θ chosen so that the row is as accurate as
// the step allows and never unstable.
//
// Symbols
//   k    stiffness                          [N/m | N m/rad]
//   q_e  elastic displacement at the start  [m | rad]
//   m    mass the row feels                 [kg | kg m²]
//   a    k dt²/m = (ω dt)²                  [-]
//
//   λ = -k dt (q_e + θ dt u')   <=>   u' + C λ = b,   C = 1/(θ k dt²),  b = -q_e/(θ dt)
//
// θ = 0 is the symplectic force, which keeps energy and is second order in the peak, stable for a <
// 4; the row then has a given force, lower = upper. θ = 1 is the implicit one, first order, damped,
// and stable for every a. For the free oscillator the characteristic equation
//   z² - z (1 + 1/(1+θa) - a/(1+θa)) + 1/(1+θa) = 0
// has |z| <= 1 where 4 + (2θ - 1) a >= 0. The choice
//   θ(a) = 0 for a <= 1/4 (at least 12 steps per period),  1 for a >= 4,  linear in between
// satisfies it and is continuous, so that a change of step or mass makes no jump. Limit cases: a →
// 0 keeps energy; a → ∞ tends to the rigid row that returns to q_e = 0 in one step.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>

#include "ductile/law/cyclic.hpp"
#include "ductile/law/root.hpp"
#include "ductile/vocabulary/damper_share.hpp"
#include "ductile/vocabulary/row.hpp"

namespace ductile {

/// θ for a = k dt²/m; 1 where the mass is not known (0).
template <std::floating_point S>
[[nodiscard]] constexpr S implicit_share(S stiffness, S mass, S dt) noexcept {
    if (!(mass > 0)) return 1;
    constexpr S resolved = S(0.25), stiff = 4;
    const S a = stiffness * dt * dt / mass;
    return std::clamp((a - resolved) / (stiff - resolved), S(0), S(1));
}

/// Stiffness of a rigid axis in that of the section that it stands for: by it the joints of a
/// redundant structure share their forces as their sections do, and hold them without creep [-].
template <std::floating_point S>
inline constexpr S rigid_stiffness = S(1e6);

/// The row of a rigid axis that is off by `elastic` [m | rad], removed within `drift_time` [s], or
/// within five steps where that is longer: that is the τ of a damper beside the spring
/// `stiffness` [N/m | N m/rad], infinite where no section is known. With that spring it gives no
/// more in a blow than in a short part, and holds what it held.
template <std::floating_point S>
[[nodiscard]] constexpr RowLimits<S> rigid_row(S elastic, S lower, S upper, S drift_time, S dt,
                                               S stiffness) noexcept {
    constexpr S short_part = S(1e-4), infinity = std::numeric_limits<S>::infinity(); // [s]
    const bool sprung = stiffness < infinity && dt < short_part;
    const S time = sprung ? drift_time * short_part / dt : std::max(drift_time, 5 * dt);
    return {.lower = lower,
            .upper = upper,
            .bias = -elastic / time,
            .softness = 1 / (stiffness * time * dt)};
}

/// Softness of an elastic row, of what it gives itself: far below what its section strains [-].
template <std::floating_point S>
inline constexpr S elastic_softness = S(1e-6);

/// Share of its end in the mean force of a spring whose bodies are half a step ahead [-].
template <std::floating_point S>
inline constexpr S mean_share = S(0.25);

/// A spring and a damper of k τ beside it, in a step in which Δ of it flows,
///
///   f = -k (q + g u' - c Δ)   <=>   C = 1/(g k dt),  b = -q/g
///
///   as it is          q = q_e,           g = θ dt + τ,    c = 1 + τ/dt
///   half a step ahead q = (q_e + q_m)/2 + (1 - θ) τ u, g = dt/4 + θ τ, c = 1/2 + τ/dt
///
/// q_m is q_e in the middle of the step: its force is then the mean of those at the start and the
/// end, whose work is exactly what it stores, at any step and stiffness. The damper's is that of
/// its mean speed, θ = 1/2, of second order as the spring's, and c/g = 2/dt whatever τ: rows that
/// are damped otherwise flow along the normal of their surface all the same. Where it takes more
/// than its speed within the step θ is more (damper_share.hpp); k → ∞ then keeps the share
/// 1/(1 + 4 τ/dt) of what vibrates in a step. g = 0: the force is given.
template <std::floating_point S>
struct SpringRow {
    S stiffness; ///< k [N/m | N m/rad]
    S damping;   ///< τ [s], >= 0
    S start;     ///< q_e [m | rad]
    S reach;     ///< q [m | rad]
    S lead;      ///< g [s]
    S give;      ///< c [-]
    S later = 1; ///< θ of the damper [-]
    S rate = 0;  ///< (1 - θ) u [m/s | rad/s]

    [[nodiscard]] static constexpr SpringRow now(S stiffness, S damping, S elastic, S implicit,
                                                 S dt) noexcept {
        return {stiffness, damping, elastic, elastic, implicit * dt + damping, 1 + damping / dt};
    }
    /// @param mass, velocity  that the row feels [kg | kg m²], and u that it begins with
    [[nodiscard]] static constexpr SpringRow half_ahead(S stiffness, S damping, S elastic, S middle,
                                                        S mass, S velocity, S dt) noexcept {
        const S later = damper_share(stiffness * damping * dt, mass), rate = (1 - later) * velocity;
        return {stiffness,
                damping,
                elastic,
                (elastic + middle) / 2 + damping * rate,
                mean_share<S> * dt + later * damping,
                S(0.5) + damping / dt,
                later,
                rate};
    }
    /// Its force stays within [lower, upper] [N | N m].
    [[nodiscard]] constexpr RowLimits<S> limits(S lower, S upper, S dt) const noexcept {
        if (!(lead > 0)) {
            const S given = std::clamp(-stiffness * reach, lower, upper);
            return {.lower = given, .upper = given};
        }
        return {.lower = lower,
                .upper = upper,
                .bias = -reach / lead,
                .compliance = 1 / (lead * stiffness * dt),
                // in a blow a damper gives far less than its section
                .softness = elastic_softness<S> / (stiffness * dt * std::max(lead, dt))};
    }
    /// Δ of a row that ended at `velocity` with `force`.
    [[nodiscard]] constexpr S flow(S force, S velocity) const noexcept {
        return (reach + lead * velocity + force / stiffness) / give;
    }
    /// What the damper took, the row having flowed by `flow` and being strained by `end` now [J].
    [[nodiscard]] constexpr S damped(S velocity, S flow, S end, S dt) const noexcept {
        return stiffness * damping * (later * velocity + rate - flow / dt) * (end - start);
    }
};

/// Share of a flow's account that its work gives, the geometry giving the rest, for a law whose
/// range moves: θ where the slip is within `range`, half of that between the two yield points, and
/// 1 far beyond it, where a row with θ > 0 acts with the strength of its midpoint [-].
template <std::floating_point S>
[[nodiscard]] constexpr S work_share(S implicit, S range, S slipped) noexcept {
    if (!(implicit > 0)) return 0;
    return 1 - (1 - implicit) * std::min(S(1), range / std::abs(slipped));
}

/// Flow that brings a spring's force back to the law's, k (trial - slip) = fade × resistance(slip),
/// signed; zero inside the elastic range [m | rad]. `trial` is q_e as if nothing had flowed, `fade`
/// what the law's strength is multiplied by. A few Newton steps; one where the law is linear.
template <CyclicLaw Law>
[[nodiscard]] typename Law::Scalar spring_slip(const Law& law, const typename Law::State& state,
                                               typename Law::Scalar stiffness,
                                               typename Law::Scalar fade,
                                               typename Law::Scalar trial) noexcept {
    using S = typename Law::Scalar;
    for (const S direction : {S(1), S(-1)}) {
        const auto beyond = [&](S travel) noexcept {
            const S held = law.resistance(state, travel, direction) * fade;
            return direction * (stiffness * (trial - direction * travel) - held);
        };
        if (!(beyond(0) > 0)) continue;
        const S first = beyond(0) / stiffness; // enough unless the law softens
        const S most = beyond(first) <= 0 ? first : std::abs(trial);
        return direction * newton_root(S(0), most, first, [&](S travel) noexcept {
                   const S hardening = law.tangent(state, travel, direction) * fade;
                   return ValueAndSlope<S>{beyond(travel), -stiffness - hardening};
               });
    }
    return 0;
}

} // namespace ductile
