// SPDX-License-Identifier: MIT
//
// What every plastic joint adds up, and what every step of one says, whatever its law and its
// number of axes: what a world, a ledger or a link reads of a joint without knowing which it is.
#pragma once

#include <concepts>
#include <limits>

#include "ductile/vocabulary/row.hpp"

namespace ductile {

/// What one committed step did. Plain value. The work that the rows took from the bodies is
///   plastic_work + elastic + damped + other_work + release + lost [J].
template <std::floating_point S>
struct Step {
    Outcome outcome = Outcome::elastic;
    bool first_yield = false; ///< the joint began to yield in this step
    bool fracture = false;    ///< it broke in this step: fracture() of the joint reports how
    S plastic_work = 0;       ///< dissipated by flow, >= 0 [J]
    S elastic = 0;            ///< change of what is stored, elastic and by a back force [J]
    S damped = 0;             ///< taken by the material's damping, either sign within a swing [J]
    S other_work = 0;  ///< solver residual, drift removal, numerical damping; either sign [J]
    S release = 0;     ///< taken in excess by a breaking step, to be handed back, >= 0 [J]
    S lost = 0;        ///< stored energy that a break set free inside the part, >= 0 [J]
    S after_break = 0; ///< time of the step that was left when it broke, >= 0 [s]
    S held = 0;        ///< time of the step until it broke; 0: it did not [s]
    S run = 0;         ///< way of its one axis until then, >= 0 [m | rad]
    S misfit = 0;      ///< of a flow's work, that its law would not have taken, >= 0 [J]
    S claimed = 0;     ///< flow as this joint sees it (work_share.hpp), >= 0 [J]
    S unclaimed = 0;   ///< work of its rows that did not flow, either sign [J]
    S gained = 0; ///< given to the bodies beyond all that was taken from them so far, where that
                  ///< is too much to be believed (step_end.hpp), >= 0 [J]
    /// Largest violation of a row's complementarity, >= 0; infinite: an input was not finite, and
    /// the step was not booked [m/s | rad/s].
    S residual = 0;
    S step_error =
        0; ///< share of the plastic travel that steps may have misplaced (step_error.hpp)
    bool coarse = false; ///< the flow that ended in this step had steps too long for it
};

/// What a joint says of a step in which an input was not finite. Its state stays as it was.
template <class Step>
[[nodiscard]] Step unbooked_step() noexcept {
    Step step;
    step.outcome = Outcome::unreliable;
    step.residual = std::numeric_limits<decltype(step.residual)>::infinity();
    return step;
}

/// The part of a joint's state that does not depend on its law or its number of axes. Plain value.
template <std::floating_point S>
struct JointTotals {
    S plastic_travel = 0; ///< p, work-conjugate or equivalent, never decreases [m | rad]
    S plastic_work = 0;   ///< D, never decreases [J]
    S stored = 0;         ///< elastic energy, and what a back force holds [J]
    S damped = 0;         ///< taken by the material's damping [J]
    S other_work = 0;     ///< sum of Step::other_work, either sign [J]
    S lost = 0;           ///< stored energy that the break set free [J]
    S residual_max = 0;   ///< largest residual so far [m/s | rad/s]
    S misplaced = 0;      ///< travel that the steps' length may have misplaced, summed [m | rad]
    double time = 0; ///< sum of dt until now or until the break [s]; a float would stop counting
    bool flowing = false; ///< a row ended the last step at its bound
    bool broken = false;

    bool operator==(const JointTotals&) const = default;
};

} // namespace ductile
