// SPDX-License-Identifier: MIT
//
// All of an ODE world that a part changes, kept and put back bit for bit: what follows is what
// would have followed without whatever was done in between.
//
//   bodies   pose, velocities, whether they are enabled
//   joints   plastic ones, all
//   solver   the seed of ODE's random numbers, by which QuickStep shuffles its rows
//
// Contacts are made anew (contact_maker.hpp, which also keeps geoms in their order), forces are
// held (held_forces.hpp), and falling asleep is the World's (resting_islands.hpp), as ODE's
// counters can be neither read nor written.
//
// Traps of ODE 0.16 that this header deals with
//   - dBodySetQuaternion normalises what it is given, and makes the matrix of it anew: a pose put
//     back so differs in its last bits. Quaternion and matrix are written where ODE has them.
//   - dBodyEnable starts the body's counters: only where it was disabled meanwhile.
//
// No body or joint may come or go between `take` and `put_back`. Not thread-safe.
#pragma once

#include <ode/ode.h>

#include <array>
#include <span>
#include <utility>
#include <vector>

#include "ductile/ode/plastic_constraint.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::ode {

/// A body as it is, to the last bit. Plain value.
class BodySnapshot {
  public:
    explicit BodySnapshot(dBodyID body);
    void put_pose_back(dBodyID body) const;
    /// Its forces are zero then.
    void put_back(dBodyID body) const;

  private:
    std::array<dReal, 3> place_, velocity_, spin_;
    std::array<dReal, 4> quaternion_;
    std::array<dReal, 12> matrix_; ///< by rows of four
    bool enabled_;
};

class WorldSnapshot {
  public:
    void take(std::span<const dBodyID> bodies, std::span<PlasticConstraint* const> joints);
    /// To what was last taken. The bodies' forces are zero then.
    void put_back();
    /// Some of the bodies alone.
    void put_back(std::span<const dBodyID> bodies) const;
    /// The poses alone.
    void put_poses_back() const;

  private:
    std::vector<std::pair<dBodyID, BodySnapshot>> bodies_;
    std::vector<PlasticConstraint*> joints_;
    unsigned long seed_ = 0;
};

} // namespace ductile::ode

#ifndef DUCTILE_COMPILED
#include "ductile/ode/world_snapshot.ipp"
#endif
