// SPDX-License-Identifier: MIT
//
// A hinge that holds rigidly below its plastic moment, turns at it, keeps the turn and breaks.
//
//   ductile::ode::PlasticHinge hinge(world, left, right, {.anchor = {0, 0, 0}, .axis = {0, 1, 0}},
//                                    ductile::OneAxisJoint(ductile::Perfect<double>({.strength = 64})));
//   hinge.add_to(stepper);
//
// ODE's hinge with its motor as the plastic row; see one_axis_constraint.hpp for signs and ODE's
// traps. Angles are not wrapped: the hinge may turn many times, as long as it turns less than π in one
// step.
#pragma once

#include <ode/ode.h>

#include <utility>

#include "ductile/joint/one_axis_joint.hpp"
#include "ductile/law/perfect.hpp"
#include "ductile/ode/one_axis_constraint.hpp"
#include "ductile/vocabulary/angle.hpp"

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
        : Base(dJointCreateHinge(world, nullptr), a, b, std::move(joint)), world_(world) {
        const auto& [anchor, axis] = frame;
        dJointSetHingeAnchor(Base::id(), dReal(anchor.x()), dReal(anchor.y()), dReal(anchor.z()));
        dJointSetHingeAxis(Base::id(), dReal(axis.x()), dReal(axis.y()), dReal(axis.z()));
        dJointSetHingeParam(Base::id(), dParamCFM, 0); // the plastic row is exact
        axis_in_b_ = this->axis();
        if (b != nullptr) axis_in_b_ = matrix_to_core(dBodyGetRotation(b)).transpose() * axis_in_b_;
        Base::start();
    }

    /// Angle of A relative to B about the axis, not wrapped [rad].
    [[nodiscard]] double rotation() const { return Base::position(); }
    /// Accumulated plastic rotation p, work-conjugate [rad].
    [[nodiscard]] double plastic_rotation() const { return Base::plastic_travel(); }
    /// Moment about the axis in the last step, positive where it turns A about +axis [N m].
    [[nodiscard]] double moment() const { return Base::reaction(); }

  private:
    [[nodiscard]] bool turns() const noexcept override { return true; }
    [[nodiscard]] double measure(double predicted) const override {
        return unwrap(double(dJointGetHingeAngle(Base::id())), predicted);
    }
    [[nodiscard]] Vector3<double> axis() const override {
        dVector3 result;
        dJointGetHingeAxis(Base::id(), result);
        return to_core(result);
    }
    [[nodiscard]] Vector3<double> point() const override {
        dVector3 result;
        dJointGetHingeAnchor(Base::id(), result);
        return to_core(result);
    }
    /// ODE pulls anchors and axes together by the world's ERP a step.
    [[nodiscard]] Vector6<double> rigid_target(double dt) const override {
        dVector3 other;
        dJointGetHingeAnchor2(Base::id(), other);
        Vector3<double> axis_b = axis_in_b_;
        if (Base::b() != nullptr) axis_b = matrix_to_core(dBodyGetRotation(Base::b())) * axis_in_b_;
        Vector6<double> target;
        target << to_core(other) - point(), axis().cross(axis_b);
        return double(dWorldGetERP(world_)) / dt * target;
    }
    void set_motor(dReal velocity, dReal strength) override {
        dJointSetHingeParam(Base::id(), dParamVel, velocity);
        dJointSetHingeParam(Base::id(), dParamFMax, strength);
    }

    dWorldID world_;
    Vector3<double> axis_in_b_ = Vector3<double>::UnitZ();
};

} // namespace ductile::ode
