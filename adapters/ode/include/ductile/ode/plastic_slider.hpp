// SPDX-License-Identifier: MIT
//
// A bar that holds its length below its axial strength, stretches or shortens at it, keeps the
// change and breaks: ODE's slider with its motor as the plastic row. See one_axis_constraint.hpp
// for signs and ODE's traps.
#pragma once

#include <ode/ode.h>

#include <utility>

#include "ductile/joint/one_axis_joint.hpp"
#include "ductile/law/perfect.hpp"
#include "ductile/ode/joint_axes.hpp"
#include "ductile/ode/one_axis_constraint.hpp"

namespace ductile::ode {

template <class Joint = OneAxisJoint<Perfect<double>>>
class PlasticSlider final : public AxisConstraint<Joint, OneAxisConstraint> {
    using Base = AxisConstraint<Joint, OneAxisConstraint>;

  public:
    /// Bar along `axis` (world, any length > 0). `b` null: between body `a` and the static world.
    /// Where the bodies are now is the bar's rest position.
    /// @throws std::invalid_argument where `a` is null, both bodies are one or not of this world,
    /// or the axis is not finite or has no length.
    PlasticSlider(dWorldID world, dBodyID a, dBodyID b, const Vector3<double>& axis, Joint joint)
        : Base(std::move(joint), slider_axis(make(world, a, b, axis)), AtBreak::disable_joint,
               true) {}

    /// Change of length: A's displacement along the axis relative to B [m].
    [[nodiscard]] double elongation() const { return Base::position(); }
    /// Accumulated plastic elongation p, work-conjugate [m].
    [[nodiscard]] double plastic_elongation() const { return Base::plastic_travel(); }
    /// Force along the axis in the last step, positive where it pushes A along +axis [N].
    [[nodiscard]] double force() const { return Base::reaction(); }

  private:
    static dJointID make(dWorldID world, dBodyID a, dBodyID b, const Vector3<double>& axis) {
        require_bodies("PlasticSlider", world, a, b);
        require_direction("PlasticSlider.axis", axis);
        const dJointID id = dJointCreateSlider(world, nullptr);
        dJointAttach(id, a, b);
        dJointSetSliderAxis(id, dReal(axis.x()), dReal(axis.y()), dReal(axis.z()));
        return id;
    }
};

#ifdef DUCTILE_COMPILED
extern template class PlasticSlider<UsualAxisJoint>;
#endif

} // namespace ductile::ode
