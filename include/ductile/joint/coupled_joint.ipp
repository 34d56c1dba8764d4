// SPDX-License-Identifier: MIT
//
// The course of a step of coupled_joint.hpp: templates, seen everywhere.
#pragma once

#include <cstddef>

#include "ductile/joint/coupled_joint.hpp"
#include "ductile/joint/off_normal_work.hpp"

namespace ductile {

// flow is along the normal where θ is the same in all rows, and a given force leaves the others to
// flow where they are; `bound` predicts with 1
template <YieldSurface Surface, StrengthLaw Law, FractureCriterion Criterion>
requires std::same_as<typename Surface::Scalar, typename Law::Scalar>
auto CoupledJoint<Surface, Law, Criterion>::meet_surface(Scalar dt, bool passes) noexcept
    -> std::optional<Rows> {
    passes_ = passes && ahead_;
    for (int i = 0; i < dimension; ++i) {
        if (will_flow_ && !ahead_) implicit_[i] = 1;
        if (!rigid(i) && !(implicit_[i] > 0) && !(damping(i) > 0)) return std::nullopt;
        rows_[std::size_t(i)] = row(i, dt);
        if (passes_ && rigid(i)) rows_[std::size_t(i)].bias -= passing_[i] - drift_[i];
    }
    return rows_;
}

template <YieldSurface Surface, StrengthLaw Law, FractureCriterion Criterion>
requires std::same_as<typename Surface::Scalar, typename Law::Scalar>
auto CoupledJoint<Surface, Law, Criterion>::row(int i, Scalar dt) const noexcept
    -> RowLimits<Scalar> {
    RowLimits<Scalar> limits = rigid(i)
                                   ? rigid_row(elastic_[i], lower_[i], upper_[i],
                                               parameters_.drift_time, dt, rigid_stiffness_of(i))
                                   : spring(i, dt).limits(lower_[i], upper_[i], dt);
    limits.bias += drift_[i];
    return limits;
}

template <YieldSurface Surface, StrengthLaw Law, FractureCriterion Criterion>
requires std::same_as<typename Surface::Scalar, typename Law::Scalar>
auto CoupledJoint<Surface, Law, Criterion>::prepare(const Motion& motion, Scalar dt) noexcept
    -> Rows {
    start_ = passing_ = motion.velocity;
    elastic_ = motion.position - state_.plastic_offset;
    ahead_ = motion.ahead;
    turning_ = motion.turning;
    damping_ = motion.damping;
    drift_ = motion.drift;
    mass_ = motion.mass.diagonal();
    middle_ = elastic_;
    if (ahead_) elastic_ = motion.before - state_.plastic_offset;
    sound_ = is_finite(motion, dt);
    rows_.fill({.lower = 0, .upper = 0});
    passes_ = false;
    if (state_.broken || !sound_) return rows_;
    bound(motion, dt);
    for (int i = 0; i < dimension; ++i) {
        implicit_[i] = rigid(i) ? Scalar(1)
                       : ahead_ ? mean_share<Scalar>
                                : implicit_share(parameters_.stiffness[i], motion.mass(i, i), dt);
        rows_[std::size_t(i)] = row(i, dt);
    }
    return rows_;
}

template <YieldSurface Surface, StrengthLaw Law, FractureCriterion Criterion>
requires std::same_as<typename Surface::Scalar, typename Law::Scalar>
auto CoupledJoint<Surface, Law, Criterion>::off_normal(const Reaction& reaction, bool flows,
                                                       Scalar dt) const noexcept -> Vector {
    Vector excess;
    for (int i = 0; i < dimension; ++i) {
        const RowLimits<Scalar>& row = rows_[std::size_t(i)];
        const Scalar compliance = std::max(row.compliance, row.softness);
        excess[i] = reaction.velocity[i] + compliance * reaction.force[i] * dt - row.bias;
    }
    if (flows) {
        const Vector normal = surface_.normal(reaction.force);
        const Scalar along = numeric::dot(excess, normal) / numeric::dot(normal, normal);
        if constexpr (!requires { surface_.semi_axes(); }) { // an ellipsoid has no corners
            // in a corner, which has many normals, the force is the one that meets the flow
            const Vector met = surface_.support(Vector(-excess)) * reach();
            if (surface_.value(Vector(met - reaction.force)) <= bound_tolerance * reach()) {
                return Vector::Zero();
            }
        }
        if (along < 0) excess -= along * normal; // against the force
    }
    return excess.cwiseAbs();
}

// on the surface; where a section is known what it moved may only strain it
template <YieldSurface Surface, StrengthLaw Law, FractureCriterion Criterion>
requires std::same_as<typename Surface::Scalar, typename Law::Scalar>
bool CoupledJoint<Surface, Law, Criterion>::stands(const Reaction& reaction,
                                                   Scalar dt) const noexcept {
    if (!all_rigid_ || !holds_strain_) return false;
    Scalar work = 0;
    for (int i = 0; i < dimension; ++i) {
        const Scalar travel = (start_[i] + reaction.velocity[i]) / 2 * dt;
        const Scalar strain = elastic_[i] + reaction.force[i] / rigid_stiffness_of(i);
        work -= reaction.force[i] * (strain + travel);
    }
    return !(work > 0);
}

template <YieldSurface Surface, StrengthLaw Law, FractureCriterion Criterion>
requires std::same_as<typename Surface::Scalar, typename Law::Scalar>
auto CoupledJoint<Surface, Law, Criterion>::commit(const Reaction& reaction, Scalar dt,
                                                   Scalar granted) noexcept -> Step {
    Step step;
    if (state_.broken) {
        step.outcome = Outcome::broken;
        return step;
    }
    if (!sound_ || !is_finite(reaction, start_, dt)) return unbooked_step<Step>();
    Taken taken{.force = reaction.force};
    Scalar most = 0;
    const Scalar jump = allowed_residual(start_) + turning_;
    const bool flows = surface_.value(reaction.force) >= reach() * (1 - bound_tolerance);
    const Vector off = reaction.on_surface ? off_normal(reaction, flows, dt) : Vector::Zero();
    std::array<RowBooking<Scalar>, std::size_t(dimension)> rows;
    const bool slips = flows && !stands(reaction, dt);
    for (int i = 0; i < dimension; ++i) {
        const OpenRow<Scalar> open = open_row(i, jump, dt);
        const ductile::Reaction<Scalar> of_row{reaction.force[i], reaction.velocity[i],
                                               reaction.position[i]};
        RowBooking<Scalar>& booked = rows[std::size_t(i)];
        booked = reaction.on_surface ? open.book_on_surface(of_row, dt, flows, slips, off[i])
                                     : open.book(of_row, dt);
        step.residual = worse(step.residual, booked.residual);
        // stopped after all, it was thrown back
        if (passes_ && !flows && rigid(i))
            step.residual = worse(step.residual, std::abs(start_[i]));
    }
    // what the solver left undone is nobody's flow: no travel, no life, no break
    const bool solved = step.residual <= allowed_residual(reaction.velocity);
    for (int i = 0; i < dimension; ++i) {
        const RowBooking<Scalar>& booked = rows[std::size_t(i)];
        const Scalar share = 1 - implicit_[i] * (1 - granted); // of rows that were solved for
        (solved ? taken.flow : step.other_work) += share * booked.flow;
        if (booked.flow > most) {
            most = booked.flow;
            taken.axis = i;
        }
        step.elastic += booked.elastic;
        step.damped += booked.damped;
        step.other_work += booked.other + (1 - share) * booked.flow;
        if (!rigid(i)) state_.plastic_offset[i] += booked.travel;
        if (!solved) continue;
        taken.asked += booked.flow;
        step.claimed += implicit_[i] * booked.flow;
        step.unclaimed += booked.travel == 0 ? implicit_[i] * booked.other : Scalar(0);
        step.direction[i] = share * booked.travel;
        taken.error += booked.error;
        taken.at_bound[i] = booked.at_bound;
        if (booked.moved) state_.plastic_offset[i] = reaction.position[i] - booked.strained;
    }
    if (!ahead_) { // else the frame judges its parts
        const Scalar misdirected =
            off_normal_work(surface_, reaction.force, step.direction, taken.flow);
        taken.error.flow = std::max(taken.error.flow, misdirected);
    }
    const Scalar snaps = solved ? snapped(reaction, dt) : 2 * dt;
    if (snaps <= dt) {
        snap(step, taken, reaction, snaps, dt);
    } else {
        flow(step, taken, reaction, dt);
    }
    if (flows && step.plastic_work > 0) step.misfit += missed_onset(reaction, dt);
    if (state_.broken) step.held = dt - step.after_break;
    settle(state_, step,
           StepEnd<Scalar, Vector>{.start = start_,
                                   .velocity = reaction.velocity,
                                   .force = taken.force,
                                   .start_speed = numeric::largest(start_),
                                   .absolute_residual = parameters_.absolute_residual,
                                   .allowed_residual = allowed_residual(reaction.velocity),
                                   .error = taken.error,
                                   .strength = first_strength_ * grown_,
                                   .largest_force = upper_.cwiseMax(-lower_),
                                   .allowed_step_error = parameters_.allowed_step_error,
                                   .dt = dt,
                                   .at_bound = taken.at_bound.any()},
           [this]() noexcept { return least_travel(); });
    return step;
}

template <YieldSurface Surface, StrengthLaw Law, FractureCriterion Criterion>
requires std::same_as<typename Surface::Scalar, typename Law::Scalar>
void CoupledJoint<Surface, Law, Criterion>::flow(Step& step, Taken& taken, const Reaction& reaction,
                                                 Scalar dt) noexcept {
    const Scalar work = taken.flow, strength = first_strength_ * grown_;
    // whose force was not found it has passed where its bodies did
    const Scalar asked = taken.asked != 0 ? taken.asked / strength : way_of(reaction, dt);
    const bool spent = share_ < carries_nothing<Scalar> && uses_up(asked, left_);
    if (!(work > 0)) {
        step.other_work += work;
        step.direction.setZero();
        state_.broken = spent;
        if (spent) end_after(step, taken, reaction, Scalar(0), dt);
        return;
    }
    Scalar travel = work / strength;
    const Scalar foretold = std::min(travel, left_);
    step.misfit = std::abs(mean_strength_of(foretold) - strength) * foretold;
    if (step.misfit > leftover_share<Scalar> * work) {
        const auto took = [this](Scalar way) noexcept { return mean_strength_of(way) * way; };
        const auto at = [this](Scalar way) noexcept {
            return law_.value(state_.plastic_travel + way) *
                   criterion_.strength_factor(state_.criterion, way);
        };
        travel = travel_of_work(work, travel, left_, took, at);
    }
    // of the travel whose work is booked: a spring's is where the step ends
    const Scalar slipped = -numeric::dot(taken.force, step.direction);
    const bool differs = reaction.on_surface && slipped > 0;
    const Scalar booked = differs ? std::min(work / slipped, Scalar(2)) : Scalar(1);
    // what stopped within the step had its strength for a share of it, and flowed in that alone
    const Scalar flowed = taken.at_bound.any()
                              ? Scalar(1)
                              : std::min(surface_.value(taken.force) / reach(), Scalar(1));
    const Scalar as_far = travel * strength / work; // as its work says
    const Scalar life = lives_.of(step.direction) * share_ * booked * flowed * as_far;
    const Scalar left = std::min(left_, travel_left(travel, life, state_.life));
    const bool last = spent || uses_up(travel, left);
    step.plastic_work = work;
    if (last) {
        travel = std::min(travel, left);
        step.plastic_work = std::min(work, mean_strength_of(travel) * travel);
    }
    state_.life = std::min(state_.life + life * (step.plastic_work / work), Scalar(1));
    state_.plastic_travel += travel;
    const Scalar force = cap_ < std::numeric_limits<Scalar>::infinity() // below it: see brittle
                             ? surface_.value(reaction.force) * first_strength_
                             : strength;
    criterion_.update(state_.criterion,
                      {travel, state_.plastic_travel, force, step.plastic_work, dt});
    state_.broken =
        last || criterion_.broken(state_.criterion) || faded(law_, state_.plastic_travel);
    const Scalar rest = work - step.plastic_work;
    (state_.broken ? step.release : step.other_work) += rest;
    if (state_.broken) end_after(step, taken, reaction, travel, dt);
}

template <YieldSurface Surface, StrengthLaw Law, FractureCriterion Criterion>
requires std::same_as<typename Surface::Scalar, typename Law::Scalar>
auto CoupledJoint<Surface, Law, Criterion>::missed_onset(const Reaction& reaction,
                                                         Scalar dt) const noexcept -> Scalar {
    if (!ahead_ || all_rigid_ || cap_ < grown_) return 0;
    Vector from, to;
    Scalar work = 0;
    for (int i = 0; i < dimension; ++i) {
        const Scalar travel = (start_[i] + reaction.velocity[i]) / 2 * dt;
        from[i] = rigid(i) ? reaction.force[i] : -parameters_.stiffness[i] * elastic_[i];
        to[i] = rigid(i) ? reaction.force[i] : from[i] - parameters_.stiffness[i] * travel;
        if (!rigid(i)) work -= reaction.force[i] * travel;
    }
    const Scalar first = surface_.value(from) / reach(), last = surface_.value(to) / reach();
    if (!(first < 1 && last > 1 && work > 0)) return 0;
    const Scalar lacking = 1 - first;
    return lacking / 2 * (lacking / (last - first)) * work;
}

template <YieldSurface Surface, StrengthLaw Law, FractureCriterion Criterion>
requires std::same_as<typename Surface::Scalar, typename Law::Scalar>
auto CoupledJoint<Surface, Law, Criterion>::force_at(Scalar time, const Reaction& reaction,
                                                     Scalar dt) const noexcept -> Vector {
    Vector force = reaction.force;
    for (int i = 0; i < dimension; ++i) {
        if (rigid(i)) continue;
        const Scalar change = (reaction.velocity[i] - start_[i]) / dt;
        const Scalar strained = elastic_[i] + (start_[i] - drift_[i] + change * time / 2) * time;
        const Scalar speed = start_[i] - drift_[i] + change * time;
        force[i] = -parameters_.stiffness[i] * (strained + damping(i) * speed);
    }
    return force;
}

template <YieldSurface Surface, StrengthLaw Law, FractureCriterion Criterion>
requires std::same_as<typename Surface::Scalar, typename Law::Scalar>
auto CoupledJoint<Surface, Law, Criterion>::snapped(const Reaction& reaction,
                                                    Scalar dt) const noexcept -> Scalar {
    const Scalar reached = cap_ * (1 - bound_tolerance);
    const Scalar never = std::numeric_limits<Scalar>::infinity();
    if (!(cap_ < never)) return never;
    const auto beyond = [&](Scalar time) noexcept {
        return surface_.value(force_at(time, reaction, dt)) >= reached;
    };
    Scalar last = dt;
    if (ahead_ && !all_rigid_ && !beyond(last)) { // where the gauge goes back, as its rates tell
        const Vector normal = surface_.normal(force_at(dt, reaction, dt));
        Scalar first = 0, end = 0;
        for (int i = 0; i < dimension; ++i) {
            if (rigid(i)) continue;
            first -= normal[i] * parameters_.stiffness[i] * start_[i];
            end -= normal[i] * parameters_.stiffness[i] * reaction.velocity[i];
        }
        if (first > 0 && end < 0) last = dt * first / (first - end);
    }
    const bool at_end = beyond(last), at_mean = surface_.value(reaction.force) >= reached;
    if (!at_mean && !(at_end && ahead_)) return never;
    if (!at_end) return dt;
    Scalar before = 0;
    if (beyond(before)) return 0;
    constexpr int halvings = 40;
    for (int i = 0; i < halvings; ++i) {
        const Scalar middle = (before + last) / 2;
        (beyond(middle) ? last : before) = middle;
    }
    return last;
}

template <YieldSurface Surface, StrengthLaw Law, FractureCriterion Criterion>
requires std::same_as<typename Surface::Scalar, typename Law::Scalar>
void CoupledJoint<Surface, Law, Criterion>::snap(Step& step, Taken& taken, const Reaction& reaction,
                                                 Scalar time, Scalar dt) noexcept {
    taken.force = force_at(time, reaction, dt);
    taken.force *= cap_ / surface_.value(taken.force);
    const Scalar took = taken.flow + step.other_work + step.elastic;
    step.elastic = 0;
    for (int i = 0; i < dimension; ++i) {
        const Scalar k = parameters_.stiffness[i], force = taken.force[i];
        if (!rigid(i)) step.elastic += (force * force / k - k * elastic_[i] * elastic_[i]) / 2;
    }
    step.release = std::max(took - step.elastic, Scalar(0));
    step.other_work = took - step.elastic - step.release;
    const Scalar reached = cap_ * first_strength_;
    criterion_.update(state_.criterion, {0, state_.plastic_travel, reached, 0, dt});
    state_.broken = true;
    int axis = 0;
    taken.force.cwiseProduct(surface_.normal(taken.force)).maxCoeff(&axis);
    state_.broken_axis = axis;
    step.after_break = dt - time;
    state_.time -= step.after_break; // of the whole step that `settle` books
}

template <YieldSurface Surface, StrengthLaw Law, FractureCriterion Criterion>
requires std::same_as<typename Surface::Scalar, typename Law::Scalar>
void CoupledJoint<Surface, Law, Criterion>::end_after(Step& step, Taken& taken,
                                                      const Reaction& reaction, Scalar travel,
                                                      Scalar dt) noexcept {
    state_.broken_axis = taken.axis;
    const Scalar share = std::max(share_, std::numeric_limits<Scalar>::min());
    taken.force = taken.at_bound.select(taken.force / share, taken.force);
    // equivalent speeds: power by strength, as the travel is work by strength
    const Scalar strength = first_strength_ * grown_;
    const Scalar start = -numeric::dot(taken.force, start_) / strength;
    const Scalar end = -numeric::dot(taken.force, reaction.velocity) / strength;
    const Scalar held = (start + end) / 2 * dt - taken.flow / (strength * share);
    step.after_break = dt - time_to_run(std::max(held, Scalar(0)) + travel, start, end, share, dt);
    state_.time -= step.after_break;
}

} // namespace ductile
