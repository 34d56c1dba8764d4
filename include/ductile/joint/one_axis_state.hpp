// SPDX-License-Identifier: MIT
//
// What a plastic axis remembers between steps, and its numerical parameters.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>

#include "ductile/joint/joint_totals.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile {

/// What the engine's step did to a row.
template <std::floating_point S>
struct RowTaken {
    S force;    ///< f [N | N m]
    S work;     ///< W [J]
    S travel;   ///< (u + u')/2 dt, signed [m | rad]
    S velocity; ///< u' beyond the row's drift [m/s | rad/s]
    S position; ///< q after the step [m | rad]
    S dt;       ///< [s]
    bool at_upper, at_lower;
    S granted; ///< share of the flow's work that is booked

    [[nodiscard]] bool at_bound() const noexcept { return at_upper || at_lower; }
    /// Of complementarity; `excess`: u' + C λ - b [m/s | rad/s].
    [[nodiscard]] S violation(S excess) const noexcept {
        if (at_upper) return std::max(excess, S(0));
        if (at_lower) return std::max(-excess, S(0));
        return std::abs(excess);
    }
};

/// Everything a joint remembers between steps. Plain value: copy, compare, save and restore it.
template <std::floating_point S, class LawState, class CriterionState>
struct OneAxisState : JointTotals<S> {
    S plastic_offset = 0; ///< q_p, geometric rest position [m | rad]
    S start_velocity = 0; ///< u of the last step [m/s | rad/s]
    S velocity = 0;       ///< u' of the last step [m/s | rad/s]
    S force = 0;          ///< of the last step; once broken, just before the break [N | N m]
    LawState law{};
    CriterionState criterion{};

    bool operator==(const OneAxisState&) const = default;
};

template <std::floating_point S>
struct OneAxisParameters {
    /// k of the elastic part [N/m | N m/rad], > 0; infinity: rigid below yield.
    S stiffness = std::numeric_limits<S>::infinity();
    /// τ of the elastic part, a damper of k τ beside the spring [s], >= 0; read in parts of a
    /// frame, as the springs of other steps lose more by themselves.
    S damping_time = 0;
    /// Time in which a rigid row that holds removes drift from q_p [s], > 0; five steps where that
    /// is longer. A time, not a share of each step: a share would turn the drift left by a long
    /// step into a kick in a short one.
    S drift_time = S(0.02);
    /// A step is unreliable where its residual exceeds this plus `relative_residual` × |velocity|
    /// [m/s | rad/s], > 0.
    S absolute_residual = S(1e-3);
    S relative_residual = S(1e-2); ///< [-], in [0, 1]
    /// A step is too coarse where the steps so far may have misplaced more than this share of the
    /// plastic travel [-], > 0; infinity: never.
    S allowed_step_error = S(0.04);
    /// Plastic travel of a rigid row below which its errors do not matter [m | rad], > 0: smaller
    /// ones are judged as if they were this large. An elastic row has its yield strain instead.
    S least_travel = S(2e-3);

    /// @throws std::invalid_argument where a parameter is out of range.
    void validate() const {
        check::positive_or_infinite("OneAxisJoint.stiffness", stiffness, "N/m or N m/rad");
        check::non_negative("OneAxisJoint.damping_time", damping_time, "s");
        check::positive("OneAxisJoint.drift_time", drift_time, "s");
        check::positive("OneAxisJoint.absolute_residual", absolute_residual, "m/s or rad/s");
        check::between("OneAxisJoint.relative_residual", relative_residual, S(0), S(1), "", true);
        check::positive_or_infinite("OneAxisJoint.allowed_step_error", allowed_step_error, "");
        check::positive("OneAxisJoint.least_travel", least_travel, "m or rad");
    }
};

/// For adapters and batches that have rigid-plastic rows only.
/// @throws std::invalid_argument where the stiffness is finite.
template <std::floating_point S>
void require_rigid(S stiffness) {
    if (stiffness != std::numeric_limits<S>::infinity()) {
        check::fail("OneAxisJoint.stiffness", stiffness, "N/m or N m/rad",
                    "infinite: elastic rows are not mapped here");
    }
}

} // namespace ductile
