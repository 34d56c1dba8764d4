// SPDX-License-Identifier: MIT
//
// The cheapest model of a joint that keeps a tolerance: its detail and the step together. For scene
// building, not for the inner loop: it allocates, and rehearses each axis at a few hundred steps.
//
// joint_detail.hpp says what a given step can do. Here the step is free up to a longest one, and
// what is sought is the longest with which the errors of detail and step together stay within the
// tolerance:
//   1. axes that do not yield are rigid (joint_detail.hpp, rule 1) and do not ask for a step;
//   2. an axis that yields is rehearsed (rehearsal.hpp) without and, where it has a stiffness, with
//      its elastic part. Without is cheaper unless with it the step may be longer by more than an
//      elastic row costs, `elastic_cost`. It has to be resolved by the mass that the row feels,
//      that of the joint's own bodies where something strikes them;
//   3. the joint takes the shortest of its axes' steps.
// A share `reserve` of the tolerance is kept for what a rehearsal of single axes cannot know: other
// joints, and the scene's geometry.
//
// Limit cases: tolerance → 1 the longest step; nothing yields: rigid, the longest step; k → ∞
// rigid-plastic; a break: its energy is right at any step, so the longest one will do where the
// elastic part does not matter.
//
// An axis whose event is not known cannot be rehearsed: it keeps the choice of joint_detail.hpp at
// the longest step, and its error is told as not known.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <numbers>
#include <string>

#include "ductile/fidelity/joint_detail.hpp"
#include "ductile/fidelity/rehearsal.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile {

template <std::floating_point S>
struct ModelParameters {
    S reserve = S(0.05); ///< share of the tolerance that is not used [-], in [0, 1)
    /// What a step of an elastic joint costs over one of a rigid-plastic one [-], >= 1; 1.2 to 1.35
    /// was measured for single joints in Bullet and ODE.
    S elastic_cost = S(1.3);
};

template <std::floating_point S>
struct ModelChoice {
    JointDetail<S> joint; ///< errors are those of detail and step together
    S dt = 0;             ///< [s]
    S error = 0; ///< largest of the axes' [-]; infinity: not known, or beyond the tolerance

    /// One line for the step and one per axis.
    [[nodiscard]] std::string reason() const {
        return "dt " + detail_choice::number(dt) + " s\n" + joint.reason();
    }
};

namespace detail_choice {

/// The better of the two details for one axis that yields.
template <std::floating_point S>
StepFit<S> fit_axis(const AxisSystem<S>& system, const AxisEvent<S>& event, S target, S longest,
                    S steps_per_period, S elastic_cost, AxisChoice<S>& choice) {
    AxisSystem<S> rigid = system;
    rigid.stiffness = std::numeric_limits<S>::infinity();
    const PeakResponse<S> exact = peak_response(system, event);
    const S ignored = response_error(exact, peak_response(rigid, event));
    const StepFit<S> without = choose_step(rigid, event, exact, target, longest);
    StepFit<S> with;
    if (!std::isinf(system.stiffness)) {
        const S felt = event.own_mass > 0 ? event.own_mass : system.mass;
        const S period = 2 * std::numbers::pi_v<S> * std::sqrt(felt / system.stiffness);
        with =
            choose_step(system, event, exact, target, std::min(longest, period / steps_per_period));
        choice.steps_per_period = with.dt > 0 ? period / with.dt : choice.steps_per_period;
    }
    const bool elastic = with.dt > elastic_cost * without.dt;
    const StepFit<S>& fit = elastic ? with : without;
    choice.detail = elastic ? AxisDetail::elastic_plastic : AxisDetail::rigid_plastic;
    choice.error = fit.error;
    if (fit.dt == 0) {
        choice.reason = "no step leaves an error of " + percent(target) + " or less";
    } else if (elastic) {
        choice.reason = "elasticity changes the answer by " + percent(ignored) + "; with it " +
                        number(choice.steps_per_period) + " steps per period leave " +
                        percent(fit.error);
    } else {
        choice.reason = "elasticity changes the answer by " + percent(ignored) +
                        ", with the step's own error " + percent(fit.error);
    }
    return fit;
}

} // namespace detail_choice

/// `p.dt`: the longest step.
/// @throws std::invalid_argument where a parameter is missing or out of range.
template <std::floating_point S>
[[nodiscard]] ModelChoice<S> choose_model(const JointDetailParameters<S>& p,
                                          const ModelParameters<S>& by = {}) {
    using namespace detail_choice;
    constexpr S infinity = std::numeric_limits<S>::infinity();
    if (by.reserve != S(0)) check::between("Model.reserve", by.reserve, S(0), S(1), "");
    if (!(by.elastic_cost >= 1)) check::fail("Model.elastic_cost", by.elastic_cost, "", ">= 1");
    const auto systems = checked_axes(p);
    const S target = p.tolerance * (1 - by.reserve);
    ModelChoice<S> model{.joint = choose_detail(p), .dt = p.dt};
    const auto fit = [&](std::size_t i) {
        return fit_axis(systems[i], *p.event[i], target, model.dt, p.steps_per_period,
                        by.elastic_cost, model.joint.axis[i]);
    };
    S shortest = p.dt;
    for (std::size_t i = 0; i < 6; ++i) {
        if (model.joint.axis[i].detail == AxisDetail::rigid || !p.event[i]) continue;
        if (const S dt = fit(i).dt; dt > 0) shortest = std::min(shortest, dt);
    }
    model.dt = shortest;
    for (std::size_t i = 0; i < 6; ++i) {
        AxisChoice<S>& axis = model.joint.axis[i];
        if (axis.detail == AxisDetail::rigid) continue;
        // with the shorter step of another axis the elastic part may not be needed any more
        if (p.event[i] && axis.detail == AxisDetail::elastic_plastic) (void)fit(i);
        model.error = p.event[i] ? std::max(model.error, axis.error) : infinity;
    }
    return model;
}

} // namespace ductile
