// SPDX-License-Identifier: MIT
//
// Whether a step was too long for what a joint did in it. However well its rows are solved, a
// velocity solver moves bodies with the velocity at the end of the step, and what begins or ends
// within a step it sees a step late.
//
// Flow. Where the speed of a flowing row changes from u to u', up to |u' - u| dt/2 of its travel is
// misplaced. A stop from speed u in n steps sums up to u dt/2, 1/n of its travel; a flow that a
// contact begins within a step is as uncertain. The sum, relative to the plastic travel so far, is
// the step error. It is judged where a flow ends: at its onset the travel so far says nothing yet.
//
// Direction. Rows that share a yield surface flow along its normal as far as their bounds were set
// around the right force. Plastic work done along another direction is misplaced as well
// (off_normal_work.hpp).
//
// Spring. One that the step cannot resolve is damped: it comes to rest under the force f where it
// should swing on about it, by √(2 k E) with the energy E that it lost. Where that would have
// reached the row's strength, the step is too long as well.
//
// Estimates for warning, not bounds: they cannot see motion that never reached the joint.
//
// Symbols as in one_axis_joint.hpp; θ as in elastic_row.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>

namespace ductile {

/// One row in one step.
template <std::floating_point S>
struct RowStep {
    S force;      ///< f [N | N m]
    S start;      ///< u [m/s | rad/s]
    S travel;     ///< (u + u') dt/2, signed [m | rad]
    S dt;         ///< [s]
    S noise;      ///< speed below which nothing flows [m/s | rad/s]
    S strength;   ///< R [N | N m]
    S stiffness;  ///< k; infinite: rigid [N/m | N m/rad]
    S implicit;   ///< θ of an elastic row
    S other_work; ///< numerical damping and the like [J]
    bool flowed;
};

/// Work that a step may have done in the wrong place, and that it should have done [J].
template <std::floating_point S>
struct StepError {
    S flow = 0;  ///< plastic work of travel that may be misplaced, >= 0
    S swing = 0; ///< energy that an unresolved spring lost and that would have made it yield, >= 0

    StepError& operator+=(const StepError& other) noexcept {
        flow += other.flow;
        swing += other.swing;
        return *this;
    }
};

template <std::floating_point S>
[[nodiscard]] StepError<S> step_error(const RowStep<S>& row) noexcept {
    const bool rigid = row.stiffness == std::numeric_limits<S>::infinity();
    const S changed = row.travel - row.start * row.dt; // Δu dt/2
    const S change = std::abs(row.force * changed);
    if (row.flowed) {
        const bool still =
            std::abs(row.start * row.dt) + std::abs(row.travel) <= row.noise * row.dt;
        return {.flow = still ? S(0) : (rigid ? S(1) : row.implicit) * change};
    }
    // a stiff spring moves by little, and what it does is measured by its force
    if (rigid || row.implicit == 0) return {};
    const S lost = row.implicit * std::max(row.other_work, change);
    const S swing = lost > 0 ? std::sqrt(2 * row.stiffness * lost) : S(0);
    return {.swing = std::abs(row.force) + swing > row.strength ? lost : S(0)};
}

/// Says whether the steps of a flow that ends, or a swing, were too long. `end`, `least_travel`: as
/// settle of step_end.hpp.
template <class State, class Step, class End, class LeastTravel>
void judge_step(State& state, Step& step, const End& end, LeastTravel&& least_travel) noexcept {
    using S = decltype(end.strength);
    if (!(state.misplaced + end.error.flow + end.error.swing > 0)) return;
    const S per_work = end.strength > 0 ? 1 / end.strength : S(0);
    state.misplaced += end.error.flow * per_work;
    step.step_error =
        (state.misplaced + end.error.swing * per_work) / (state.plastic_travel + least_travel());
    const bool moved = state.flowing || end.error.flow > 0 || end.error.swing > 0;
    const bool ends = !end.at_bound || state.broken;
    step.coarse = moved && ends && step.step_error > end.allowed_step_error;
}

} // namespace ductile
