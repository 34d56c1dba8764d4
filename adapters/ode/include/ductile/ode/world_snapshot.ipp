// SPDX-License-Identifier: MIT
//
// Bodies of world_snapshot.hpp.
#pragma once

#include <algorithm>

#include "ductile/ode/world_snapshot.hpp"
#include "ductile/vocabulary/address_book.hpp"

namespace ductile::ode {

DUCTILE_INLINE BodySnapshot::BodySnapshot(dBodyID body) : enabled_(dBodyIsEnabled(body) != 0) {
    std::copy_n(dBodyGetPosition(body), 3, place_.begin());
    std::copy_n(dBodyGetLinearVel(body), 3, velocity_.begin());
    std::copy_n(dBodyGetAngularVel(body), 3, spin_.begin());
    std::copy_n(dBodyGetQuaternion(body), 4, quaternion_.begin());
    std::copy_n(dBodyGetRotation(body), 12, matrix_.begin());
}

DUCTILE_INLINE void BodySnapshot::put_pose_back(dBodyID body) const {
    // tells the body's geoms that it moved
    dBodySetPosition(body, place_[0], place_[1], place_[2]);
    std::copy(quaternion_.begin(), quaternion_.end(), const_cast<dReal*>(dBodyGetQuaternion(body)));
    std::copy(matrix_.begin(), matrix_.end(), const_cast<dReal*>(dBodyGetRotation(body)));
}

DUCTILE_INLINE void BodySnapshot::put_back(dBodyID body) const {
    put_pose_back(body);
    dBodySetLinearVel(body, velocity_[0], velocity_[1], velocity_[2]);
    dBodySetAngularVel(body, spin_[0], spin_[1], spin_[2]);
    dBodySetForce(body, 0, 0, 0);
    dBodySetTorque(body, 0, 0, 0);
    if (enabled_ == (dBodyIsEnabled(body) != 0)) return;
    enabled_ ? dBodyEnable(body) : dBodyDisable(body);
}

DUCTILE_INLINE void WorldSnapshot::take(std::span<const dBodyID> bodies,
                                        std::span<PlasticConstraint* const> joints) {
    bodies_.clear();
    for (dBodyID body : bodies) bodies_.emplace_back(body, body);
    joints_.assign(joints.begin(), joints.end());
    for (PlasticConstraint* joint : joints_) joint->keep_all();
    seed_ = dRandGetSeed();
}

DUCTILE_INLINE void WorldSnapshot::put_poses_back() const {
    for (const auto& [body, as_it_was] : bodies_) as_it_was.put_pose_back(body);
}

DUCTILE_INLINE void WorldSnapshot::put_back() {
    for (const auto& [body, as_it_was] : bodies_) as_it_was.put_back(body);
    for (PlasticConstraint* joint : joints_) joint->put_all_back();
    dRandSetSeed(seed_);
}

DUCTILE_INLINE void WorldSnapshot::put_back(std::span<const dBodyID> bodies) const {
    AddressBook some;
    for (dBodyID body : bodies) some.enter(body);
    for (const auto& [body, as_it_was] : bodies_) {
        if (some.has(body)) as_it_was.put_back(body);
    }
}

} // namespace ductile::ode
