// SPDX-License-Identifier: MIT
//
// Lets the forces of the coming step act for a share of it (world/leapfrog.hpp): gravity, what was
// applied to the bodies, and the strength of all plastic joints. The engine's own springs and
// motors act for the whole step.
#pragma once

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include "ductile/bullet/held_forces.hpp"
#include "ductile/bullet/plastic_constraint.hpp"
#include "ductile/world/leapfrog.hpp"

namespace ductile::bullet {

/// To be called for each step, with what is applied for it.
inline void share_forces(btDiscreteDynamicsWorld& world, const ForceShare& how) {
    for (int i = 0; i < world.getNumConstraints(); ++i) {
        PlasticConstraint* plastic = as_plastic(*world.getConstraint(i));
        if (plastic != nullptr) plastic->set_force_share(how);
    }
    if (how.value == 1) return;
    const btScalar more = btScalar(how.value - 1);
    const auto& objects = world.getCollisionObjectArray();
    for (int i = 0; i < objects.size(); ++i) {
        btRigidBody* body = btRigidBody::upcast(objects[i]);
        if (body == nullptr || body->isStaticOrKinematicObject() || !body->isActive()) continue;
        const btVector3 force = unweighted(body->getTotalForce(), body->getLinearFactor());
        const btVector3 torque = unweighted(body->getTotalTorque(), body->getAngularFactor());
        body->applyCentralForce(more * (force + body->getMass() * body->getGravity()));
        body->applyTorque(more * torque);
    }
}

} // namespace ductile::bullet
