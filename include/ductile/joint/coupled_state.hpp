// SPDX-License-Identifier: MIT
//
// What goes into a coupled joint, what it remembers between steps, what one step of it did, and its
// numerical parameters. Vectors have one entry per axis of its yield surface, in that order.
#pragma once

#include <Eigen/Core>
#include <concepts>
#include <limits>
#include <string>

#include "ductile/joint/joint_totals.hpp"
#include "ductile/vocabulary/check.hpp"
#include "ductile/vocabulary/finite.hpp"
#include "ductile/vocabulary/row.hpp"
#include "ductile/vocabulary/vector.hpp"

namespace ductile {

/// The rows at the start of a step, before this step's external impulses.
template <std::floating_point S, int N>
struct CoupledMotion {
    Eigen::Matrix<S, N, 1> position = Eigen::Matrix<S, N, 1>::Zero(); ///< q [m | rad]
    Eigen::Matrix<S, N, 1> velocity = Eigen::Matrix<S, N, 1>::Zero(); ///< u [m/s | rad/s]
    /// M, symmetric, positive definite [kg | kg m²]; only its error by factors spoils the
    /// prediction
    Eigen::Matrix<S, N, N> mass = Eigen::Matrix<S, N, N>::Identity();
    bool ahead = false;                                             ///< as Motion's
    Eigen::Matrix<S, N, 1> before = Eigen::Matrix<S, N, 1>::Zero(); ///< as Motion's
    S turning = 0;                                                  ///< as Motion's
    Eigen::Matrix<S, N, 1> drift = Eigen::Matrix<S, N, 1>::Zero();  ///< as Motion's
    S damping = 0;                                                  ///< as Motion's
};

/// What the engine did to the rows in the step.
template <std::floating_point S, int N>
struct CoupledReaction {
    Eigen::Matrix<S, N, 1> force = Eigen::Matrix<S, N, 1>::Zero();    ///< λ/dt [N | N m]
    Eigen::Matrix<S, N, 1> velocity = Eigen::Matrix<S, N, 1>::Zero(); ///< u' [m/s | rad/s]
    Eigen::Matrix<S, N, 1> position = Eigen::Matrix<S, N, 1>::Zero(); ///< q [m | rad]
    bool on_surface = false; ///< the solver met the surface itself, not the rows' bounds
};

/// True where every number is finite, and `dt` [s].
template <std::floating_point S, int N>
[[nodiscard]] bool is_finite(const CoupledMotion<S, N>& motion, S dt) noexcept {
    return is_finite(motion.position) && is_finite(motion.velocity) && is_finite(motion.mass) &&
           is_finite(motion.before) && are_finite(dt);
}
/// The same, and the work from the velocities `start` on.
template <std::floating_point S, int N>
[[nodiscard]] bool is_finite(const CoupledReaction<S, N>& reaction,
                             const Eigen::Matrix<S, N, 1>& start, S dt) noexcept {
    S work = 0;
    for (int i = 0; i < N; ++i) work += reaction.force[i] * (start[i] + reaction.velocity[i]) * dt;
    return are_finite(work) && is_finite(reaction.position);
}

/// What one committed step did.
template <std::floating_point S, int N>
struct CoupledStep : Step<S> {
    Eigen::Matrix<S, N, 1> direction = Eigen::Matrix<S, N, 1>::Zero(); ///< flow [m | rad]
};

/// Everything a joint remembers between steps. Plain value: copy, compare, save and restore it. Its
/// travel is the equivalent one [m | rad of the law].
template <std::floating_point S, int N, class CriterionState>
struct CoupledState : JointTotals<S> {
    Eigen::Matrix<S, N, 1> plastic_offset = Eigen::Matrix<S, N, 1>::Zero(); ///< q_p [m | rad]
    /// of the last step; once broken, just before the break [N | N m]
    Eigen::Matrix<S, N, 1> force = Eigen::Matrix<S, N, 1>::Zero();
    Eigen::Matrix<S, N, 1> start_velocity = Eigen::Matrix<S, N, 1>::Zero(); ///< u of the last step
    Eigen::Matrix<S, N, 1> velocity = Eigen::Matrix<S, N, 1>::Zero();       ///< u' of the last step
    CriterionState criterion{};
    S life =
        0; ///< L, share that flow along the axes used up of their largest travel (axis_life.hpp)
    int broken_axis = -1; ///< that did most of the breaking step's plastic work; -1 while intact

    bool operator==(const CoupledState&) const = default;
};

template <std::floating_point S, int N>
struct CoupledParameters {
    /// k of each axis [N/m | N m/rad], > 0; infinity: rigid below yield.
    Eigen::Matrix<S, N, 1> stiffness =
        Eigen::Matrix<S, N, 1>::Constant(std::numeric_limits<S>::infinity());
    /// l of each axis, plastic travel along it alone at which the joint breaks [m | rad], > 0
    /// (axis_life.hpp); infinity: never.
    Eigen::Matrix<S, N, 1> largest_travel =
        Eigen::Matrix<S, N, 1>::Constant(std::numeric_limits<S>::infinity());
    /// Elastic stiffness of the member that the joint stands for, for rigid axes too [N/m | N
    /// m/rad], > 0: by it the joints of a redundant structure share their forces. Infinity: not
    /// known.
    Eigen::Matrix<S, N, 1> section_stiffness =
        Eigen::Matrix<S, N, 1>::Constant(std::numeric_limits<S>::infinity());
    /// As OneAxisParameters, of each axis [s], >= 0; with none at all, waves that no part resolves
    /// may grow.
    Eigen::Matrix<S, N, 1> damping_time = Eigen::Matrix<S, N, 1>::Constant(S(3e-6));
    S drift_time = S(0.02);         ///< as OneAxisParameters [s], > 0
    S absolute_residual = S(1e-3);  ///< [m/s | rad/s], > 0
    S relative_residual = S(1e-2);  ///< [-], in [0, 1]
    S allowed_step_error = S(0.04); ///< as OneAxisParameters [-], > 0
    S least_travel = S(2e-3);       ///< as OneAxisParameters, equivalent travel [m | rad], > 0

    /// The most that one elastic axis holds under these forces [J].
    [[nodiscard]] S yield_energy(const Eigen::Matrix<S, N, 1>& force) const noexcept {
        return (force.array().square() / (2 * stiffness.array())).maxCoeff();
    }

    /// @throws std::invalid_argument where a parameter is out of range.
    void validate() const {
        for (int i = 0; i < N; ++i) {
            check::positive_or_infinite("CoupledJoint.stiffness[" + std::to_string(i) + "]",
                                        stiffness[i], "N/m or N m/rad");
            check::positive_or_infinite("CoupledJoint.largest_travel[" + std::to_string(i) + "]",
                                        largest_travel[i], "m or rad");
            check::non_negative("CoupledJoint.damping_time[" + std::to_string(i) + "]",
                                damping_time[i], "s");
            check::positive_or_infinite("CoupledJoint.section_stiffness[" + std::to_string(i) + "]",
                                        section_stiffness[i], "N/m or N m/rad");
        }
        check::positive("CoupledJoint.drift_time", drift_time, "s");
        check::positive("CoupledJoint.absolute_residual", absolute_residual, "m/s or rad/s");
        check::between("CoupledJoint.relative_residual", relative_residual, S(0), S(1), "", true);
        check::positive_or_infinite("CoupledJoint.allowed_step_error", allowed_step_error, "");
        check::positive("CoupledJoint.least_travel", least_travel, "m or rad");
    }
};

} // namespace ductile
