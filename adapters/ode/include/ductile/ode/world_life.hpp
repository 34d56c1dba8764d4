// SPDX-License-Identifier: MIT
//
// Whether an ODE world still is. dWorldDestroy takes all bodies and joints with it and tells
// nobody; but a joint of a joint group stays as it was, attached to nothing. One such joint, to a
// disabled body that nothing can touch, is kept for each world that holds plastic joints.
//
// Where a world goes before its plastic joints, ODE says so on its message channel, once.
#pragma once

#include <ode/ode.h>

#include <memory>

#include "ductile/vocabulary/linkage.hpp"

namespace ductile::ode {

class WorldLife {
  public:
    /// Of the world, shared by all who ask. Thread-safe.
    [[nodiscard]] static std::shared_ptr<const WorldLife> of(dWorldID world);

    explicit WorldLife(dWorldID world);
    DUCTILE_INLINE ~WorldLife();
    WorldLife(const WorldLife&) = delete;
    WorldLife& operator=(const WorldLife&) = delete;

    /// False from dWorldDestroy on.
    [[nodiscard]] bool goes_on() const { return dJointGetBody(witness_, 0) != nullptr; }

  private:
    dBodyID body_;
    dJointGroupID group_;
    dJointID witness_;
};

} // namespace ductile::ode

#ifndef DUCTILE_COMPILED
#include "ductile/ode/world_life.ipp"
#endif
