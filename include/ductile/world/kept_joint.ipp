// SPDX-License-Identifier: MIT
//
// Bodies of kept_joint.hpp.
#pragma once

#include <utility>

#include "ductile/world/kept_joint.hpp"
#include "ductile/world/waiting_joints.hpp"

namespace ductile {

DUCTILE_INLINE KeptJoint::~KeptJoint() {
    came_into_world();
    leave_keepers();
}
DUCTILE_INLINE void KeptJoint::leave_keepers() {
    for (auto& [keeper, forget] : std::exchange(keepers_, {})) {
        std::erase(keeper->joints_, this);
        keeper->structures_.remove(*this);
        forget();
    }
}

DUCTILE_INLINE void KeptJoint::tell_keepers_of_step() const {
    for (const Kept& kept : keepers_) kept.keeper->joint_stepped();
}

DUCTILE_INLINE void KeptJoint::wait_for_world(const void* a, const void* b) {
    waits_ = true;
    WaitingJoints::all().enter(this, {a, b});
}
DUCTILE_INLINE void KeptJoint::came_into_world() {
    if (std::exchange(waits_, false)) WaitingJoints::all().leave(this);
}
DUCTILE_INLINE void JointKeeper::keep(KeptJoint& joint, std::function<void()> forget) {
    joint.keepers_.push_back({this, std::move(forget)});
    joints_.push_back(&joint);
    structures_.add(joint);
}
DUCTILE_INLINE void JointKeeper::let_go(KeptJoint& joint) {
    forget_me(joint);
    std::erase(joints_, &joint);
    structures_.remove(joint);
}
DUCTILE_INLINE void JointKeeper::forget_me(KeptJoint& joint) {
    std::erase_if(joint.keepers_, [this](const auto& kept) { return kept.keeper == this; });
}
DUCTILE_INLINE JointKeeper::~JointKeeper() {
    for (KeptJoint* joint : joints_) forget_me(*joint);
}

} // namespace ductile
