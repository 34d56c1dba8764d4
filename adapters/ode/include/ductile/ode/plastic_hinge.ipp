// SPDX-License-Identifier: MIT
//
// Bodies of plastic_hinge.hpp.
#pragma once

#include "ductile/ode/convert.hpp"
#include "ductile/ode/joint_axes.hpp"
#include "ductile/ode/plastic_hinge.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::ode {

DUCTILE_INLINE HingeConstraint::HingeConstraint(AxisJoint& joint, dWorldID world, dBodyID a,
                                                dBodyID b, const HingeFrame& frame)
    : OneAxisConstraint(joint, hinge_axis(make(world, a, b, frame)), AtBreak::disable_joint, true) {
    axis_in_b_ = row().axis();
    if (b == nullptr) return;
    axis_in_b_ = transposed_times(matrix_to_core(dBodyGetRotation(b)), row().axis());
}

DUCTILE_INLINE dJointID HingeConstraint::make(dWorldID world, dBodyID a, dBodyID b,
                                              const HingeFrame& frame) {
    require_bodies("PlasticHinge", world, a, b);
    const auto& [anchor, axis] = frame;
    require_direction("PlasticHinge.frame.axis", axis);
    if (!is_finite(anchor)) {
        throw std::invalid_argument("PlasticHinge.frame.anchor: must be finite [m]");
    }
    const dJointID id = dJointCreateHinge(world, nullptr);
    dJointAttach(id, a, b);
    dJointSetHingeAnchor(id, dReal(anchor.x()), dReal(anchor.y()), dReal(anchor.z()));
    dJointSetHingeAxis(id, dReal(axis.x()), dReal(axis.y()), dReal(axis.z()));
    return id;
}

DUCTILE_INLINE Vector6<double> HingeConstraint::rigid_target(double dt) const {
    const dBodyID b = row().bodies().b;
    Vector3<double> axis_b = axis_in_b_;
    if (b != nullptr) axis_b = times(matrix_to_core(dBodyGetRotation(b)), axis_in_b_);
    return twist_of(linear(OneAxisConstraint::rigid_target(dt)),
                    scaled(erp() / dt, cross(pose().axis(), axis_b)));
}

} // namespace ductile::ode
