// SPDX-License-Identifier: MIT
//
// Bodies of world_life.hpp.
#pragma once

#include <mutex>
#include <unordered_map>

#include "ductile/ode/world_life.hpp"

namespace ductile::ode {

DUCTILE_INLINE WorldLife::WorldLife(dWorldID world)
    : body_(dBodyCreate(world)),
      group_(dJointGroupCreate(0)),
      witness_(dJointCreateBall(world, group_)) {
    dBodyDisable(body_);
    dJointAttach(witness_, body_, nullptr);
}

DUCTILE_INLINE WorldLife::~WorldLife() {
    if (goes_on()) dBodyDestroy(body_);
    dJointGroupDestroy(group_);
}

DUCTILE_INLINE std::shared_ptr<const WorldLife> WorldLife::of(dWorldID world) {
    static std::mutex mutex;
    static std::unordered_map<dWorldID, std::weak_ptr<const WorldLife>> known;
    const std::lock_guard lock(mutex);
    std::erase_if(known, [](const auto& entry) { return entry.second.expired(); });
    std::weak_ptr<const WorldLife>& entry = known[world];
    std::shared_ptr<const WorldLife> life = entry.lock();
    // ODE may make a new world where an old one was
    if (life == nullptr || !life->goes_on()) entry = life = std::make_shared<WorldLife>(world);
    return life;
}

} // namespace ductile::ode
