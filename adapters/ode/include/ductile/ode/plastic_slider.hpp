// SPDX-License-Identifier: MIT
//
// A bar that holds its length below its axial strength, rigidly or by its stiffness, stretches or
// shortens at it, keeps the change and breaks: five rigid rows and one plastic row along the axis.
// See joint_constraint.hpp for who solves, life in a world and ODE's traps.
#pragma once

#include <ode/ode.h>

#include <utility>

#include "ductile/joint/one_axis_joint.hpp"
#include "ductile/law/perfect.hpp"
#include "ductile/ode/joint_constraint.hpp"

namespace ductile::ode {

template <class Joint = OneAxisJoint<Perfect<double>>>
class PlasticSlider final : public SliderJoint<LinkJoint<Joint, JointConstraint>> {
    using Base = SliderJoint<LinkJoint<Joint, JointConstraint>>;

  public:
    using Base::axis;

    /// Bar along `along` (world, any length > 0), through the middle between the centres of mass,
    /// or where `b` is null, the static world, through that of `a`. Where the bodies are now is the
    /// bar's rest position.
    /// @throws std::invalid_argument where `a` is null, both bodies are one or not of this world,
    /// or `along` is not finite or has no length.
    PlasticSlider(dWorldID world, dBodyID a, dBodyID b, const Vector3<double>& along, Joint joint)
        : PlasticSlider(std::move(joint), world, Base::require_bodies("PlasticSlider", world, a, b),
                        b, Base::frame_along("PlasticSlider", along, Base::midway(a, b))) {}

  private:
    PlasticSlider(Joint joint, dWorldID world, dBodyID a, dBodyID b,
                  const JointFrame<double>& in_world)
        : Base(Link<Joint>(std::move(joint), {axis}, Base::frame_in(a, in_world),
                           Base::frame_in(b, in_world)),
               world, a, b) {}
};

#ifdef DUCTILE_COMPILED
extern template class PlasticSlider<UsualAxisJoint>;
#endif

} // namespace ductile::ode
