// SPDX-License-Identifier: MIT
//
// A hinge that holds below its plastic moment, rigidly or by its stiffness, turns at it, keeps the
// turn and breaks.
//
//   ductile::ode::PlasticHinge hinge(world, left, right, {.anchor = {0, 0, 0}, .axis = {0, 1, 0}},
//                                    ductile::OneAxisJoint(ductile::Perfect<double>({.strength =
//                                    64})));
//   hinge.add_to(stepper);
//
// Five rigid rows and one plastic row about the axis; see joint_constraint.hpp for who solves, life
// in a world and ODE's traps. Angles are not wrapped: the hinge may turn many times, as long as it
// turns less than π in one step.
#pragma once

#include <ode/ode.h>

#include <utility>

#include "ductile/joint/one_axis_joint.hpp"
#include "ductile/law/perfect.hpp"
#include "ductile/ode/joint_constraint.hpp"

namespace ductile::ode {

/// Where a hinge is, world axes, as the bodies are now.
struct HingeFrame {
    Vector3<double> anchor{0, 0, 0}; ///< [m]
    Vector3<double> axis{0, 0, 1};   ///< direction, any length > 0
};

template <class Joint = OneAxisJoint<Perfect<double>>>
class PlasticHinge final : public HingeJoint<LinkJoint<Joint, JointConstraint>> {
    using Base = HingeJoint<LinkJoint<Joint, JointConstraint>>;

  public:
    using Base::axis;

    /// `b` null: hinge between body `a` and the static world. Where the bodies are now is the
    /// hinge's rest position.
    /// @throws std::invalid_argument where `a` is null, both bodies are one or not of this world,
    /// or the frame is not finite or its axis has no length.
    PlasticHinge(dWorldID world, dBodyID a, dBodyID b, const HingeFrame& frame, Joint joint)
        : PlasticHinge(std::move(joint), world, Base::require_bodies("PlasticHinge", world, a, b),
                       b, Base::frame_along("PlasticHinge.frame", frame.axis, frame.anchor)) {}

    /// Frames in body `a` and in body `b`, or the static world: origin at the pivot, z along the
    /// hinge.
    /// @throws std::invalid_argument as above, and where the frames do not meet (joint_checks.hpp).
    PlasticHinge(dWorldID world, dBodyID a, dBodyID b, const JointFrame<double>& in_a,
                 const JointFrame<double>& in_b, Joint joint, Meeting meeting = Meeting::required)
        : Base(Link<Joint>(std::move(joint), {axis}, Base::require_frame("in_a", in_a),
                           Base::require_frame("in_b", in_b)),
               world, Base::require_bodies("PlasticHinge", world, a, b), b, meeting) {}

  private:
    PlasticHinge(Joint joint, dWorldID world, dBodyID a, dBodyID b,
                 const JointFrame<double>& in_world)
        : Base(Link<Joint>(std::move(joint), {axis}, Base::frame_in(a, in_world),
                           Base::frame_in(b, in_world)),
               world, a, b) {}
};

#ifdef DUCTILE_COMPILED
extern template class PlasticHinge<UsualAxisJoint>;
#endif

} // namespace ductile::ode
