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

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

#include "ductile/ode/plastic_constraint.hpp"
#include "ductile/vocabulary/address_book.hpp"

namespace ductile::ode {

/// A body as it is, to the last bit. Plain value.
class BodySnapshot {
  public:
    explicit BodySnapshot(dBodyID body) : enabled_(dBodyIsEnabled(body) != 0) {
        std::copy_n(dBodyGetPosition(body), 3, place_.begin());
        std::copy_n(dBodyGetLinearVel(body), 3, velocity_.begin());
        std::copy_n(dBodyGetAngularVel(body), 3, spin_.begin());
        std::copy_n(dBodyGetQuaternion(body), 4, quaternion_.begin());
        std::copy_n(dBodyGetRotation(body), 12, matrix_.begin());
    }
    void put_pose_back(dBodyID body) const {
        // tells the body's geoms that it moved
        dBodySetPosition(body, place_[0], place_[1], place_[2]);
        std::copy(quaternion_.begin(), quaternion_.end(),
                  const_cast<dReal*>(dBodyGetQuaternion(body)));
        std::copy(matrix_.begin(), matrix_.end(), const_cast<dReal*>(dBodyGetRotation(body)));
    }
    /// Its forces are zero then.
    void put_back(dBodyID body) const {
        put_pose_back(body);
        dBodySetLinearVel(body, velocity_[0], velocity_[1], velocity_[2]);
        dBodySetAngularVel(body, spin_[0], spin_[1], spin_[2]);
        dBodySetForce(body, 0, 0, 0);
        dBodySetTorque(body, 0, 0, 0);
        if (enabled_ == (dBodyIsEnabled(body) != 0)) return;
        enabled_ ? dBodyEnable(body) : dBodyDisable(body);
    }

  private:
    std::array<dReal, 3> place_, velocity_, spin_;
    std::array<dReal, 4> quaternion_;
    std::array<dReal, 12> matrix_; ///< by rows of four
    bool enabled_;
};

class WorldSnapshot {
  public:
    void take(std::span<const dBodyID> bodies, std::span<PlasticConstraint* const> joints) {
        bodies_.clear();
        for (dBodyID body : bodies) bodies_.emplace_back(body, body);
        joints_.assign(joints.begin(), joints.end());
        for (PlasticConstraint* joint : joints_) joint->keep_all();
        seed_ = dRandGetSeed();
    }
    /// To what was last taken. The bodies' forces are zero then.
    void put_back() {
        for (const auto& [body, as_it_was] : bodies_) as_it_was.put_back(body);
        for (PlasticConstraint* joint : joints_) joint->put_all_back();
        dRandSetSeed(seed_);
    }
    /// Some of the bodies alone.
    void put_back(std::span<const dBodyID> bodies) const {
        AddressBook some;
        for (dBodyID body : bodies) some.enter(body);
        for (const auto& [body, as_it_was] : bodies_) {
            if (some.has(body)) as_it_was.put_back(body);
        }
    }
    /// The poses alone.
    void put_poses_back() const {
        for (const auto& [body, as_it_was] : bodies_) as_it_was.put_pose_back(body);
    }

  private:
    std::vector<std::pair<dBodyID, BodySnapshot>> bodies_;
    std::vector<PlasticConstraint*> joints_;
    unsigned long seed_ = 0;
};

} // namespace ductile::ode
