// SPDX-License-Identifier: MIT
//
// The ways of kinematic bodies over a frame that is done in parts: from where the last frame left
// them to where they were put since, with one velocity. Each part sees them in its middle, as it
// sees all bodies.
//
// A step of Bullet's own reads such a body's whole way as that of its first tick, however short,
// and the angle of a short turn off the cosine of its half.
//
// Not thread-safe.
#pragma once

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <vector>

#include "ductile/vocabulary/linkage.hpp"

namespace ductile::bullet {

class DrivenWays {
  public:
    /// A frame of `length` > 0 [s] begins: the bodies go back to where the last one left them, with
    /// the velocities of their ways. Who has a motion state goes where that says.
    void begin(btDiscreteDynamicsWorld& world, btScalar length);
    /// Puts the bodies where they are `time` [s] after the frame's begin.
    void place(btScalar time);
    [[nodiscard]] bool empty() const noexcept { return ways_.empty(); }

  private:
    struct Way {
        btRigidBody* body;
        btTransform from, to;
    };

    std::vector<Way> ways_;
    btScalar length_ = 1;
};

} // namespace ductile::bullet

#ifndef DUCTILE_COMPILED
#include "ductile/bullet/driven_ways.ipp"
#endif
