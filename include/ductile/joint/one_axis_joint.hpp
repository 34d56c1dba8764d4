// SPDX-License-Identifier: MIT
//
// One rigid-plastic degree of freedom: a hinge that turns, or a bar that stretches, at a known
// moment or force and is rigid below it.
//
//   before the solve   prepare(motion, dt)   -> RowLimits
//   after the solve    commit(reaction, dt)  -> Step
//
// Symbols ("x | y": translational row | rotational row)
//   q, q_p  position and plastic rest position            [m | rad]
//   u, u'   velocity at the start and end of the step     [m/s | rad/s]
//   f       force of the row over the step, λ/dt          [N | N m]
//   R(p)    strength at the accumulated plastic travel p  [N | N m]
//   W       work the row took from the bodies             [J]
//
// Law. C = 0 and |f| <= R. Inside the bounds the row is rigid, and the target velocity removes drift
// towards q_p; at a bound it slips, which is plastic flow. The box-bounded row solved to convergence
// is the exact implicit rule, so nothing needs an iteration of our own.
//
// Account. With v' = v + M⁻¹(Jᵀλ + f_ext dt) the change of kinetic energy is exactly the sum over
// all rows and external forces of impulse × (u + u')/2. Hence W = -f dt (u + u')/2, exact at any dt,
// where M_p |Δθ| is first order only. Accumulated plastic travel is counted by the same rule,
// Δp = W / R, so that R p is the dissipated work and a break is invariant under the step.
//   Counted as plastic: steps at a bound, and the step that brings a flowing (or just now kicked) row
//   to rest inside the bounds: a force R acting until rest would do the very same work. Everything
//   else, such as the jitter of a solver below yield or drift being removed, is booked as
//   `other_work` and never consumes life.
//
// Break at the right energy. If the travel left, r, is less than the step would consume, the bounds
// are lowered before the solve so that the row does about R r of work. What it did in excess is
// returned as Step::release, for the adapter to hand back to the two bodies; with it the energy
// taken is R r at every dt. In isolation u'² = u² - 2 R r / m, exactly.
//
// Certificate. A solved row satisfies u' = b inside the bounds, u' <= b at the upper and u' >= b at
// the lower one. The violation of that is the residual; a step whose residual is large is reported
// as Outcome::unreliable instead of being passed off as physics. (A closed energy ledger proves
// nothing here: it closes in unconverged solves too.)
//
// Limit cases: R → ∞ rigid; R → 0 free; dt → 0 the continuous rigid-plastic law.
//
// Source: work-conjugate account and break derived here; row bounds as Nikula (2017), section 2.8.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <utility>

#include "ductile/fracture/travel_limit.hpp"
#include "ductile/law/law.hpp"
#include "ductile/law/perfect.hpp"
#include "ductile/vocabulary/check.hpp"
#include "ductile/vocabulary/row.hpp"

namespace ductile {

/// What one committed step did. Plain value.
template <std::floating_point S>
struct Step {
    Outcome outcome = Outcome::elastic;
    S plastic_work = 0; ///< dissipated by flow in this step, >= 0 [J]
    S other_work = 0;   ///< taken by the row without flow: solver residual, drift removal [J]
    S release = 0;      ///< taken in excess by the breaking step, to be handed back, >= 0 [J]
    S residual = 0;     ///< violation of the row's complementarity, >= 0 [m/s | rad/s]
};

/// Everything a joint remembers between steps. Plain value: copy, compare, save and restore it.
template <std::floating_point S>
struct OneAxisState {
    S plastic_offset = 0; ///< q_p, geometric rest position [m | rad]
    S plastic_travel = 0; ///< p, work-conjugate, never decreases [m | rad]
    S plastic_work = 0;   ///< D, never decreases [J]
    S other_work = 0;     ///< sum of Step::other_work, either sign [J]
    S start_velocity = 0; ///< u of the last step [m/s | rad/s]
    S velocity = 0;       ///< u' of the last step [m/s | rad/s]
    S residual_max = 0;   ///< largest residual so far [m/s | rad/s]
    bool flowing = false; ///< the last step ended at a bound
    bool broken = false;

    bool operator==(const OneAxisState&) const = default;
};

template <std::floating_point S>
struct OneAxisParameters {
    /// Time in which a holding row removes drift from q_p [s], > 0; five steps where that is longer. A
    /// time, not a share of each step: a share would turn the drift left by a long step into a
    /// kick in a short one.
    S drift_time = S(0.02);
    /// A step is unreliable where its residual exceeds this plus `relative_residual` × |velocity|
    /// [m/s | rad/s], > 0.
    S absolute_residual = S(1e-3);
    S relative_residual = S(1e-2); ///< [-], in [0, 1]
};

/// Not thread-safe: one joint belongs to one thread at a time. After construction nothing allocates
/// or throws, and both calls are O(1).
template <StrengthLaw Law>
class OneAxisJoint {
  public:
    using Scalar = typename Law::Scalar;
    using State = OneAxisState<Scalar>;

    /// @throws std::invalid_argument where a parameter is out of range.
    explicit OneAxisJoint(Law law, TravelLimit<Scalar> limit = {},
                          const OneAxisParameters<Scalar>& parameters = {})
        : law_(std::move(law)), limit_(std::move(limit)), parameters_(parameters) {
        check::positive("OneAxisJoint.drift_time", parameters.drift_time, "s");
        check::positive("OneAxisJoint.absolute_residual", parameters.absolute_residual,
                        "m/s or rad/s");
        check::between("OneAxisJoint.relative_residual", parameters.relative_residual, Scalar(0),
                       Scalar(1), "", true);
    }

    [[nodiscard]] const Law& law() const noexcept { return law_; }
    [[nodiscard]] const TravelLimit<Scalar>& limit() const noexcept { return limit_; }
    [[nodiscard]] const State& state() const noexcept { return state_; }
    void restore(const State& state) noexcept { state_ = state; }

    /// Strength at the present plastic travel [N | N m].
    [[nodiscard]] Scalar strength() const noexcept { return law_.value(state_.plastic_travel); }
    /// Plastic travel left before the break; infinity where there is no limit. [m | rad]
    [[nodiscard]] Scalar remaining() const noexcept { return limit_.remaining(state_.plastic_travel); }

    /// Rules the row for a step of `dt` > 0 [s] that starts with `motion`. A broken joint asks for no
    /// force at all.
    [[nodiscard]] RowLimits<Scalar> prepare(const Motion<Scalar>& motion, Scalar dt) noexcept {
        start_ = motion.velocity;
        if (state_.broken) return {.lower = 0, .upper = 0};
        strength_ = midpoint_strength(motion.velocity, dt);
        bound_ = strength_ * unspent_fraction(motion.velocity, dt);
        bias_ = (state_.plastic_offset - motion.position) / std::max(parameters_.drift_time, 5 * dt);
        return {.lower = -bound_, .upper = bound_, .bias = bias_, .compliance = 0};
    }

    /// Books the step that `prepare` opened; same `dt` [s].
    Step<Scalar> commit(const Reaction<Scalar>& reaction, Scalar dt) noexcept {
        Step<Scalar> step;
        if (state_.broken) {
            step.outcome = Outcome::broken;
            return step;
        }
        const Scalar work = -reaction.force * dt * (start_ + reaction.velocity) / 2;
        const bool at_bound = std::abs(reaction.force) >= bound_ * (1 - bound_tolerance);
        const bool flows = at_bound || state_.flowing || kicked();
        (flows && work > 0 ? step.plastic_work : step.other_work) = work;

        if (step.plastic_work > 0) flow(step, reaction.position);
        certify(step, reaction, at_bound);

        state_.plastic_work += step.plastic_work;
        state_.other_work += step.other_work;
        state_.start_velocity = start_;
        state_.velocity = reaction.velocity;
        state_.flowing = at_bound;
        if (state_.broken) {
            step.outcome = Outcome::broken;
        } else if (step.residual > tolerance(reaction.velocity)) {
            step.outcome = Outcome::unreliable;
        } else if (step.plastic_work > 0 &&
                   (at_bound || std::abs(start_) > parameters_.absolute_residual)) {
            step.outcome = Outcome::yielding; // and not the round-off of a flow that has stopped
        }
        return step;
    }

  private:
    /// A force this close to its bound is at it; wider than the round-off of λ/dt in float.
    static constexpr Scalar bound_tolerance = Scalar(4e-6);
    /// Less travel than this fraction of the limit counts as used up.
    static constexpr Scalar exhausted = 16 * std::numeric_limits<Scalar>::epsilon();

    /// R half a step ahead, which keeps a hardening law second order.
    Scalar midpoint_strength(Scalar velocity, Scalar dt) const noexcept {
        return law_.value(state_.plastic_travel + std::abs(velocity) * dt / 2);
    }

    /// Share of the full strength that uses up the travel left in this step, in (0, 1]. The travel of
    /// the step is predicted from below, so that a step that can break does break: with the
    /// deceleration of the last step where the row flowed in it, else with a stop inside this one.
    Scalar unspent_fraction(Scalar velocity, Scalar dt) const noexcept {
        const Scalar speed = std::abs(velocity);
        const Scalar lost = std::max(std::abs(state_.start_velocity) - speed, Scalar(0));
        const Scalar slowed = state_.flowing ? std::max(speed - lost, Scalar(0)) : Scalar(0);
        const Scalar travel = (speed + slowed) / 2 * dt;
        const Scalar left = remaining();
        return left < travel ? left / travel : Scalar(1);
    }

    /// True where somebody changed the velocity between the steps, well above solver noise.
    bool kicked() const noexcept { return std::abs(start_ - state_.velocity) > tolerance(start_); }

    Scalar tolerance(Scalar velocity) const noexcept {
        const Scalar speed = std::max(std::abs(start_), std::abs(velocity));
        return parameters_.absolute_residual + parameters_.relative_residual * speed;
    }

    void flow(Step<Scalar>& step, Scalar position) noexcept {
        const Scalar left = remaining();
        const Scalar travel = step.plastic_work / strength_;
        if (travel >= left * (1 - exhausted)) {
            step.release = std::max(step.plastic_work - strength_ * left, Scalar(0));
            step.plastic_work -= step.release;
            state_.plastic_travel = limit_.limit();
            state_.broken = true;
        } else {
            state_.plastic_travel += travel;
        }
        state_.plastic_offset = position;
    }

    void certify(Step<Scalar>& step, const Reaction<Scalar>& reaction, bool at_bound) noexcept {
        const Scalar excess = reaction.velocity - bias_;
        if (!at_bound) {
            step.residual = std::abs(excess);
        } else {
            step.residual = std::max(reaction.force > 0 ? excess : -excess, Scalar(0));
        }
        state_.residual_max = std::max(state_.residual_max, step.residual);
    }

    Law law_;
    TravelLimit<Scalar> limit_;
    OneAxisParameters<Scalar> parameters_;
    State state_;

    // between prepare and commit
    Scalar start_ = 0;
    Scalar bound_ = 0;
    Scalar strength_ = 0;
    Scalar bias_ = 0;
};

} // namespace ductile
