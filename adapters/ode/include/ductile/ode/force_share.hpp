// SPDX-License-Identifier: MIT
//
// Lets the forces of the coming step act for a share of it (world/leapfrog.hpp): gravity, what was
// applied to the bodies, and the strength of all plastic joints. The engine's own springs and
// motors act for the whole step.
#pragma once

#include <ode/ode.h>

#include <span>

#include "ductile/ode/convert.hpp"
#include "ductile/ode/stepped_constraint.hpp"
#include "ductile/world/leapfrog.hpp"

namespace ductile::ode {

/// To be called for each step, with what is applied for it; `bodies`: all that move.
inline void share_forces(std::span<const dBodyID> bodies,
                         std::span<SteppedConstraint* const> constraints, const ForceShare& how) {
    for (SteppedConstraint* constraint : constraints) constraint->set_force_share(how);
    if (how.value == 1) return;
    for (dBodyID body : bodies) {
        if (dBodyIsKinematic(body) || dBodyIsEnabled(body) == 0) continue;
        Vector3<double> force = to_core(dBodyGetForce(body));
        if (dBodyGetGravityMode(body) != 0) {
            dVector3 gravity;
            dWorldGetGravity(dBodyGetWorld(body), gravity);
            dMass mass;
            dBodyGetMass(body, &mass);
            force = sum(force, scaled(double(mass.mass), to_core(gravity)));
        }
        const double more = how.value - 1;
        add_force(body, scaled(more, force), scaled(more, to_core(dBodyGetTorque(body))));
    }
}

} // namespace ductile::ode
