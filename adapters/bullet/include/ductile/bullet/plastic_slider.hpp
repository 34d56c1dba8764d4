// SPDX-License-Identifier: MIT
//
// A bar that holds its length below its axial strength, rigidly or by its stiffness, stretches or
// shortens at it, keeps the change and breaks: five rigid rows and one plastic row along the z axis
// of frame B. See joint_constraint.hpp for committing, compliance and Bullet's traps.
#pragma once

#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>

#include <utility>

#include "ductile/bullet/joint_constraint.hpp"
#include "ductile/joint/one_axis_joint.hpp"
#include "ductile/law/perfect.hpp"

namespace ductile::bullet {

template <class Joint = OneAxisJoint<Perfect<double>>>
class PlasticSlider final : public SliderJoint<JointConstraintOf<Joint>> {
    using Base = SliderJoint<JointConstraintOf<Joint>>;

  public:
    using Base::axis;

    /// Frames are in the bodies' centre-of-mass frames; z along the bar, parallel axes at rest.
    /// Where the bodies are now is the bar's rest position.
    PlasticSlider(btRigidBody& a, btRigidBody& b, const btTransform& frame_in_a,
                  const btTransform& frame_in_b, Joint joint)
        : Base(a, b, frame_in_a, frame_in_b, std::move(joint), {axis}, Feedback::plastic_row) {}

    /// Bar between a body and the static world.
    PlasticSlider(btRigidBody& a, const btTransform& frame_in_a, Joint joint)
        : PlasticSlider(a, btTypedConstraint::getFixedBody(), frame_in_a,
                        a.getCenterOfMassTransform() * frame_in_a, std::move(joint)) {}
};

#ifdef DUCTILE_COMPILED
extern template class PlasticSlider<UsualAxisJoint>;
#endif

} // namespace ductile::bullet
