// SPDX-License-Identifier: MIT
//
// Bodies of world_snapshot.hpp.
#pragma once

#include <algorithm>

#include "ductile/ode/world_snapshot.hpp"

namespace ductile::ode {

DUCTILE_INLINE void WorldSnapshot::take(std::span<const dBodyID> bodies,
                                        std::span<PlasticConstraint* const> joints) {
    bodies_.clear();
    for (dBodyID body : bodies) {
        Body& kept = bodies_.emplace_back();
        kept.body = body;
        kept.enabled = dBodyIsEnabled(body) != 0;
        std::copy_n(dBodyGetPosition(body), 3, kept.place.begin());
        std::copy_n(dBodyGetLinearVel(body), 3, kept.velocity.begin());
        std::copy_n(dBodyGetAngularVel(body), 3, kept.spin.begin());
        std::copy_n(dBodyGetQuaternion(body), 4, kept.quaternion.begin());
        std::copy_n(dBodyGetRotation(body), 12, kept.matrix.begin());
    }
    joints_.assign(joints.begin(), joints.end());
    for (PlasticConstraint* joint : joints_) joint->keep_all();
    seed_ = dRandGetSeed();
}

DUCTILE_INLINE void WorldSnapshot::put_poses_back() const {
    for (const Body& kept : bodies_) {
        // tells the body's geoms that it moved
        dBodySetPosition(kept.body, kept.place[0], kept.place[1], kept.place[2]);
        std::copy(kept.quaternion.begin(), kept.quaternion.end(),
                  const_cast<dReal*>(dBodyGetQuaternion(kept.body)));
        std::copy(kept.matrix.begin(), kept.matrix.end(),
                  const_cast<dReal*>(dBodyGetRotation(kept.body)));
    }
}

DUCTILE_INLINE void WorldSnapshot::put_back() {
    put_poses_back();
    for (const Body& kept : bodies_) {
        dBodySetLinearVel(kept.body, kept.velocity[0], kept.velocity[1], kept.velocity[2]);
        dBodySetAngularVel(kept.body, kept.spin[0], kept.spin[1], kept.spin[2]);
        dBodySetForce(kept.body, 0, 0, 0);
        dBodySetTorque(kept.body, 0, 0, 0);
        if (kept.enabled == (dBodyIsEnabled(kept.body) != 0)) continue;
        kept.enabled ? dBodyEnable(kept.body) : dBodyDisable(kept.body);
    }
    for (PlasticConstraint* joint : joints_) joint->put_all_back();
    dRandSetSeed(seed_);
}

} // namespace ductile::ode
