// SPDX-License-Identifier: MIT
//
// Bodies of tick_account.hpp.
#pragma once

#include <mutex>
#include <unordered_map>
#include <utility>

#include "ductile/bullet/tick_account.hpp"

namespace ductile::bullet {

DUCTILE_INLINE void TickMember::end_tick_of(std::span<TickMember* const> joints) {
    for (TickMember* joint : joints) joint->end_tick();
    share_work(joints, [joints] { return islands_of(joints); });
    for (TickMember* joint : joints) joint->finish_tick();
}
DUCTILE_INLINE void TickMember::join_account(const btDynamicsWorld& world) {
    leave_account();
    account_ = account_of(world);
    account_->members_.push_back(this);
}
DUCTILE_INLINE void TickMember::leave_account() {
    if (account_ != nullptr) std::erase(account_->members_, this);
    account_.reset();
}
DUCTILE_INLINE void TickMember::end_tick_of_world() {
    if (std::exchange(ended_, false)) return;
    const std::vector<TickMember*>& all = account_->members_;
    for (TickMember* joint : all) {
        joint->end_tick();
        joint->ended_ = joint != this;
    }
    share_work(std::span<TickMember* const>(all), [&all] { return islands_of(all); });
    for (TickMember* joint : all) joint->finish_tick();
}
DUCTILE_INLINE std::vector<std::size_t> TickMember::islands_of(
    std::span<TickMember* const> joints) {
    std::vector<std::size_t> islands;
    for (const TickMember* joint : joints) islands.push_back(joint->island());
    return islands;
}
DUCTILE_INLINE std::shared_ptr<TickAccount> TickMember::account_of(const btDynamicsWorld& world) {
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

} // namespace ductile::bullet
