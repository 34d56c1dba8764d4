// SPDX-License-Identifier: MIT
//
// A hinge that holds rigidly below its plastic moment, turns at it, keeps the turn and breaks.
//
//   ductile::ode::PlasticHinge hinge(world, left, right, {.anchor = {0, 0, 0}, .axis = {0, 1, 0}},
//                                    ductile::OneAxisJoint(ductile::Perfect<double>({.strength =
//                                    64})));
//   hinge.add_to(stepper);
//
// ODE's hinge with its motor as the plastic row; see one_axis_constraint.hpp for signs and ODE's
// traps. Angles are not wrapped: the hinge may turn many times, as long as it turns less than π in
// one step.
#pragma once

#include <ode/ode.h>

#include <utility>

#include "ductile/joint/one_axis_joint.hpp"
#include "ductile/law/perfect.hpp"
#include "ductile/ode/one_axis_constraint.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::ode {

/// Where a hinge is, world axes, as the bodies are now.
struct HingeFrame {
    Vector3<double> anchor{0, 0, 0}; ///< [m]
    Vector3<double> axis{0, 0, 1};   ///< direction, any length > 0
};

/// All but the joint's type.
class HingeConstraint : public OneAxisConstraint {
  public:
    /// Angle of A relative to B about the axis, not wrapped [rad].
    [[nodiscard]] double rotation() const { return position(); }
    /// Accumulated plastic rotation p, work-conjugate [rad].
    [[nodiscard]] double plastic_rotation() const { return plastic_travel(); }
    /// Moment about the axis in the last step, positive where it turns A about +axis [N m].
    [[nodiscard]] double moment() const { return reaction(); }

  protected:
    HingeConstraint(AxisJoint& joint, dWorldID world, dBodyID a, dBodyID b,
                    const HingeFrame& frame);
    ~HingeConstraint() override = default;

  private:
    static dJointID make(dWorldID world, dBodyID a, dBodyID b, const HingeFrame& frame);
    /// ODE pulls the axes together as it does the pin.
    [[nodiscard]] DUCTILE_INLINE Vector6<double> rigid_target(double dt) const override;

    Vector3<double> axis_in_b_{0, 0, 1};
};

template <class Joint = OneAxisJoint<Perfect<double>>>
class PlasticHinge final : public AxisConstraint<Joint, HingeConstraint> {
  public:
    /// `b` null: hinge between body `a` and the static world. Where the bodies are now is the
    /// hinge's rest position.
    /// @throws std::invalid_argument where `a` is null, both bodies are one or not of this world,
    /// or the frame is not finite or its axis has no length.
    PlasticHinge(dWorldID world, dBodyID a, dBodyID b, const HingeFrame& frame, Joint joint)
        : AxisConstraint<Joint, HingeConstraint>(std::move(joint), world, a, b, frame) {}
};

#ifdef DUCTILE_COMPILED
extern template class PlasticHinge<UsualAxisJoint>;
#endif

} // namespace ductile::ode

#ifndef DUCTILE_COMPILED
#include "ductile/ode/plastic_hinge.ipp"
#endif
