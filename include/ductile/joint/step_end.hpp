// SPDX-License-Identifier: MIT
//
// How a step of any joint ends: its entries are carried into the state, and the outcome is named.
//
// Energy from nothing. What `other_work` adds up to may be negative at times by the work of a step:
// a symplectic spring acts a step late and owes f u dt/2 within a swing or a flow. A joint that has
// given its bodies clearly more, beside all that it took, drives them: it is unreliable, whatever
// the residual says.
//
// Symbols as in one_axis_joint.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>

#include "ductile/joint/step_error.hpp"
#include "ductile/numeric/small_vector.hpp"
#include "ductile/vocabulary/finite.hpp"
#include "ductile/vocabulary/row.hpp"

namespace ductile {

/// With what a step ended, beside what it booked. `Axes` is a number or a vector, one entry per
/// axis.
template <std::floating_point S, class Axes>
struct StepEnd {
    Axes start;           ///< u [m/s | rad/s]
    Axes velocity;        ///< u' [m/s | rad/s]
    Axes force;           ///< f [N | N m]
    S start_speed;        ///< largest |u| [m/s | rad/s]
    S absolute_residual;  ///< [m/s | rad/s]
    S allowed_residual;   ///< [m/s | rad/s]
    StepError<S> error;   ///< of all rows [J]
    S strength;           ///< R [N | N m]
    Axes largest_force;   ///< that the rows could have had, >= 0 [N | N m]
    S allowed_step_error; ///< [-]
    S dt;                 ///< [s]
    bool at_bound;
};

/// Share of what a joint took that its account may lack at times [-].
template <std::floating_point S>
inline constexpr S allowed_gain = S(0.2);

/// Work of a step of the largest force at the larger of two velocities, all axes together [J].
template <std::floating_point S>
[[nodiscard]] S largest_work(S force, S start, S end, S dt) noexcept {
    return force * std::max(std::abs(start), std::abs(end)) * dt;
}
template <class Axes, std::floating_point S>
[[nodiscard]] S largest_work(const Axes& force, const Axes& start, const Axes& end, S dt) noexcept {
    return numeric::dot(force, Axes(start.cwiseAbs().cwiseMax(end.cwiseAbs()))) * dt;
}

/// Steps whose largest work an account may lack: one that a spring acts late, one in which
/// velocities are those of its middle [-].
template <std::floating_point S>
inline constexpr S owed_steps = 2;

/// Share of a gain below which a step adds nothing to it but round-off [-].
template <std::floating_point S>
inline constexpr S noticed_gain = S(1e-4);

/// What a joint has given its bodies beyond all that it took, where that is too much to be
/// believed and this step gave `given` of it, else 0 [J].
template <class State, std::floating_point S, class Axes, class LeastTravel>
[[nodiscard]] S energy_gained(const State& state, S given, const StepEnd<S, Axes>& end,
                              LeastTravel&& least_travel) noexcept {
    const S taken = state.plastic_work + state.stored + state.lost;
    const S gained = -state.other_work;
    if (!(gained > allowed_gain<S> * taken) || !(given > noticed_gain<S> * gained)) return 0;
    const S unnoticed = allowed_gain<S> * (taken + end.strength * least_travel());
    const S owed = largest_work(end.largest_force, end.start, end.velocity, end.dt);
    return gained > unnoticed + owed_steps<S> * owed ? gained : S(0);
}

/// Carries a step into the state, which says already whether this step broke the joint, and names
/// its outcome. `least_travel()`: against which small travels are judged [m | rad]; asked for where
/// it matters.
template <class State, class Step, std::floating_point S, class Axes, class LeastTravel>
void settle(State& state, Step& step, const StepEnd<S, Axes>& end,
            LeastTravel&& least_travel) noexcept {
    if (state.broken) {
        step.lost = state.stored + step.elastic;
        step.elastic -= step.lost;
    }
    step.first_yield = step.plastic_work > 0 && state.plastic_work == 0;
    step.fracture = state.broken;
    state.time += end.dt;
    state.plastic_work += step.plastic_work;
    state.stored += step.elastic;
    state.damped += step.damped;
    state.other_work += step.other_work;
    state.lost += step.lost;
    state.residual_max = worse(state.residual_max, step.residual);
    judge_step(state, step, end, least_travel);
    if (state.other_work < 0) {
        step.gained = energy_gained(state, -step.other_work, end, least_travel);
    }
    state.start_velocity = end.start;
    state.velocity = end.velocity;
    state.force = end.force;
    state.flowing = end.at_bound;
    if (state.broken) {
        step.outcome = Outcome::broken;
    } else if (!(step.residual <= end.allowed_residual) || step.gained > 0) {
        step.outcome = Outcome::unreliable;
    } else if (step.plastic_work > 0 && (end.at_bound || end.start_speed > end.absolute_residual)) {
        step.outcome = Outcome::yielding; // and not the round-off of a flow that has stopped
    }
}

} // namespace ductile
