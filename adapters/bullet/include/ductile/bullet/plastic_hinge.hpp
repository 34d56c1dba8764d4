// SPDX-License-Identifier: MIT
//
// A hinge that holds below its plastic moment, rigidly or by its stiffness, turns at it, keeps the
// turn and breaks.
//
//   ductile::bullet::PlasticHinge hinge(left, right, frame_in_left, frame_in_right,
//                                       ductile::OneAxisJoint(ductile::Perfect<double>({.strength =
//                                       64})));
//   hinge.add_to(world);
//
// Five rigid rows and one plastic row about the z axis of frame B; see joint_constraint.hpp for
// committing, compliance and Bullet's traps. Angles are not wrapped: the hinge may turn many times,
// as long as it turns less than π in one step.
#pragma once

#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>

#include <utility>

#include "ductile/bullet/joint_constraint.hpp"
#include "ductile/joint/one_axis_joint.hpp"
#include "ductile/law/perfect.hpp"

namespace ductile::bullet {

template <class Joint = OneAxisJoint<Perfect<double>>>
class PlasticHinge final : public HingeJoint<JointConstraintOf<Joint>> {
    using Base = HingeJoint<JointConstraintOf<Joint>>;

  public:
    using Base::axis;

    /// Frames are in the bodies' centre-of-mass frames, as for btHingeConstraint: origin at the
    /// pivot, z along the hinge. Where the bodies are now is the hinge's rest position.
    PlasticHinge(btRigidBody& a, btRigidBody& b, const btTransform& frame_in_a,
                 const btTransform& frame_in_b, Joint joint, Meeting meeting = Meeting::required)
        : Base(a, b, frame_in_a, frame_in_b, std::move(joint), {axis}, Feedback::plastic_row,
               meeting) {}

    /// Hinge between a body and the static world.
    PlasticHinge(btRigidBody& a, const btTransform& frame_in_a, Joint joint)
        : PlasticHinge(a, btTypedConstraint::getFixedBody(), frame_in_a,
                       a.getCenterOfMassTransform() * frame_in_a, std::move(joint)) {}
};

#ifdef DUCTILE_COMPILED
extern template class PlasticHinge<UsualAxisJoint>;
#endif

} // namespace ductile::bullet
