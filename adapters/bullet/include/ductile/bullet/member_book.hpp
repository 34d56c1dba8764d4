// SPDX-License-Identifier: MIT
//
// Which member a body belongs to, of the whole program. Thread-safe.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>

#include <mutex>
#include <unordered_map>

namespace ductile::bullet {

class Member;

namespace detail {

/// Members by their bodies, of the whole program.
class MemberBook {
  public:
    static MemberBook& all() {
        static MemberBook book;
        return book;
    }
    void enter(const btCollisionObject* object, Member* member) {
        const std::lock_guard lock(mutex_);
        members_[object] = member;
    }
    void leave(const btCollisionObject* object) {
        const std::lock_guard lock(mutex_);
        members_.erase(object);
    }
    [[nodiscard]] Member* find(const btCollisionObject* object) {
        const std::lock_guard lock(mutex_);
        const auto found = members_.find(object);
        return found != members_.end() ? found->second : nullptr;
    }

  private:
    std::mutex mutex_;
    std::unordered_map<const btCollisionObject*, Member*> members_;
};

} // namespace detail

} // namespace ductile::bullet
