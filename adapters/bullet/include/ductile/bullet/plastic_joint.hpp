// SPDX-License-Identifier: MIT
//
// A joint of any of the six axes: those that its law rules yield, apart or together on one surface,
// the others hold rigidly.
//
//   PlasticJoint(post, ground, frame_in_post, frame_in_ground, six_axis_joint)
//   PlasticJoint(post, frame_in_post, hinge_joint, {ductile::JointAxis::bending_x})
//
// Frames have z along the member and x, y along the axes of its section, as the capacities of a
// section do; signs and finite rotation as in link.hpp. See joint_constraint.hpp for committing,
// compliance and Bullet's traps.
//
// Where an island solver has the rows (island_solver.hpp) it tells the forces, and fills the joint
// feedback that the user set. Where Bullet's own has them they are read through joint feedback: the
// constraint sets one of its own, unless the user set one, before or after, which is read instead
// and never written.
#pragma once

#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>

#include <utility>

#include "ductile/bullet/joint_constraint.hpp"
#include "ductile/joint/joint_axis.hpp"

namespace ductile::bullet {

/// `Joint`: CoupledJoint of one to six axes, or OneAxisJoint.
template <class Joint>
class PlasticJoint final : public JointConstraintOf<Joint> {
    using Base = JointConstraintOf<Joint>;

  public:
    using Axes = typename Base::Axes;

    /// `axes`: which axis each row of the joint rules, none twice. Frames are in the bodies'
    /// centre-of-mass frames. Where the bodies are now is the rest position.
    /// @throws std::invalid_argument where an axis is given twice.
    PlasticJoint(btRigidBody& a, btRigidBody& b, const btTransform& frame_in_a,
                 const btTransform& frame_in_b, Joint joint, const Axes& axes,
                 Meeting meeting = Meeting::required)
        : Base(a, b, frame_in_a, frame_in_b, std::move(joint), axes, Feedback::all_rows, meeting) {
    }

    /// All six axes, in the order of JointAxis.
    PlasticJoint(btRigidBody& a, btRigidBody& b, const btTransform& frame_in_a,
                 const btTransform& frame_in_b, Joint joint) requires(ruled_axes<Joint> == 6)
        : PlasticJoint(a, b, frame_in_a, frame_in_b, std::move(joint), all_joint_axes) {}

    /// To the static world.
    PlasticJoint(btRigidBody& a, const btTransform& frame_in_a, Joint joint, const Axes& axes)
        : PlasticJoint(a, btTypedConstraint::getFixedBody(), frame_in_a,
                       a.getCenterOfMassTransform() * frame_in_a, std::move(joint), axes) {}
    PlasticJoint(btRigidBody& a, const btTransform& frame_in_a,
                 Joint joint) requires(ruled_axes<Joint> == 6)
        : PlasticJoint(a, frame_in_a, std::move(joint), all_joint_axes) {}
};

#ifdef DUCTILE_COMPILED
extern template class PlasticJoint<UsualSixAxisJoint>;
#endif

} // namespace ductile::bullet
