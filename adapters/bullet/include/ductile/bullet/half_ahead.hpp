// SPDX-License-Identifier: MIT
//
// Lets a world's tick see its bodies half a step ahead (frame/README.md): before the tick they are
// moved by h/2 with the velocities they have; in it, after Bullet has moved them by h with the new
// ones and before any other action, to where h/2 leads.
//
// Traps of Bullet 3.24 that this header deals with
//   - Actions run in the order of their list, to whose end Bullet adds: this one has to be first,
//     as joints book where bodies are.
//   - A body that the tick woke was not ahead; one that the tick put to sleep stays where it is.
//   - Where Bullet's continuous collision stopped a body, it goes no further than that.
//   - What overlaps deeper than m_splitImpulsePenetrationThreshold is pushed apart without a
//     velocity: that way stays.
//
// Not thread-safe.
#pragma once

#include <BulletDynamics/Dynamics/btActionInterface.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include <span>
#include <vector>

#include "ductile/bullet/driven_ways.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::bullet {

class HalfAhead final : public btActionInterface {
  public:
    /// Is in the world's list of actions until `leave`.
    explicit HalfAhead(btDiscreteDynamicsWorld& world);
    ~HalfAhead() override = default;
    /// To be called before this ends, unless the world has.
    void leave();
    HalfAhead(const HalfAhead&) = delete;
    HalfAhead& operator=(const HalfAhead&) = delete;

    /// Moves those of `bodies` that are awake half a step of `h` > 0 [s] ahead, for the coming
    /// tick, which begins `time` [s] after the frame that `ways` are of.
    void move(std::span<btRigidBody* const> bodies, btScalar h, DrivenWays& ways, btScalar time);
    /// The rest of the way, in the tick; the same bodies.
    void finish(std::span<btRigidBody* const> bodies, btScalar h);

    DUCTILE_INLINE void updateAction(btCollisionWorld* world, btScalar h) override;
    void debugDraw(btIDebugDraw* /*drawer*/) override {}

  private:
    struct Middle {
        const btRigidBody* body = nullptr; ///< null: it was not moved
        btTransform transform = btTransform::getIdentity();
    };

    btDiscreteDynamicsWorld& world_;
    std::vector<Middle> middles_; ///< in the order of the bodies
    bool moved_ = false;
    DrivenWays* ways_ = nullptr;
    btScalar end_ = 0; ///< of the tick, in its frame [s]
};

} // namespace ductile::bullet

#ifndef DUCTILE_COMPILED
#include "ductile/bullet/half_ahead.ipp"
#endif
