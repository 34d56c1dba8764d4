// SPDX-License-Identifier: MIT
//
// Where a method puts a joint into an ODE world.
#pragma once

#include <ode/ode.h>

#include "ductile/ode/ode.hpp"
#include "scenes/scene.hpp"

namespace bench {

/// Null: the static world.
[[nodiscard]] inline BodyState state_of(dBodyID body) {
    if (body == nullptr) return {};
    return {ductile::ode::to_core(dBodyGetPosition(body)),
            ductile::ode::matrix_to_core(dBodyGetRotation(body)),
            ductile::ode::linear_velocity(body), ductile::ode::angular_velocity(body)};
}

struct OdeSite {
    dWorldID world;
    ductile::ode::World& stepper;
    dBodyID a;
    dBodyID b; ///< null: the static world
    JointSpec joint;
    double effective_mass; ///< of the joint's row, bodies free [kg m² | kg]

    [[nodiscard]] bool turns() const { return joint.motion == Motion::turns; }
    /// Stiffness of a spring for this joint: its own, or, as in the seed, the strength per unit of
    /// travel.
    [[nodiscard]] double spring_stiffness() const {
        return std::isfinite(joint.stiffness) ? joint.stiffness : joint.strength;
    }
};

/// ODE's hinge or slider, free along its axis; the world destroys it where nobody else does.
inline dJointID free_joint(dWorldID world, dBodyID a, dBodyID b, Motion motion,
                           const Vector& anchor, const Vector& axis) {
    const auto r = [](double value) { return dReal(value); };
    if (motion == Motion::slides) {
        dJointID joint = dJointCreateSlider(world, nullptr);
        dJointAttach(joint, a, b);
        dJointSetSliderAxis(joint, r(axis.x()), r(axis.y()), r(axis.z()));
        return joint;
    }
    dJointID joint = dJointCreateHinge(world, nullptr);
    dJointAttach(joint, a, b);
    dJointSetHingeAnchor(joint, r(anchor.x()), r(anchor.y()), r(anchor.z()));
    dJointSetHingeAxis(joint, r(axis.x()), r(axis.y()), r(axis.z()));
    return joint;
}

} // namespace bench
