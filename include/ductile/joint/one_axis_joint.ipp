// SPDX-License-Identifier: MIT
//
// The course of a step of one_axis_joint.hpp: templates, seen everywhere.
#pragma once

#include "ductile/joint/one_axis_joint.hpp"

namespace ductile {

template <class Law, FractureCriterion Criterion>
requires CyclicLaw<typename CyclicForm<Law>::type>
auto OneAxisJoint<Law, Criterion>::prepare(const Motion<Scalar>& motion, Scalar dt) noexcept
    -> RowLimits<Scalar> {
    start_ = motion.velocity;
    elastic_ = motion.position - state_.plastic_offset;
    ahead_ = motion.ahead;
    turning_ = motion.turning;
    drift_ = motion.drift;
    const Scalar middle = elastic_;
    if (ahead_) elastic_ = motion.before - state_.plastic_offset;
    sound_ = are_finite(start_, elastic_, dt) && (rigid() || motion.mass >= 0);
    if (state_.broken || !sound_) return {.lower = 0, .upper = 0};
    bound(dt);
    RowLimits<Scalar> row{.lower = lower_, .upper = upper_};
    if (rigid()) {
        row =
            rigid_row(elastic_, lower_, upper_, parameters_.drift_time, dt, parameters_.stiffness);
    } else {
        using Spring = SpringRow<Scalar>;
        const Scalar k = parameters_.stiffness;
        implicit_ = ahead_ ? mean_share<Scalar> : implicit_share(k, motion.mass, dt);
        // the springs of steps as they are lose more than steel by themselves
        const Scalar material = std::max(parameters_.damping_time, motion.damping);
        if (ahead_) reach_strength(dt);
        spring_ = ahead_
                      ? Spring::half_ahead(k, material, elastic_, middle, motion.mass, start_, dt)
                      : Spring::now(k, motion.damping, elastic_, implicit_, dt);
        row = spring_.limits(lower_, upper_, dt);
    }
    given_ = !rigid() && row.lower == row.upper;
    bias_ = row.bias += drift_;
    compliance_ = row.compliance;
    return row;
}

template <class Law, FractureCriterion Criterion>
requires CyclicLaw<typename CyclicForm<Law>::type>
auto OneAxisJoint<Law, Criterion>::commit(const Reaction& reaction, Scalar dt,
                                          Scalar granted) noexcept -> Step<Scalar> {
    Step<Scalar> step;
    if (state_.broken) {
        step.outcome = Outcome::broken;
        return step;
    }
    const Taken taken{.force = reaction.force,
                      .work = -reaction.force * dt * (start_ + reaction.velocity) / 2,
                      .travel = (start_ + reaction.velocity) / 2 * dt,
                      .velocity = reaction.velocity - drift_,
                      .position = reaction.position,
                      .dt = dt,
                      .at_upper = reaction.force >= upper_ - tolerance_,
                      .at_lower = reaction.force <= lower_ + tolerance_,
                      .granted = granted};
    if (!sound_ || !are_finite(taken.work, taken.position)) return unbooked_step<Step<Scalar>>();
    step.residual = violation(reaction, taken);
    const bool solved = step.residual <= allowed_residual(reaction.velocity);
    const Scalar snaps_at = solved ? snapped(taken) : Scalar(0);
    if (!solved) {
        commit_unsolved(step, taken);
    } else if (snaps_at != 0) {
        snap(step, taken, snaps_at);
    } else if (rigid()) {
        commit_rigid(step, taken);
    } else {
        commit_elastic(step, taken);
    }
    if (solved && !(step.claimed > 0)) step.unclaimed = solved_share() * step.other_work;
    settle(state_, step,
           StepEnd<Scalar, Scalar>{.start = start_,
                                   .velocity = reaction.velocity,
                                   .force = snaps_at != 0 ? snaps_at : reaction.force,
                                   .start_speed = std::abs(start_),
                                   .absolute_residual = parameters_.absolute_residual,
                                   .allowed_residual = allowed_residual(reaction.velocity),
                                   .error = error_of(step, taken),
                                   .strength = flow_.resistance(taken.travel),
                                   .largest_force = flow_.resistance(taken.travel),
                                   .allowed_step_error = parameters_.allowed_step_error,
                                   .dt = dt,
                                   .at_bound = taken.at_bound()},
           [this]() noexcept { return least_travel(); });
    if (state_.broken) [[unlikely]]
        place_break(step, taken);
    return step;
}

template <class Law, FractureCriterion Criterion>
requires CyclicLaw<typename CyclicForm<Law>::type>
auto OneAxisJoint<Law, Criterion>::snapped(const Taken& taken) const noexcept -> Scalar {
    const Scalar above = cap(1), below = cap(-1);
    const bool pushes = upper_ == above, pulls = lower_ == -below;
    if (pushes && taken.at_upper) return above;
    if (pulls && taken.at_lower) return -below;
    if (rigid() || !ahead_) return 0;
    // the force has reached it at the end of the part, or where the row turned round within
    const Scalar u = taken.velocity;
    const Scalar end = taken.position - state_.plastic_offset + spring_.damping * u;
    const bool turned = start_ * u < 0;
    const Scalar turn = turned ? elastic_ + start_ * start_ * taken.dt / (2 * (start_ - u)) : end;
    const Scalar k = parameters_.stiffness;
    if (pushes && -k * std::min(end, turn) >= above) return above;
    if (pulls && k * std::max(end, turn) >= below) return -below;
    return 0;
}

template <class Law, FractureCriterion Criterion>
requires CyclicLaw<typename CyclicForm<Law>::type>
void OneAxisJoint<Law, Criterion>::snap(Step<Scalar>& step, const Taken& taken,
                                        Scalar force) noexcept {
    const Scalar k = parameters_.stiffness;
    const Scalar strained = rigid() ? Scalar(0) : force / k;
    step.elastic = rigid() ? Scalar(0) : k * (strained * strained - elastic_ * elastic_) / 2;
    step.release = std::max(taken.work - step.elastic, Scalar(0));
    step.other_work = taken.work - step.elastic - step.release;
    criterion_.update(state_.criterion,
                      {Scalar(0), state_.plastic_travel, force, Scalar(0), taken.dt});
    state_.broken = true;
}

} // namespace ductile
