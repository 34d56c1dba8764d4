// SPDX-License-Identifier: MIT
//
// One axis alone, stepped as an engine would step it, with the library's own joint: what a step of
// a given length makes of an event whose exact answer peak_response.hpp knows. The difference is
// the error of the step and of the detail together, found in microseconds before a scene is built.
//
//   v* = v + (F + G) dt/m,   the row's λ solved exactly,   v' = v* + λ/m,   u' = u + v' dt
//
// What it shows, and what the steps of choose_step follow from:
//   - a hit at speed v on a rigid-plastic axis stops short by v dt/2, because an engine moves with
//     the velocity at the end of a step; a break takes the right energy at any step;
//   - a hit by a contact loses up to v dt more: the contact is made somewhere within a step, and
//   the
//     row acts in all of it while nothing has moved. The rehearsal takes the whole step, the worst.
//     And the row knows only the mass of the joint's own bodies, by which it decides whether its
//     elastic part is resolved;
//   - an elastic axis whose row is resolved does not lose that step: its force follows the motion,
//   and
//     it stops within v dt/2 of its answer. What else a contact does to a scene, such as a normal
//     that turns within a step, no single axis shows: `contact_allowance` × v dt is allowed for it;
//   - an elastic axis is off by the order of (dt/T)², T the period, as long as T is resolved.
//
// Symbols as in peak_response.hpp; dt: step [s].
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>

#include "ductile/fidelity/peak_response.hpp"
#include "ductile/fracture/travel_limit.hpp"
#include "ductile/joint/one_axis_joint.hpp"
#include "ductile/law/perfect.hpp"

namespace ductile {

/// Steps after which a rehearsal is given up.
inline constexpr long longest_rehearsal = 100000;

namespace detail_rehearsal {
/// Share of the highest speed below which an axis has come to rest: what holds may still creep by
/// round-off.
template <std::floating_point S>
inline constexpr S at_rest = S(1e-6);
} // namespace detail_rehearsal

/// What steps of `dt` > 0 [s] make of the event; infinite where it has not come to its peak after
/// `longest_rehearsal` steps. O(steps).
/// @throws std::invalid_argument where a number is out of range.
template <std::floating_point S>
[[nodiscard]] PeakResponse<S> rehearse(const AxisSystem<S>& system, const AxisEvent<S>& event,
                                       S dt) {
    check_axis(system);
    check_event(event);
    check::positive("rehearse.dt", dt, "s");
    constexpr S infinity = std::numeric_limits<S>::infinity();
    if (event.held >= system.strength || std::isinf(system.strength)) {
        return peak_response(system, event); // nothing to step
    }
    OneAxisJoint joint(Perfect<S>({.strength = system.strength}),
                       TravelLimit<S>({.limit = system.limit}), {.stiffness = system.stiffness});
    const S m = system.mass;
    const bool by_contact = event.own_mass > 0;
    const S felt = by_contact ? event.own_mass : m;
    const S start = std::isinf(system.stiffness) ? S(0) : event.held / system.stiffness;
    S u = start, v = event.speed, peak = start, strongest = event.held;
    S fastest = v;
    for (long step = 0; step < longest_rehearsal; ++step) {
        const S lasting = std::clamp((event.duration - S(step) * dt) / dt, S(0), S(1));
        const RowLimits<S> row = joint.prepare({.position = u, .velocity = v, .mass = felt}, dt);
        const S free = v + dt * (event.load * lasting + event.held) / m;
        const S impulse = std::clamp((row.bias - free) / (1 / m + row.compliance), row.lower * dt,
                                     row.upper * dt);
        v = free + impulse / m;
        if (step > 0 || !by_contact) u += dt * v;
        const Step<S> done = joint.commit({impulse / dt, v, u}, dt);
        peak = std::max(peak, u);
        strongest = std::max(strongest, std::abs(impulse) / dt);
        if (done.fracture) {
            const S left = std::sqrt(v * v + 2 * done.release / m);
            return {peak - start, joint.state().plastic_travel, strongest, left};
        }
        fastest = std::max(fastest, v);
        if (v <= detail_rehearsal::at_rest<S> * fastest)
            return {peak - start, joint.state().plastic_travel, strongest, 0};
    }
    return {infinity, infinity, strongest, 0};
}

/// By how much `found` is off: of the speed that is left where the axis really breaks, else of the
/// peak displacement. 1 where one breaks and the other does not. [-]
template <std::floating_point S>
[[nodiscard]] S response_error(const PeakResponse<S>& exact,
                               const PeakResponse<S>& found) noexcept {
    if (std::isinf(exact.displacement)) return std::isinf(found.displacement) ? S(0) : S(1);
    if ((exact.speed > 0) != (found.speed > 0)) return 1;
    if (exact.speed > 0) {
        if (std::isinf(exact.speed)) return std::isinf(found.speed) ? S(0) : S(1);
        return std::abs(found.speed / exact.speed - 1);
    }
    if (exact.displacement <= 0) return found.displacement > 0 ? S(1) : S(0);
    return std::min(std::abs(found.displacement / exact.displacement - 1), S(1));
}

/// Share of v dt by which a contact may be off beside what a rehearsal shows, for axes with an
/// elastic part; without one the rehearsal takes the worst case of the contact, which includes it.
/// As much again as the axis by itself; an allowance, not a bound.
template <std::floating_point S>
inline constexpr S contact_allowance = S(0.5);

/// A step and the largest error of it and of every finer one that was looked at.
template <std::floating_point S>
struct StepFit {
    S dt = 0;                                     ///< [s]; 0: none is fine enough
    S error = std::numeric_limits<S>::infinity(); ///< [-]
};

/// The longest step, up to `longest` [s], from which on every finer one keeps the error of
/// `rehearse(model, event, dt)` against `exact` within `target`. Steps are looked at 3 % apart,
/// down to a quarter of the answer: errors that happen to change sign do not count. None is looked
/// at where the model itself is off, which the finest step comes to.
/// @throws std::invalid_argument where a number is out of range.
template <std::floating_point S>
[[nodiscard]] StepFit<S> choose_step(const AxisSystem<S>& model, const AxisEvent<S>& event,
                                     const PeakResponse<S>& exact, S target, S longest) {
    check::positive("choose_step.longest", longest, "s");
    if (!(response_error(exact, peak_response(model, event)) <= target)) return {};
    constexpr S finer = S(0.97), window = S(0.25);
    StepFit<S> fit;
    for (S dt = longest; fit.dt == 0 || dt >= window * fit.dt; dt *= finer) {
        const PeakResponse<S> found = rehearse(model, event, dt);
        S error = response_error(exact, found);
        if (event.own_mass > 0 && !std::isinf(model.stiffness)) {
            error += contact_allowance<S> * event.speed * dt / exact.displacement;
        }
        if (!(error <= target)) {
            fit = {};
        } else if (fit.dt == 0) {
            fit = {dt, error};
        } else {
            fit.error = std::max(fit.error, error);
        }
        // it takes too many steps to find one that is fine enough
        if (std::isinf(found.displacement) && !std::isinf(exact.displacement)) return {};
    }
    return fit;
}

} // namespace ductile
