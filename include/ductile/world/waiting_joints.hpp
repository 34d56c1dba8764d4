// SPDX-License-Identifier: MIT
//
// Joints that were made and that nobody has put into a world yet. Such a joint does nothing, and no
// engine knows of it; but a World that steps its bodies can say so.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <mutex>
#include <unordered_map>

namespace ductile {

/// Of the whole program. Thread-safe; free where nobody waits.
class WaitingJoints {
  public:
    using Bodies = std::array<const void*, 2>; ///< addresses, never read

    static WaitingJoints& all() {
        static WaitingJoints waiting;
        return waiting;
    }

    void enter(const void* joint, const Bodies& bodies) {
        const std::lock_guard lock(mutex_);
        bodies_[joint] = bodies;
        count_ = bodies_.size();
    }
    void leave(const void* joint) {
        if (count_ == 0) return;
        const std::lock_guard lock(mutex_);
        bodies_.erase(joint);
        count_ = bodies_.size();
    }
    /// Takes out all joints of which is_here(body) is true for a body: how many.
    template <class IsHere>
    std::size_t take(const IsHere& is_here) {
        if (count_ == 0) return 0;
        const std::lock_guard lock(mutex_);
        const std::size_t taken = std::erase_if(bodies_, [&](const auto& entry) {
            return is_here(entry.second[0]) || is_here(entry.second[1]);
        });
        count_ = bodies_.size();
        return taken;
    }

  private:
    std::mutex mutex_;
    std::unordered_map<const void*, Bodies> bodies_;
    std::atomic<std::size_t> count_ = 0;
};

} // namespace ductile
