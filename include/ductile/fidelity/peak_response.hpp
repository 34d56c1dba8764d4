// SPDX-License-Identifier: MIT
//
// What one axis does alone in a plain event, in closed form: a mass on an elastic-perfectly plastic
// resistance that is hit at a speed, loaded suddenly for a while, or both. An answer to compare a
// choice of detail with, before anything is simulated.
//
//   m u'' + r(u) = G + F(t),   u'(0) = v,   F(t) = F for 0 < t < t_d, then 0
//
// G has been there for long: it is in balance with the resistance k u_G = G at the start. Measured
// from there the axis has R - G left to yield, and perfect plasticity knows no other difference:
// G drops out of the motion and R stands for R - G below.
//
// Elastic, ω = √(k/m), u_s = F/k:   u = u_s + C sin(ωt - ψ),  C = √(u_s² + v²/ω²),  tan ψ = u_s ω/v
//   ends at yield (u_y = R/k), at the peak u_s + C, or at t_d; from there on the amplitude is
//   √(u² + u'²/ω²), and what it has above u_y is kinetic energy at yield.
// Plastic, from u_y with v_y:       m u'' = F - R, to the stop or to t_d; then a stop over m u'²/(2
// R) k = ∞: no elastic phase, v_y = v; an axis at rest under F <= R does not move.
//
// The peak of the first swing is the largest there is: later the load can only take energy out.
//
// Symbols ("x | y": translational axis | rotational axis)
//   m  effective mass   [kg | kg m²]       v        speed at the start, >= 0   [m/s | rad/s]
//   k  stiffness        [N/m | N m/rad]    F, t_d   sudden load, >= 0, its duration   [N | N m],
//   [s] R  strength         [N | N m]          G        load held from before, >= 0   [N | N m]
//
// Break: past the plastic displacement `limit` the axis holds no more. By then it has taken
// R × limit, and what is left of the motion is the speed at that moment.
//
// Limit cases: t_d → 0 with F t_d = m v, the impact at v; F = 0: u = (m v²/2 + R u_y/2)/R past
// yield; t_d = ∞, v = 0: u = u_y/(2 (1 - F/R)) past yield, 2 F/k before; F > R for ever runs away.
//
// Source: Biggs (1964), Introduction to Structural Dynamics, section 2.7; written out here.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <numbers>

#include "ductile/vocabulary/check.hpp"

namespace ductile {

/// One axis with all else held.
template <std::floating_point S>
struct AxisSystem {
    S mass = std::numeric_limits<S>::quiet_NaN();     ///< m [kg | kg m²], > 0
    S stiffness = std::numeric_limits<S>::infinity(); ///< k [N/m | N m/rad], > 0; infinity: rigid
    S strength = std::numeric_limits<S>::quiet_NaN(); ///< R [N | N m], > 0; infinity: elastic
    /// Plastic displacement at which it breaks [m | rad], > 0; infinity: never.
    S limit = std::numeric_limits<S>::infinity();

    bool operator==(const AxisSystem&) const = default;
};

/// What happens to it; everything towards the same side, which is the worst.
template <std::floating_point S>
struct AxisEvent {
    S speed = 0;                                     ///< v [m/s | rad/s], >= 0
    S load = 0;                                      ///< F [N | N m], >= 0
    S duration = std::numeric_limits<S>::infinity(); ///< t_d [s], > 0; infinity: the load stays
    S held = 0;                                      ///< G [N | N m], >= 0
    /// Where the speed comes from a contact: mass of the axis's own bodies, without what strikes
    /// them [kg | kg m²]; 0: no contact. The closed form does not ask; a stepped axis does
    /// (rehearsal.hpp).
    S own_mass = 0;

    bool operator==(const AxisEvent&) const = default;
};

template <std::floating_point S>
struct PeakResponse {
    S displacement = 0; ///< largest, from the position under G; infinity: runs away [m | rad]
    S plastic = 0;      ///< its plastic part [m | rad]
    S force = 0;        ///< largest in the axis, G included [N | N m]
    S speed = 0;        ///< left where it breaks; 0 where it does not [m/s | rad/s]
};

/// @throws std::invalid_argument where a number is out of range.
template <std::floating_point S>
void check_axis(const AxisSystem<S>& system) {
    check::positive("AxisSystem.mass", system.mass, "kg or kg m^2");
    check::positive_or_infinite("AxisSystem.stiffness", system.stiffness, "N/m or N m/rad");
    check::positive_or_infinite("AxisSystem.strength", system.strength, "N or N m");
    check::positive_or_infinite("AxisSystem.limit", system.limit, "m or rad");
}
template <std::floating_point S>
void check_event(const AxisEvent<S>& event) {
    check::non_negative("AxisEvent.speed", event.speed, "m/s or rad/s");
    check::non_negative("AxisEvent.load", event.load, "N or N m");
    check::positive_or_infinite("AxisEvent.duration", event.duration, "s");
    check::non_negative("AxisEvent.held", event.held, "N or N m");
    check::non_negative("AxisEvent.own_mass", event.own_mass, "kg or kg m^2");
}

namespace detail_response {

/// How far the plastic phase goes and what speed a break leaves.
template <std::floating_point S>
struct Flow {
    S way = 0;   ///< [m | rad]
    S speed = 0; ///< [m/s | rad/s]
};

/// Plastic phase from yield at speed v to the stop or the break, the load acting for `time` more.
template <std::floating_point S>
Flow<S> flow(S mass, S strength, S limit, S load, S time, S v) noexcept {
    constexpr S infinity = std::numeric_limits<S>::infinity();
    const S net = (load - strength) / mass;
    const S after = std::isinf(time) ? infinity : v + net * time;
    S loaded = 0, way = 0; // until the load ends; until the stop
    if (net < 0 && v <= -net * time) {
        way = loaded = v * v / (-2 * net);
    } else if (std::isinf(time)) {
        way = loaded = net > 0 || v > 0 ? infinity : S(0);
    } else {
        loaded = (v + after) / 2 * time;
        way = loaded + mass * after * after / (2 * strength);
    }
    if (!(way > limit)) return {way, 0};
    const S square = loaded >= limit ? v * v + 2 * net * limit
                                     : after * after - 2 * strength / mass * (limit - loaded);
    return {limit, std::sqrt(std::max(square, S(0)))};
}

} // namespace detail_response

/// Exact answer. O(1).
/// @throws std::invalid_argument where a number is out of range.
template <std::floating_point S>
[[nodiscard]] PeakResponse<S> peak_response(const AxisSystem<S>& system,
                                            const AxisEvent<S>& event) {
    check_axis(system);
    check_event(event);
    constexpr S infinity = std::numeric_limits<S>::infinity();
    const S m = system.mass, k = system.stiffness, v = event.speed, load = event.load;
    const S left = system.strength - event.held; // R, see above
    if (left <= 0) {
        const S way = system.limit; // runs away, or breaks
        return {way, way, system.strength, std::isinf(way) ? S(0) : infinity};
    }
    const auto flow = [&](S time, S speed) {
        return detail_response::flow(m, left, system.limit, load, time, speed);
    };

    if (std::isinf(k)) {
        if (std::isinf(left)) return {0, 0, v > 0 ? infinity : event.held + load};
        if (v <= 0 && load <= left) return {0, 0, event.held + load};
        const auto [plastic, speed] = flow(event.duration, v);
        return {plastic, plastic, system.strength, speed};
    }

    const S omega = std::sqrt(k / m), yield = left / k;
    const S mean = load / k, swing = std::hypot(mean, v / omega);
    const S phase = std::atan2(mean, v / omega);
    const bool yields = mean + swing > yield;
    const S end = yields
                      ? (phase + std::asin(std::clamp((yield - mean) / swing, S(-1), S(1)))) / omega
                      : (phase + std::numbers::pi_v<S> / 2) / omega;
    S peak = mean + swing;
    detail_response::Flow<S> plastic;
    if (event.duration < end) {
        const S angle = omega * event.duration - phase;
        peak = std::hypot(mean + swing * std::sin(angle), swing * std::cos(angle));
        if (peak > yield) {
            const S speed = omega * std::sqrt((peak - yield) * (peak + yield));
            plastic = detail_response::flow(m, left, system.limit, S(0), S(0), speed);
        }
    } else if (yields) {
        const S rise = yield - mean;
        const S speed = omega * std::sqrt(std::max((swing - rise) * (swing + rise), S(0)));
        plastic = flow(event.duration - end, speed);
    }
    if (plastic.way > 0) {
        return {yield + plastic.way, plastic.way, system.strength, plastic.speed};
    }
    return {peak, 0, event.held + k * peak};
}

} // namespace ductile
