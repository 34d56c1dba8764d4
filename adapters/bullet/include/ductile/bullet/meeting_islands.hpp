// SPDX-License-Identifier: MIT
//
// Bullet's islands of bodies whose bounds overlap now, by which it puts them to sleep. Its own are
// of pairs that its broadphase has not yet dropped, which depends on what was tried meanwhile.
//
// Not for worlds with an island manager of another kind, as that of threads is: theirs stays.
//
// Not thread-safe.
#pragma once

#include <BulletCollision/CollisionDispatch/btSimulationIslandManager.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include "ductile/vocabulary/linkage.hpp"

namespace ductile::bullet {

class MeetingIslands final : public btSimulationIslandManager {
  public:
    /// Takes the place of the world's manager; the world ends it where nobody did before. Null
    /// where the world's stays.
    [[nodiscard]] static MeetingIslands* enter(btDiscreteDynamicsWorld& world);
    /// Gives the place back and ends this; the world must be alive.
    void leave(btDiscreteDynamicsWorld& world);

    DUCTILE_INLINE void updateActivationState(btCollisionWorld* world,
                                              btDispatcher* dispatcher) override;

  private:
    MeetingIslands(btSimulationIslandManager& usual, bool owned) : usual_(&usual), owned_(owned) {}
    DUCTILE_INLINE ~MeetingIslands() override;

    btSimulationIslandManager* usual_; ///< null once it was given back
    bool owned_;
};

} // namespace ductile::bullet

#ifndef DUCTILE_COMPILED
#include "ductile/bullet/meeting_islands.ipp"
#endif
