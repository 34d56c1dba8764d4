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
#include <mutex>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

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
    static void end_tick_of(std::span<TickMember* const> joints) {
        for (TickMember* joint : joints) joint->end_tick();
        share_work(joints, [joints] { return islands_of(joints); });
        for (TickMember* joint : joints) joint->finish_tick();
    }
    TickMember(const TickMember&) = delete;
    TickMember& operator=(const TickMember&) = delete;

  protected:
    TickMember() = default;
    ~TickMember() { leave_account(); }

    void join_account(const btDynamicsWorld& world) {
        leave_account();
        account_ = account_of(world);
        account_->members_.push_back(this);
    }
    void leave_account() {
        if (account_ != nullptr) std::erase(account_->members_, this);
        account_.reset();
    }

    /// From the joint's action.
    void end_tick_of_world() {
        if (std::exchange(ended_, false)) return;
        const std::vector<TickMember*>& all = account_->members_;
        for (TickMember* joint : all) {
            joint->end_tick();
            joint->ended_ = joint != this;
        }
        share_work(std::span<TickMember* const>(all), [&all] { return islands_of(all); });
        for (TickMember* joint : all) joint->finish_tick();
    }

  private:
    [[nodiscard]] static std::vector<std::size_t> islands_of(std::span<TickMember* const> joints) {
        std::vector<std::size_t> islands;
        for (const TickMember* joint : joints) islands.push_back(joint->island());
        return islands;
    }
    /// Worlds may be in several threads.
    [[nodiscard]] static std::shared_ptr<TickAccount> account_of(const btDynamicsWorld& world) {
        static std::mutex mutex;
        static std::unordered_map<const btDynamicsWorld*, std::weak_ptr<TickAccount>> accounts;
        const std::lock_guard lock(mutex);
        std::shared_ptr<TickAccount> account = accounts[&world].lock();
        if (account != nullptr) return account;
        std::erase_if(accounts, [](const auto& entry) { return entry.second.expired(); });
        account = std::make_shared<TickAccount>();
        accounts[&world] = account;
        return account;
    }
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
