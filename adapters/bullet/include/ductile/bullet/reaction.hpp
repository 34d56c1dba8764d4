// SPDX-License-Identifier: MIT
//
// The forces of a constraint's rows, read back from Bullet's joint feedback: a force with its
// torque about the centre of mass, world axes, for either body,
//
//   on A:  F = Σ n λ/dt,   T = r × F + Σ n λ/dt   =>   LinkPose::along_rows of F and T - r × F
//
// with r from the centre of mass to the joint. Bullet sums in its own precision, so that the moment
// is known to round-off of |T| + |r| |F|. It is read from the body with the shorter arm, and a
// force that lies within that round-off of its bound is taken to be at the bound, where the solver
// put it.
#pragma once

#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <cmath>
#include <limits>

#include "ductile/bullet/convert.hpp"
#include "ductile/joint/any_link.hpp"
#include "ductile/joint/joint_axis.hpp"

namespace ductile::bullet {

/// From which body to read, and from where. To be taken before the solve: bodies move after it.
struct ReactionArm {
    bool from_b = false;
    Vector3<double> arm = Vector3<double>::Zero(); ///< joint minus centre of mass, world [m]
};

[[nodiscard]] inline ReactionArm reaction_arm(const btRigidBody& a, const btRigidBody& b,
                                              const Vector3<double>& arm_a,
                                              const Vector3<double>& arm_b) noexcept {
    // feedback is what a body felt: less than the row gave where its factors are not one
    const auto feels_all = [](const btRigidBody& body) {
        const btVector3 one(1, 1, 1);
        return body.getLinearFactor() == one && body.getAngularFactor() == one;
    };
    const bool from_b = feels_all(b) && (!feels_all(a) || dot(arm_b, arm_b) < dot(arm_a, arm_a));
    return {from_b, from_b ? arm_b : arm_a};
}

/// Forces and moments of the link's rows, on A [N | N m].
[[nodiscard]] inline Vector6<double> forces_of_rows(const btJointFeedback& feedback,
                                                    const ReactionArm& from,
                                                    const AnyLink<double>& link) noexcept {
    const Vector3<double> force =
        to_core(from.from_b ? -feedback.m_appliedForceBodyB : feedback.m_appliedForceBodyA);
    const Vector3<double> torque =
        to_core(from.from_b ? -feedback.m_appliedTorqueBodyB : feedback.m_appliedTorqueBodyA);
    const Vector3<double>& arm = from.arm;
    const Vector3<double> moment = difference(torque, cross(arm, force));
    constexpr double round_off = 8 * double(std::numeric_limits<btScalar>::epsilon());
    Vector6<double> result = link.pose().along_rows(force, moment);
    for (const JointAxis axis : all_joint_axes) {
        const RowLimits<double>& limits = link.limits()[index(axis)];
        double& value = result[Eigen::Index(index(axis))];
        const double round_off_of_value =
            round_off * (turns(axis) ? norm(torque) + norm(arm) * norm(force) : norm(force));
        for (const double bound : {limits.lower, limits.upper}) {
            if (std::abs(value - bound) <= round_off_of_value) value = bound;
        }
    }
    return result;
}

/// A wrench on A at the joint, acting for a tick, as Bullet's joint feedback; world axes.
inline void write_feedback(btJointFeedback& feedback, const btRigidBody& a, const btRigidBody& b,
                           const Vector3<double>& arm_a, const Vector3<double>& arm_b,
                           const Vector3<double>& force, const Vector3<double>& moment) {
    const auto felt = [](const Vector3<double>& given, const btVector3& factor) {
        return to_bullet(given) * factor;
    };
    feedback.m_appliedForceBodyA = felt(force, a.getLinearFactor());
    feedback.m_appliedForceBodyB = felt(scaled(-1, force), b.getLinearFactor());
    feedback.m_appliedTorqueBodyA = felt(sum(cross(arm_a, force), moment), a.getAngularFactor());
    feedback.m_appliedTorqueBodyB =
        felt(scaled(-1, sum(cross(arm_b, force), moment)), b.getAngularFactor());
}

} // namespace ductile::bullet
