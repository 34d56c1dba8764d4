// SPDX-License-Identifier: MIT
//
// Picks the step from the motion, not from a scene-specific quantity such as a hammer's angle.
//
// The next step is the largest dt that
//   - turns no plastic hinge by more than `plastic_rotation` (nor stretches a bar by more than
//     `plastic_elongation`),
//   - lets no two parts about to touch close by more than `closing_fraction` of the thinner one's
//     thickness once they are near; while they are apart, by no more than `gap_fraction` of the gap,
//     so that the approach ends with small steps instead of one deep penetration,
//   - resolves the stiffest elastic part with `steps_per_period` steps,
//   - grows by no more than `growth` and shrinks by no more than `shrink` per step,
//   - stays within [min_step, max_step]: never past what the user allows.
// The last rule wins over all others, the growth limit over the wish; shrinking is limited only where
// `shrink` > 0.
//
// Source: replaces the rule of Nikula (2017), section 2.2.8. Criteria after the usual practice of
// explicit impact codes; the rotation criterion bounds the first-order error of turning contact
// normals and of the rigid-plastic row, both of which grow with rotation per step.
#pragma once

#include <algorithm>
#include <concepts>
#include <limits>
#include <string_view>

#include "ductile/vocabulary/check.hpp"

namespace ductile {

template <std::floating_point S>
struct StepControlParameters {
    S min_step = S(1e-6);           ///< shortest step [s], > 0
    S max_step = S(1.0 / 60);       ///< longest step [s], >= min_step
    S plastic_rotation = S(0.005);  ///< per step [rad], > 0; infinity: no limit
    S plastic_elongation = std::numeric_limits<S>::infinity(); ///< per step [m], > 0
    S closing_fraction = S(0.005);  ///< of the thickness, per step [-], in (0, 1]
    S gap_fraction = S(0.5);        ///< of the gap, per step [-], in (0, 1]
    S steps_per_period = S(20);     ///< for the stiffest elastic part [-], >= 2
    S growth = S(1.5);              ///< largest dt_next / dt [-], > 1
    S shrink = S(0);                ///< smallest dt_next / dt [-], in [0, 1); 0: no limit
};

/// What moves in the scene now. Leave out what does not apply: the defaults ask for nothing.
template <std::floating_point S>
struct SceneMotion {
    S plastic_rotation_rate = 0;   ///< fastest plastic hinge, |u| [rad/s]
    S plastic_elongation_rate = 0; ///< fastest plastic bar, |u| [m/s]
    S closing_speed = 0;           ///< of the nearest two parts, positive while they close [m/s]
    S gap = 0;                     ///< between them, <= 0 where they touch [m]
    S thickness = std::numeric_limits<S>::infinity(); ///< of the thinner one, along the motion [m]
    S elastic_frequency = 0;       ///< of the stiffest elastic part [Hz]
};

/// True where the parts named in `motion` close by more than the thickness of the thinner one in a
/// step of `dt` [s]: engines look for contacts between steps, and may miss that these ever met.
template <std::floating_point S>
[[nodiscard]] bool may_pass_through(const SceneMotion<S>& motion, S dt) noexcept {
    return motion.closing_speed * dt > std::max(motion.thickness, motion.gap);
}

/// Not thread-safe; O(1) and noexcept after construction.
template <std::floating_point S>
class StepControl {
  public:
    using Scalar = S;

    /// Starts from the longest step allowed.
    /// @throws std::invalid_argument where a parameter is out of range.
    explicit StepControl(const StepControlParameters<S>& parameters) : p_(parameters) {
        check::positive("StepControl.min_step", p_.min_step, "s");
        check::positive("StepControl.max_step", p_.max_step, "s");
        if (p_.max_step < p_.min_step) {
            check::fail("StepControl.max_step", p_.max_step, "s", "at least min_step");
        }
        check::positive_or_infinite("StepControl.plastic_rotation", p_.plastic_rotation, "rad");
        check::positive_or_infinite("StepControl.plastic_elongation", p_.plastic_elongation, "m");
        check_share("StepControl.closing_fraction", p_.closing_fraction);
        check_share("StepControl.gap_fraction", p_.gap_fraction);
        if (!(p_.steps_per_period >= 2)) {
            check::fail("StepControl.steps_per_period", p_.steps_per_period, "", ">= 2");
        }
        if (!(p_.growth > 1)) check::fail("StepControl.growth", p_.growth, "", "> 1");
        if (!(p_.shrink >= 0 && p_.shrink < 1)) {
            check::fail("StepControl.shrink", p_.shrink, "", "in [0, 1)");
        }
        step_ = p_.max_step;
    }

    [[nodiscard]] const StepControlParameters<S>& parameters() const noexcept { return p_; }
    /// The step last chosen [s].
    [[nodiscard]] S step() const noexcept { return step_; }

    /// The next step for a scene that moves like this [s].
    S next(const SceneMotion<S>& motion) noexcept {
        const S wish = std::min({limit(p_.plastic_rotation, motion.plastic_rotation_rate),
                                 limit(p_.plastic_elongation, motion.plastic_elongation_rate),
                                 limit(closing(motion), motion.closing_speed),
                                 limit(S(1), p_.steps_per_period * motion.elastic_frequency)});
        step_ = std::clamp(wish, p_.shrink * step_, p_.growth * step_);
        step_ = std::clamp(step_, p_.min_step, p_.max_step);
        return step_;
    }

  private:
    static void check_share(std::string_view field, S share) {
        if (!(share > 0 && share <= 1)) check::fail(field, share, "", "in (0, 1]");
    }

    /// Longest step over which something that moves at `rate` moves no more than `amount` [s].
    static S limit(S amount, S rate) noexcept {
        return rate > 0 ? amount / rate : std::numeric_limits<S>::infinity();
    }

    S closing(const SceneMotion<S>& motion) const noexcept {
        return std::max(p_.closing_fraction * motion.thickness, p_.gap_fraction * motion.gap);
    }

    StepControlParameters<S> p_;
    S step_ = 0;
};

template <std::floating_point S>
StepControl(const StepControlParameters<S>&) -> StepControl<S>;

} // namespace ductile
