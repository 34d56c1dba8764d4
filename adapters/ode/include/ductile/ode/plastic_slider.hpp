// SPDX-License-Identifier: MIT
//
// A bar that holds its length below its axial strength, stretches or shortens at it, keeps the change
// and breaks: ODE's slider with its motor as the plastic row. See one_axis_constraint.hpp for signs
// and ODE's traps.
#pragma once

#include <ode/ode.h>

#include <utility>

#include "ductile/joint/one_axis_joint.hpp"
#include "ductile/law/perfect.hpp"
#include "ductile/ode/one_axis_constraint.hpp"

namespace ductile::ode {

template <class Joint = OneAxisJoint<Perfect<double>>>
class PlasticSlider final : public OneAxisConstraint<Joint> {
    using Base = OneAxisConstraint<Joint>;

  public:
    /// Bar along `axis` (world, any length > 0). `b` null: between body `a` and the static world.
    /// Where the bodies are now is the bar's rest position.
    /// @throws std::invalid_argument where `a` is null.
    PlasticSlider(dWorldID world, dBodyID a, dBodyID b, const Vector3<double>& axis, Joint joint)
        : Base(dJointCreateSlider(world, nullptr), a, b, std::move(joint)) {
        dJointSetSliderAxis(Base::id(), dReal(axis.x()), dReal(axis.y()), dReal(axis.z()));
        dJointSetSliderParam(Base::id(), dParamCFM, 0); // the plastic row is exact
        Base::start();
    }

    /// Change of length: A's displacement along the axis relative to B [m].
    [[nodiscard]] double elongation() const { return Base::position(); }
    /// Accumulated plastic elongation p, work-conjugate [m].
    [[nodiscard]] double plastic_elongation() const { return Base::plastic_travel(); }
    /// Force along the axis in the last step, positive where it pushes A along +axis [N].
    [[nodiscard]] double force() const { return Base::reaction(); }

  private:
    [[nodiscard]] bool turns() const noexcept override { return false; }
    [[nodiscard]] double measure(double /*predicted*/) const override {
        return double(dJointGetSliderPosition(Base::id()));
    }
    [[nodiscard]] Vector3<double> axis() const override {
        dVector3 result;
        dJointGetSliderAxis(Base::id(), result);
        return to_core(result);
    }
    /// ODE applies a slider's force midway between the two centres of mass.
    [[nodiscard]] Vector3<double> point() const override {
        const Vector3<double> a = to_core(dBodyGetPosition(Base::a()));
        return Base::b() == nullptr ? a : (a + to_core(dBodyGetPosition(Base::b()))) / 2;
    }
    void set_motor(dReal velocity, dReal strength) override {
        dJointSetSliderParam(Base::id(), dParamVel, velocity);
        dJointSetSliderParam(Base::id(), dParamFMax, strength);
    }
};

} // namespace ductile::ode
