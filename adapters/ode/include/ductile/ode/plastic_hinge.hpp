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
#include "ductile/ode/joint_axes.hpp"
#include "ductile/ode/one_axis_constraint.hpp"

namespace ductile::ode {

/// Where a hinge is, world axes, as the bodies are now.
struct HingeFrame {
    Vector3<double> anchor = Vector3<double>::Zero(); ///< [m]
    Vector3<double> axis = Vector3<double>::UnitZ();  ///< direction, any length > 0
};

template <class Joint = OneAxisJoint<Perfect<double>>>
class PlasticHinge final : public OneAxisConstraint<Joint> {
    using Base = OneAxisConstraint<Joint>;

  public:
    /// `b` null: hinge between body `a` and the static world. Where the bodies are now is the
    /// hinge's rest position.
    /// @throws std::invalid_argument where `a` is null.
    PlasticHinge(dWorldID world, dBodyID a, dBodyID b, const HingeFrame& frame, Joint joint)
        : Base(hinge_axis(make(world, a, b, frame)), std::move(joint), AtBreak::disable_joint,
               true) {
        axis_in_b_ = this->row().axis();
        if (b != nullptr) axis_in_b_ = matrix_to_core(dBodyGetRotation(b)).transpose() * axis_in_b_;
    }

    /// Angle of A relative to B about the axis, not wrapped [rad].
    [[nodiscard]] double rotation() const { return Base::position(); }
    /// Accumulated plastic rotation p, work-conjugate [rad].
    [[nodiscard]] double plastic_rotation() const { return Base::plastic_travel(); }
    /// Moment about the axis in the last step, positive where it turns A about +axis [N m].
    [[nodiscard]] double moment() const { return Base::reaction(); }

  private:
    static dJointID make(dWorldID world, dBodyID a, dBodyID b, const HingeFrame& frame) {
        require_body("PlasticHinge", a);
        const dJointID id = dJointCreateHinge(world, nullptr);
        const auto& [anchor, axis] = frame;
        dJointAttach(id, a, b);
        dJointSetHingeAnchor(id, dReal(anchor.x()), dReal(anchor.y()), dReal(anchor.z()));
        dJointSetHingeAxis(id, dReal(axis.x()), dReal(axis.y()), dReal(axis.z()));
        return id;
    }
    /// ODE pulls the axes together as it does the pin.
    [[nodiscard]] Vector6<double> rigid_target(double dt) const override {
        const dBodyID b = this->row().bodies().b;
        Vector6<double> target = Base::rigid_target(dt);
        const Vector3<double> axis_b =
            b != nullptr ? matrix_to_core(dBodyGetRotation(b)) * axis_in_b_ : axis_in_b_;
        target.template tail<3>() = this->erp() / dt * this->pose().axis().cross(axis_b);
        return target;
    }

    Vector3<double> axis_in_b_ = Vector3<double>::UnitZ();
};

} // namespace ductile::ode
