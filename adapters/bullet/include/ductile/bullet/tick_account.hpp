// SPDX-License-Identifier: MIT
//
// The plastic joints of one Bullet world at the end of a tick: all book it, share what they took
// (world/share_work.hpp), and only then those that broke let go. Bullet calls the action of each
// joint; that of the first does it for all.
//
// Not thread-safe: actions are called by one thread.
#pragma once

#include <BulletDynamics/Dynamics/btDynamicsWorld.h>

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "ductile/vocabulary/linkage.hpp"
#include "ductile/world/share_work.hpp"

namespace ductile::bullet {

class TickMember;

/// Of one world; owned by its joints.
class TickAccount {
  private:
    friend class TickMember;
    std::vector<TickMember*> members_;
};

/// A joint of it.
class TickMember : public SharesWork {
  public:
    /// Of joints that were ticked without the rest of their world.
    static void end_tick_of(std::span<TickMember* const> joints);
    TickMember(const TickMember&) = delete;
    TickMember& operator=(const TickMember&) = delete;

  protected:
    TickMember() = default;
    ~TickMember() { leave_account(); }

    void join_account(const btDynamicsWorld& world);
    void leave_account();

    /// From the joint's action.
    void end_tick_of_world();

  private:
    [[nodiscard]] static std::vector<std::size_t> islands_of(std::span<TickMember* const> joints);
    /// Worlds may be in several threads.
    [[nodiscard]] static std::shared_ptr<TickAccount> account_of(const btDynamicsWorld& world);
    /// Books the open tick, with the bodies as they are.
    virtual void end_tick() = 0;
    /// Lets go where that broke the joint.
    virtual void finish_tick() = 0;
    /// Bullet's tag.
    [[nodiscard]] virtual std::size_t island() const = 0;

    std::shared_ptr<TickAccount> account_;
    bool ended_ = false; ///< by the action of another joint
};

} // namespace ductile::bullet

#ifndef DUCTILE_COMPILED
#include "ductile/bullet/tick_account.ipp"
#endif
