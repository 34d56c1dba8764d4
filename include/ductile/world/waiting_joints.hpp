// SPDX-License-Identifier: MIT
//
// Joints that were made and that nobody has put into a world yet. Such a joint does nothing, and no
// engine knows of it; but a World that steps its bodies can say so.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <functional>
#include <mutex>
#include <unordered_map>

#include "ductile/vocabulary/linkage.hpp"

namespace ductile {

/// Of the whole program. Thread-safe; free where nobody waits.
class WaitingJoints {
  public:
    using Bodies = std::array<const void*, 2>; ///< addresses, never read

    static WaitingJoints& all();

    void enter(const void* joint, const Bodies& bodies);
    void leave(const void* joint);
    /// Takes out all joints of which is_here(body) is true for a body: how many.
    std::size_t take(const std::function<bool(const void*)>& is_here);

  private:
    std::mutex mutex_;
    std::unordered_map<const void*, Bodies> bodies_;
    std::atomic<std::size_t> count_ = 0;
};

} // namespace ductile

#ifndef DUCTILE_COMPILED
#include "ductile/world/waiting_joints.ipp"
#endif
