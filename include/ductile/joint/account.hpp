// SPDX-License-Identifier: MIT
//
// How a step of any joint ends: its entries are carried into the state, the outcome is named, and a
// break is placed within its step.
//
// Time of a break. The row starts the step at speed u and would lose speed at the rate d under its
// full strength; its bounds were lowered to the share s of that, and it ended at u', so d = (u -
// u')/(s dt). What the step had left, the distance x, is run through after
//
//   u τ - d τ²/2 = x   <=>   τ = 2 x/(u + √(u² - 2 d x)),
//
// where the root is the speed at the break. Exact for a row of constant strength that moves alone;
// where a load acts as well its share of d is a little wrong, which moves τ by O(dt²).
//
// Symbols as in one_axis_joint.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>

#include "ductile/joint/step_error.hpp"
#include "ductile/vocabulary/row.hpp"

namespace ductile {

/// Time from the start of the step until `distance` x is run through, in [0, dt] [s]; u, u' along
/// the motion [m/s | rad/s], s in (0, 1].
template <std::floating_point S>
[[nodiscard]] S time_to_run(S distance, S start, S end, S share, S dt) noexcept {
    if (!(distance > 0)) return 0;
    const S loss = (start - end) / (share * dt);
    const S sum = start + std::sqrt(std::max(start * start - 2 * loss * distance, S(0)));
    return 2 * distance < sum * dt ? 2 * distance / sum : dt;
}

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

/// Share of the full strength that uses up the travel `left` in a step that starts at `speed`, in
/// (0, 1]. The travel of the step is predicted from below, so that a step that can break does
/// break: with the deceleration since the start of the last step, at `before`, where the joint
/// flowed in it, else with a stop inside this one. All along the motion [m | rad, m/s | rad/s].
template <std::floating_point S>
[[nodiscard]] S unspent_share(S left, S speed, S before, bool flowing, S dt) noexcept {
    const S lost = std::max(before - speed, S(0));
    const S slowed = flowing ? std::max(speed - lost, S(0)) : S(0);
    const S travel = (speed + slowed) / 2 * dt;
    return left < travel ? left / travel : S(1);
}

/// Says whether the steps of a flow that ends, or a swing, were too long: step_error.hpp.
template <class State, class Step, std::floating_point S, class Axes>
void judge_step(State& state, Step& step, const StepEnd<S, Axes>& end) noexcept {
    if (!(state.misplaced + end.error.flow + end.error.swing > 0)) return;
    const S per_work = end.strength > 0 ? 1 / end.strength : S(0);
    state.misplaced += end.error.flow * per_work;
    step.step_error =
        (state.misplaced + end.error.swing * per_work) / (state.plastic_travel + end.least_travel);
    const bool moved = state.flowing || end.error.flow > 0 || end.error.swing > 0;
    const bool ends = !end.at_bound || state.broken;
    step.coarse = moved && ends && step.step_error > end.allowed_step_error;
}

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
