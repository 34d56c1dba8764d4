// SPDX-License-Identifier: MIT
//
// How a step of any joint ends: its entries are carried into the state, and the outcome is named.
//
// Symbols as in one_axis_joint.hpp.
#pragma once

#include <algorithm>
#include <concepts>

#include "ductile/joint/step_error.hpp"
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
    S least_travel;       ///< against which small travels are judged [m | rad]
    S allowed_step_error; ///< [-]
    S dt;                 ///< [s]
    bool at_bound;
};

/// Carries a step into the state, which says already whether this step broke the joint, and names
/// its outcome.
template <class State, class Step, std::floating_point S, class Axes>
void settle(State& state, Step& step, const StepEnd<S, Axes>& end) noexcept {
    if (state.broken) {
        step.lost = state.stored + step.elastic;
        step.elastic -= step.lost;
    }
    step.first_yield = step.plastic_work > 0 && state.plastic_work == 0;
    step.fracture = state.broken;
    state.time += end.dt;
    state.dt = end.dt;
    state.plastic_work += step.plastic_work;
    state.stored += step.elastic;
    state.other_work += step.other_work;
    state.lost += step.lost;
    state.residual_max = std::max(state.residual_max, step.residual);
    judge_step(state, step, end);
    state.start_velocity = end.start;
    state.velocity = end.velocity;
    state.force = end.force;
    state.flowing = end.at_bound;
    if (state.broken) {
        step.outcome = Outcome::broken;
    } else if (step.residual > end.allowed_residual) {
        step.outcome = Outcome::unreliable;
    } else if (step.plastic_work > 0 && (end.at_bound || end.start_speed > end.absolute_residual)) {
        step.outcome = Outcome::yielding; // and not the round-off of a flow that has stopped
    }
}

} // namespace ductile
