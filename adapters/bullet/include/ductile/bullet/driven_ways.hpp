// SPDX-License-Identifier: MIT
//
// The ways of kinematic bodies over a frame that is done in parts (world/driven_course.hpp): from
// where the last frame left them to where they were put since. Each part sees them in its middle,
// as it sees all bodies, with the velocities of its end.
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
#include "ductile/world/driven_course.hpp"

namespace ductile::bullet {

class DrivenWays {
  public:
    /// A frame of `length` > 0 [s] begins: the bodies go back to where the last one left them. Who
    /// has a motion state goes where that says.
    void begin(btDiscreteDynamicsWorld& world, btScalar length);
    /// Puts the bodies where they are `time` [s] after the frame's begin, with the velocities that
    /// they have at `then`; as those of the interpolation with the ones they had at `begun`.
    void place(btScalar time, btScalar begun, btScalar then);
    [[nodiscard]] bool empty() const noexcept { return ways_.empty(); }
    /// Calls `see(body)` for each.
    template <class See>
    void each(const See& see) const {
        for (const Way& way : ways_) see(*way.body);
    }

  private:
    struct Way {
        btRigidBody* body;
        btTransform from, to;
        DrivenCourse course;
    };

    std::vector<Way> ways_, last_;
    btScalar length_ = 1;
};

} // namespace ductile::bullet

#ifndef DUCTILE_COMPILED
#include "ductile/bullet/driven_ways.ipp"
#endif
