// SPDX-License-Identifier: MIT
//
// Bodies of waiting_joints.hpp.
#pragma once

#include "ductile/world/waiting_joints.hpp"

namespace ductile {

DUCTILE_INLINE WaitingJoints& WaitingJoints::all() {
    static WaitingJoints waiting;
    return waiting;
}
DUCTILE_INLINE void WaitingJoints::enter(const void* joint, const Bodies& bodies) {
    const std::lock_guard lock(mutex_);
    bodies_[joint] = bodies;
    count_ = bodies_.size();
}
DUCTILE_INLINE void WaitingJoints::leave(const void* joint) {
    if (count_ == 0) return;
    const std::lock_guard lock(mutex_);
    bodies_.erase(joint);
    count_ = bodies_.size();
}
DUCTILE_INLINE std::size_t WaitingJoints::take(const std::function<bool(const void*)>& is_here) {
    if (count_ == 0) return 0;
    const std::lock_guard lock(mutex_);
    const std::size_t taken = std::erase_if(bodies_, [&](const auto& entry) {
        return is_here(entry.second[0]) || is_here(entry.second[1]);
    });
    count_ = bodies_.size();
    return taken;
}

} // namespace ductile
