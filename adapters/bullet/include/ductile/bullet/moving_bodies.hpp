// SPDX-License-Identifier: MIT
//
// The bodies of a world that are not static; Bullet keeps such a list and does not show it.
#pragma once

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

namespace ductile::bullet {

struct MovingBodies : btDiscreteDynamicsWorld {
    [[nodiscard]] static const btAlignedObjectArray<btRigidBody*>& of(
        const btDiscreteDynamicsWorld& world) {
        return world.*(&MovingBodies::m_nonStaticRigidBodies);
    }
};

} // namespace ductile::bullet
