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
#include <mutex>
#include <unordered_map>

namespace ductile::ode {

class WorldLife {
  public:
    /// Of the world, shared by all who ask. Thread-safe.
    [[nodiscard]] static std::shared_ptr<const WorldLife> of(dWorldID world) {
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

    explicit WorldLife(dWorldID world)
        : body_(dBodyCreate(world)),
          group_(dJointGroupCreate(0)),
          witness_(dJointCreateBall(world, group_)) {
        dBodyDisable(body_);
        dJointAttach(witness_, body_, nullptr);
    }
    ~WorldLife() {
        if (goes_on()) dBodyDestroy(body_);
        dJointGroupDestroy(group_);
    }
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
