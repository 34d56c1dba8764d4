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
    const Matrix3<double> to_b = matrix_to_core(dBodyGetRotation(b)).transpose();
    axis_in_b_ = to_b * row().axis();
}

DUCTILE_INLINE dJointID HingeConstraint::make(dWorldID world, dBodyID a, dBodyID b,
                                              const HingeFrame& frame) {
    require_body("PlasticHinge", a);
    const dJointID id = dJointCreateHinge(world, nullptr);
    const auto& [anchor, axis] = frame;
    dJointAttach(id, a, b);
    dJointSetHingeAnchor(id, dReal(anchor.x()), dReal(anchor.y()), dReal(anchor.z()));
    dJointSetHingeAxis(id, dReal(axis.x()), dReal(axis.y()), dReal(axis.z()));
    return id;
}

DUCTILE_INLINE Vector6<double> HingeConstraint::rigid_target(double dt) const {
    const dBodyID b = row().bodies().b;
    Vector6<double> target = OneAxisConstraint::rigid_target(dt);
    Vector3<double> axis_b = axis_in_b_;
    if (b != nullptr) axis_b = matrix_to_core(dBodyGetRotation(b)) * axis_in_b_;
    target.tail<3>() = erp() / dt * pose().axis().cross(axis_b);
    return target;
}

} // namespace ductile::ode
