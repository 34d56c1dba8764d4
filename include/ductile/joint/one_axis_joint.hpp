// SPDX-License-Identifier: MIT
//
// One plastic degree of freedom: a hinge that turns, or a bar that stretches, at a known moment or
// force; below it rigid or elastic.
//
//   before the solve   prepare(motion, dt)   -> RowLimits
//   after the solve    commit(reaction, dt)  -> Step
//
// Symbols ("x | y": translational row | rotational row)
//   q, q_p  position and plastic rest position                [m | rad]
//   q_e     elastic part, q - q_p                             [m | rad]
//   u, u'   velocity at the start and end of the step         [m/s | rad/s]
//   f       force of the row over the step, λ/dt              [N | N m]
//   R       strength: bound of |f|, from the law and its state [N | N m]
//   k       stiffness; infinite: rigid                        [N/m | N m/rad]
//   W       work the row took from the bodies                 [J]
//
// Rigid row. C = 0 and |f| <= R. Inside the bounds the row is rigid, and the target velocity
// removes drift towards q_p; at a bound it slips, which is plastic flow: solved, it is the exact
// implicit rule.
//
// Elastic row. The spring of elastic_row.hpp inside the same bounds. After the solve q_e is what
// the yield range allows; the rest of the observed displacement is plastic. k → ∞ is the rigid row.
//
// Account. With v' = v + M⁻¹(Jᵀλ + f_ext dt) the change of kinetic energy is exactly the sum over
// all rows and external forces of impulse × (u + u')/2. Hence W = -f dt (u + u')/2, exact at any
// dt, where M_p |Δθ| is first order only. Plastic travel is counted by the same rule: a break is
// invariant.
//   Counted as plastic: steps that flow, and the step that brings a flowing (or just now jumped)
//   rigid row to rest inside the bounds: a force R acting until rest would do the very same work.
//   Everything else (jitter below yield, drift removed, numerical damping) is `other_work` and
//   consumes no life.
//
// Break at the right energy. If the travel left, r, is less than the step would consume, the bounds
// are lowered before the solve so that the row does about R r of work. What it did in excess is
// returned as Step::release, to be handed back to the two bodies: the energy taken is R r at every
// dt. In isolation u'² = u² - 2 R r / m. A brittle break, where a cap on the force is reached
// before yield, absorbs nothing and releases all the work of its step. What was stored is set free
// inside: Step::lost.
//
// Certificate. A solved row satisfies u' + Cλ = b inside the bounds, <= b at the upper and >= b at
// the lower one. The violation of that is the residual; where it is large the step is unreliable,
// and so is one that gives energy never taken (step_end.hpp). (A closed ledger proves nothing: it
// closes in both.)
//
// Source: work-conjugate account and break derived here; row bounds as Nikula (2017), section 2.8.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "ductile/fracture/event.hpp"
#include "ductile/fracture/fracture.hpp"
#include "ductile/fracture/travel_limit.hpp"
#include "ductile/joint/elastic_row.hpp"
#include "ductile/joint/flow_range.hpp"
#include "ductile/joint/one_axis_state.hpp"
#include "ductile/joint/remaining_travel.hpp"
#include "ductile/joint/step_end.hpp"
#include "ductile/law/cyclic.hpp"
#include "ductile/law/hardening.hpp"
#include "ductile/law/law.hpp"
#include "ductile/law/perfect.hpp"
#include "ductile/vocabulary/finite.hpp"
#include "ductile/vocabulary/row.hpp"

namespace ductile {

/// Not thread-safe. After construction nothing allocates or throws, and both calls are O(1).
template <class Law, FractureCriterion Criterion = TravelLimit<typename Law::Scalar>>
requires CyclicLaw<typename CyclicForm<Law>::type>
class OneAxisJoint {
  public:
    using Scalar = typename Law::Scalar;
    using Cyclic = typename CyclicForm<Law>::type;
    using State = OneAxisState<Scalar, typename Cyclic::State, typename Criterion::State>;
    using Parameters = OneAxisParameters<Scalar>;
    using Reaction = ductile::Reaction<Scalar>;

    /// @throws std::invalid_argument where a parameter is out of range.
    explicit OneAxisJoint(Law law, Criterion criterion = Criterion(), Parameters parameters = {})
        : law_(Cyclic(std::move(law))), criterion_(std::move(criterion)), parameters_(parameters) {
        parameters_.validate();
    }

    [[nodiscard]] const Cyclic& law() const noexcept { return law_; }
    [[nodiscard]] const Criterion& criterion() const noexcept { return criterion_; }
    [[nodiscard]] const Parameters& parameters() const noexcept { return parameters_; }
    [[nodiscard]] const State& state() const noexcept { return state_; }
    void restore(const State& state) noexcept { state_ = state; }
    /// The velocity that the step left, seen along the axis as it is now: not a jump [m/s | rad/s].
    void carry(Scalar u) noexcept { state_.velocity = are_finite(u) ? u : state_.velocity; }

    /// Force at which the row would flow now, or snap, towards `direction` = ±1 [N | N m].
    [[nodiscard]] Scalar strength(Scalar direction = 1) const noexcept {
        const Scalar flows = std::abs(law_.resistance(state_.law, Scalar(0), direction)) *
                             criterion_.strength_factor(state_.criterion, Scalar(0));
        return std::min(flows, criterion_.force_cap(state_.criterion, -direction));
    }
    /// It snaps before it flows.
    [[nodiscard]] bool snaps() const noexcept {
        const Scalar cap = std::min(this->cap(1), this->cap(-1));
        return cap <= std::min(strength(1), strength(-1));
    }
    /// Share of its strength that the row uses while it pushes its bodies with `force`; 1 where it
    /// flows, 0 where broken. Beyond the strength a back force makes it flow back [-].
    [[nodiscard]] Scalar utilisation(Scalar force) const noexcept {
        const Scalar way = force > 0 ? Scalar(-1) : Scalar(1), held = std::abs(force);
        const Scalar ahead = strength(way);
        if (state_.broken || !(ahead > 0)) return 0;
        const bool pushed = way * law_.resistance(state_.law, Scalar(0), -way) > 0;
        return pushed ? std::max(held / ahead, strength(-way) / held) : held / ahead;
    }
    /// Share of life used, in [0, 1]; 1 exactly where broken.
    [[nodiscard]] Scalar damage() const noexcept {
        return state_.broken ? Scalar(1) : criterion_.damage(state_.criterion);
    }
    /// What broke the joint, or is the nearest to do so.
    [[nodiscard]] CriterionKind governing() const noexcept {
        return state_.broken && faded(law_, state_.plastic_travel)
                   ? CriterionKind::exhausted_strength
                   : criterion_.governing(state_.criterion);
    }
    /// How the joint broke; nothing while it is intact.
    [[nodiscard]] std::optional<FractureEvent<Scalar>> fracture() const noexcept {
        if (!state_.broken) return std::nullopt;
        return FractureEvent<Scalar>{.criterion = governing(),
                                     .time = state_.time,
                                     .plastic_travel = state_.plastic_travel,
                                     .absorbed_energy = state_.plastic_work,
                                     .released_energy = state_.lost,
                                     .force = state_.force};
    }

    /// Rules the row for a step of `dt` > 0 [s]; none once broken, or where `motion` is not finite.
    [[nodiscard]] RowLimits<Scalar> prepare(const Motion<Scalar>& motion, Scalar dt) noexcept;

    /// Books the step that `prepare` opened; same `dt` [s]. `granted`: of its flow
    /// (work_share.hpp). Not finite: see Step::residual.
    Step<Scalar> commit(const Reaction& reaction, Scalar dt, Scalar granted = 1) noexcept;

  private:
    using Taken = RowTaken<Scalar>;

    /// A force this close to its bound is at it; wider than the round-off of λ/dt in float.
    static constexpr Scalar bound_tolerance = Scalar(4e-6);

    [[nodiscard]] bool rigid() const noexcept { return std::isinf(parameters_.stiffness); }

    /// True where the force of an elastic row was given, not solved for.
    [[nodiscard]] bool given() const noexcept { return given_; }
    [[nodiscard]] Scalar cap(Scalar sign) const noexcept {
        return criterion_.force_cap(state_.criterion, sign);
    }
    /// The bounds of the row's force for this step.
    void bound(Scalar dt) noexcept {
        const Scalar fading = travel_to_nothing(law_, state_.plastic_travel);
        const Scalar direction = std::copysign(Scalar(1), start_), speed = std::abs(start_);
        const Scalar least = travel_ahead(speed, std::abs(state_.start_velocity),
                                          std::abs(state_.velocity), state_.flowing, dt);
        const bool fades = ExhaustibleLaw<Law> || // where a slope may be steep
                           criterion_.strength_factor(state_.criterion, speed * dt) < 1;
        const Scalar ahead = std::min(fades && state_.flowing ? least : speed * dt, fading);
        const Scalar travel = std::max(ahead, parameters_.absolute_residual * dt);
        const auto loss = [&](Scalar way) noexcept {
            auto state = state_.law;
            return faded_over(direction * way) * law_.commit(state, direction * way).dissipated /
                   way;
        };
        left_ = std::min(travel_to_break(criterion_, state_.criterion, travel, direction, loss),
                         fading);
        const Scalar way = direction * std::min(ahead, left_); // beyond it there is no strength
        fade_ = faded_over(way);
        flow_ = {law_.prepare(state_.law, way)};
        flow_ = {{flow_.lower * fade_, flow_.upper * fade_}};
        share_ = unspent_share(left_, least);
        upper_ = std::min(-flow_.lower * share_, cap(1));
        lower_ = std::max(-flow_.upper * share_, -cap(-1));
        tolerance_ = bound_tolerance * std::max(std::abs(upper_), std::abs(lower_));
    }

    /// Of the strength over a flow of the signed travel, what the criterion leaves [-].
    [[nodiscard]] Scalar faded_over(Scalar travel) const noexcept {
        const Scalar direction = std::copysign(Scalar(1), travel);
        const auto at = [&](Scalar way) noexcept {
            return std::abs(law_.resistance(state_.law, way, direction));
        };
        return mean_factor(criterion_, state_.criterion, std::abs(travel), at);
    }

    /// A spring that reaches its strength within the part has less than that at the mean: by
    /// k gap²/2 of the work of the way |u| dt.
    void reach_strength(Scalar dt) noexcept {
        const Scalar way = std::abs(start_) * dt, direction = std::copysign(Scalar(1), start_);
        Scalar& bound = start_ < 0 ? upper_ : lower_;
        if (std::abs(bound) == cap(-direction)) return; // where it snaps
        const Scalar k = parameters_.stiffness;
        const Scalar gap = -direction * (bound / k + elastic_);
        if (gap > 0 && gap < way) bound += direction * k * gap * gap / (2 * way);
    }

    /// True where somebody changed the velocity between the steps, well above solver noise.
    [[nodiscard]] bool jumped() const noexcept {
        return std::abs(start_ - state_.velocity) > allowed_residual(start_) + turning_;
    }
    [[nodiscard]] Scalar allowed_residual(Scalar velocity) const noexcept {
        const Scalar speed = std::max(std::abs(start_), std::abs(velocity));
        return parameters_.absolute_residual + parameters_.relative_residual * speed;
    }

    [[nodiscard]] Scalar violation(const Reaction& reaction, const Taken& taken) const noexcept {
        if (given()) return 0;
        const Scalar soft = compliance_ * reaction.force * taken.dt;
        return taken.violation(reaction.velocity + soft - bias_);
    }

    [[nodiscard]] auto error_of(const Step<Scalar>& step, const Taken& taken) const noexcept {
        // of parts the frame is the judge; one that holds misplaces nothing
        if (ahead_ || (rigid() && !(step.plastic_work > 0))) return StepError<Scalar>{};
        return step_error<Scalar>({.force = taken.force,
                                   .start = start_,
                                   .travel = taken.travel,
                                   .dt = taken.dt,
                                   .noise = parameters_.absolute_residual,
                                   .strength = flow_.resistance(taken.travel),
                                   .stiffness = parameters_.stiffness,
                                   .implicit = implicit_,
                                   .other_work = step.other_work,
                                   .flowed = step.plastic_work > 0});
    }
    /// That of the parameters; of a spring the travel that takes the energy it holds at yield.
    [[nodiscard]] Scalar least_travel() const noexcept {
        if (rigid()) return parameters_.least_travel;
        return std::max(flow_.resistance(1), flow_.resistance(-1)) / (2 * parameters_.stiffness);
    }

    /// The force at which the row snapped, where it reached a cap before it could yield; else zero.
    [[nodiscard]] Scalar snapped(const Taken& taken) const noexcept;

    /// Breaks without flow, at `force`: what the row took beyond its elastic energy is handed back.
    void snap(Step<Scalar>& step, const Taken& taken, Scalar force) noexcept;

    /// What the solver left undone is nobody's flow: no travel, no life, no break.
    void commit_unsolved(Step<Scalar>& step, const Taken& taken) noexcept {
        if (!rigid()) {
            const Scalar k = parameters_.stiffness, trial = taken.position - state_.plastic_offset;
            const Scalar beyond = spring_slip(law_, state_.law, k, fade_, trial);
            const Scalar strained = trial - beyond;
            state_.plastic_offset += beyond; // a spring holds no more than at yield
            step.elastic = k * (strained * strained - elastic_ * elastic_) / 2;
        }
        step.other_work = taken.work - step.elastic;
    }
    void commit_rigid(Step<Scalar>& step, const Taken& taken) noexcept {
        const Scalar direction = std::copysign(Scalar(1), taken.travel);
        const bool stops = !taken.at_bound() && taken.work > 0 && (state_.flowing || jumped());
        if (flows_with_bound(taken)) {
            flow(step, taken, taken.work, taken.travel * share_);
        } else if (stops) {
            flow(step, taken, taken.work, direction * taken.work / flow_.resistance(direction));
        } else {
            step.other_work = taken.work;
        }
        // a row at its bound moved as it liked, also where it turned round within the step
        if (taken.at_bound() || stops) state_.plastic_offset = taken.position;
    }

    /// At a bound, and moving the way that bound resists.
    [[nodiscard]] static bool flows_with_bound(const Taken& taken) noexcept {
        return (taken.at_lower && taken.travel > 0) || (taken.at_upper && taken.travel < 0);
    }

    void commit_elastic(Step<Scalar>& step, const Taken& taken) noexcept {
        const Scalar k = parameters_.stiffness;
        const Scalar trial = taken.position - state_.plastic_offset;
        const Scalar slipped = spring_slip(law_, state_.law, k, fade_, trial);
        const Scalar strained = trial - slipped;
        step.elastic = k * (strained * strained - elastic_ * elastic_) / 2;
        const Scalar direction = std::copysign(Scalar(1), slipped != 0 ? slipped : taken.travel);
        const Scalar strength = flow_.resistance(direction);
        step.damped = spring_.damped(taken.velocity, slipped, strained, taken.dt);
        if (taken.at_bound()) { // the damper has what the spring and the flow leave of the strength
            const Scalar left = taken.work - step.elastic - strength * std::abs(slipped);
            step.damped = std::min(step.damped, std::max(left, Scalar(0)));
        }
        const Scalar rest = taken.work - step.elastic - step.damped;
        if (slipped != 0) {
            // the geometry of a symplectic row is second order, the work of an implicit one is the
            // better account, in between as the row itself; a law that rests by itself has its own
            state_.plastic_offset += slipped;
            Scalar share = RestsByItself<Cyclic> ? Scalar(0) : ahead_ ? Scalar(1) : implicit_;
            if constexpr (!StrengthLaw<Law> && !RestsByItself<Cyclic>) {
                const Scalar range = (flow_.upper - flow_.lower) / (2 * k);
                if (!ahead_) share = work_share(implicit_, range, slipped);
            }
            const Scalar moved = taken.travel - (strained - elastic_); // what the spring left
            const bool told = flow_.told_by_work(direction, tolerance_);
            const Scalar by_work = std::max(told ? rest / strength : direction * moved, Scalar(0));
            flow(step, taken, rest,
                 direction * ((1 - share) * std::abs(slipped) + share * by_work));
        } else if (stopped_in_step(taken)) {
            // a row too stiff for the step: what the yield range cannot hold was flow
            const Scalar yield = strength * strength / (2 * k);
            const Scalar room = std::max(yield - k * elastic_ * elastic_ / 2, Scalar(0));
            const Scalar excess =
                std::max(taken.work - room, Scalar(0)) * (ahead_ ? Scalar(1) : implicit_);
            flow(step, taken, excess, direction * excess / strength);
            step.other_work += rest - excess;
        } else {
            step.other_work = rest;
        }
    }

    /// An implicit row that came to rest inside its bounds after flow or a jump.
    [[nodiscard]] bool stopped_in_step(const Taken& taken) const noexcept {
        return !RestsByItself<Cyclic> && !given() && !taken.at_bound() && taken.work > 0 &&
               (state_.flowing || jumped());
    }

    /// Flows by the signed `travel`, for which `work` was taken; breaks where no more is left.
    void flow(Step<Scalar>& step, const Taken& taken, Scalar work, Scalar travel) noexcept {
        if (travel == 0) {
            step.other_work = work;
            return;
        }
        step.claimed = solved_share() * std::max(work, Scalar(0));
        const Scalar booked = 1 - solved_share() * (1 - taken.granted);
        const bool spent = share_ < carries_nothing<Scalar> && uses_up(std::abs(travel), left_);
        travel *= booked;
        const bool last = spent || uses_up(std::abs(travel), left_);
        if (last) travel = std::copysign(std::min(std::abs(travel), left_), travel);
        const Scalar faded_by = faded_over(travel);
        const FlowWork<Scalar> done = law_.commit(state_.law, travel);
        step.plastic_work = done.dissipated * fade_;
        step.elastic += done.stored * fade_;
        state_.plastic_travel += std::abs(travel);
        criterion_.update(state_.criterion, {travel, state_.plastic_travel, taken.force,
                                             step.plastic_work, taken.dt});
        const Scalar rest = booked * work - step.plastic_work - done.stored * fade_;
        state_.broken =
            last || criterion_.broken(state_.criterion) || faded(law_, state_.plastic_travel);
        if (state_.broken) step.release = std::max(rest, Scalar(0));
        step.misfit = std::abs(rest - step.release) + std::abs(faded_by - fade_) * done.dissipated;
        step.other_work = rest - step.release + (1 - booked) * work;
    }

    /// θ; a law that rests by itself has its own account.
    [[nodiscard]] Scalar solved_share() const noexcept {
        return rigid() ? Scalar(1) : RestsByItself<Cyclic> ? Scalar(0) : implicit_;
    }

    /// Puts time and force of the state to the break, the step being booked as a whole by `settle`.
    void place_break(Step<Scalar>& step, const Taken& taken) noexcept {
        const bool flowed = step.plastic_work > 0;
        const Scalar direction = std::copysign(Scalar(1), flowed ? taken.travel : -state_.force);
        if (flowed) state_.force = -law_.resistance(state_.law, Scalar(0), direction) * fade_;
        Scalar distance = flowed ? left_ : Scalar(0); // a rigid row is loaded from the start
        if (!rigid()) {
            const Scalar stretch = std::abs(state_.force) / parameters_.stiffness;
            distance += std::max(stretch - direction * elastic_, Scalar(0));
        }
        const Scalar velocity = 2 * taken.travel / taken.dt - start_;
        step.after_break =
            taken.dt - time_to_run(distance, direction * start_, direction * velocity,
                                   flowed ? share_ : Scalar(1), taken.dt);
        step.held = taken.dt - step.after_break;
        step.run = distance;
        state_.time -= step.after_break;
    }

    Cyclic law_;
    Criterion criterion_;
    Parameters parameters_;
    State state_;

    // between prepare and commit
    bool sound_ = true;                ///< the input of `prepare` was finite
    Scalar bias_ = 0, compliance_ = 0; ///< b, C
    Scalar start_ = 0, elastic_ = 0;   ///< u, q_e at the start
    SpringRow<Scalar> spring_{};       ///< of an elastic row
    bool given_ = false;               ///< its force is
    FlowRange<Scalar> flow_{};         ///< forces along the flow at which it flows back and forth
    Scalar lower_ = 0, upper_ = 0,
           tolerance_ = 0;           ///< bounds of the row's force, how near is at them
    Scalar fade_ = 1, implicit_ = 1; ///< strength factor of the criterion; θ of an elastic row
    Scalar left_ = 0,
           share_ = 1;   ///< travel left before a break; of the strength, what bounds allow
    bool ahead_ = false; ///< Motion::ahead
    Scalar turning_ = 0, drift_ = 0; ///< Motion's
};
} // namespace ductile

#include "ductile/joint/one_axis_joint.ipp" // IWYU pragma: export
