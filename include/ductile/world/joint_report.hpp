// SPDX-License-Identifier: MIT
//
// What a joint of any kind and engine says of the step just done, and what a world makes of it.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "ductile/fracture/event.hpp"
#include "ductile/vocabulary/row.hpp"

namespace ductile {

/// Plain value, of one joint after one step.
template <std::floating_point S>
struct JointReport {
    Outcome outcome = Outcome::elastic;
    bool first_yield = false; ///< it flowed in this step for the first time
    bool coarse = false;      ///< the flow that ended had steps too long for it: step_error.hpp
    S residual = 0;           ///< worst violation of any of its rows, >= 0 [m/s | rad/s]
    S plastic_travel = 0;     ///< p [m | rad]
    S absorbed_energy = 0;    ///< D [J]
    S step_error = 0;         ///< share of p that the steps so far may have misplaced [-]
    /// Speed now of the fastest axis that can flow, 0 once broken, >= 0.
    S rotation_rate = 0;                        ///< of rotations [rad/s]
    S elongation_rate = 0;                      ///< of displacements [m/s]
    std::optional<FractureEvent<S>> fracture{}; ///< once it is broken
};

/// Report of a joint of the core after a step of it.
/// @param outcome         of all rows, rigid ones included
/// @param rigid_residual  worst of the rigid rows [m/s | rad/s]
template <class Joint, class Step>
[[nodiscard]] JointReport<typename Joint::Scalar> joint_report(
    const Joint& joint, const Step& last, Outcome outcome,
    typename Joint::Scalar rigid_residual) noexcept {
    return {.outcome = outcome,
            .first_yield = last.first_yield,
            .coarse = last.coarse,
            .residual = std::max(last.residual, rigid_residual),
            .plastic_travel = joint.state().plastic_travel,
            .absorbed_energy = joint.state().plastic_work,
            .step_error = last.step_error,
            .fracture = joint.fracture()};
}

/// Report of the core's Link after a step of it.
/// @param velocities  of its six rows now; axes that are not plastic do not count [m/s | rad/s]
template <class Link, class Velocities>
[[nodiscard]] auto link_report(const Link& link, const Velocities& velocities) noexcept {
    auto report =
        joint_report(link.joint(), link.last(), link.broken() ? Outcome::broken : link.outcome(),
                     link.rigid_residual());
    if (link.broken()) return report;
    for (const auto axis : link.axes()) {
        auto& rate = turns(axis) ? report.rotation_rate : report.elongation_rate;
        rate = std::max(rate, std::abs(velocities[std::ptrdiff_t(index(axis))]));
    }
    return report;
}

/// Report of a joint that the engine left out of the step: it did nothing. A broken one stays so,
/// and still says whether it yielded in its last step.
template <std::floating_point S>
[[nodiscard]] JointReport<S> idle_report(JointReport<S> last) noexcept {
    last.residual = 0;
    last.coarse = false;
    if (last.outcome == Outcome::broken) return last;
    last.first_yield = false;
    last.outcome = Outcome::elastic;
    return last;
}

enum class EventKind {
    yielded,    ///< flowed for the first time
    broke,      ///< see JointEvent::fracture
    unreliable, ///< the solver left it unsolved; told once per joint
    coarse,     ///< the step was too long for what it did; told once per joint
};

[[nodiscard]] constexpr std::string_view to_string(EventKind kind) noexcept {
    switch (kind) {
        case EventKind::yielded:
            return "yielded";
        case EventKind::broke:
            return "broke";
        case EventKind::unreliable:
            return "unreliable";
        case EventKind::coarse:
            return "coarse";
    }
    return "unknown";
}

/// Plain value.
template <std::floating_point S>
struct JointEvent {
    EventKind kind = EventKind::yielded;
    std::size_t joint = 0; ///< number that the watch gave it
    std::string name;      ///< of the joint
    double time = 0;       ///< at the end of the step, for a break within it [s]
    JointReport<S> report;
};

} // namespace ductile
