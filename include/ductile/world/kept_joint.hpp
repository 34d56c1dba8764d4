// SPDX-License-Identifier: MIT
//
// Who looks after joints, and the joints that it looks after: whichever ends first, neither is left
// with the address of the other.
#pragma once

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

#include "ductile/world/structures.hpp"
#include "ductile/world/waiting_joints.hpp"

namespace ductile {

class JointKeeper;

/// What an engine's constraint is beside its joint. Not thread-safe.
class KeptJoint : public StructureMember {
  public:
    KeptJoint(const KeptJoint&) = delete;
    KeptJoint& operator=(const KeptJoint&) = delete;

  protected:
    KeptJoint() = default;
    ~KeptJoint() override {
        came_into_world();
        leave_keepers();
    }
    /// Until it comes into a world, Worlds that have one of the bodies may say that it is missing.
    void wait_for_world(const void* a, const void* b) {
        waits_ = true;
        WaitingJoints::all().enter(this, {a, b});
    }
    void came_into_world() {
        if (std::exchange(waits_, false)) WaitingJoints::all().leave(this);
    }
    /// For a destructor, while what its keepers read of the joint is there.
    void leave_keepers();
    /// The engine steps the joint now.
    void tell_keepers_of_step() const;

  private:
    friend class JointKeeper;
    struct Kept {
        JointKeeper* keeper;
        std::function<void()> forget;
    };
    std::vector<Kept> keepers_;
    bool waits_ = false;
};

/// What the World of an adapter is beside its engine.
class JointKeeper {
  public:
    JointKeeper(const JointKeeper&) = delete;
    JointKeeper& operator=(const JointKeeper&) = delete;

  protected:
    JointKeeper() = default;
    virtual ~JointKeeper() {
        for (KeptJoint* joint : joints_) forget_me(*joint);
    }
    /// `forget` is called where the joint ends before `let_go`.
    void keep(KeptJoint& joint, std::function<void()> forget) {
        joint.keepers_.push_back({this, std::move(forget)});
        joints_.push_back(&joint);
        structures_.add(joint);
    }
    void let_go(KeptJoint& joint) {
        forget_me(joint);
        std::erase(joints_, &joint);
        structures_.remove(joint);
    }
    /// As Structures'.
    void set_rest_damping(double damping) noexcept { structures_.set_damping(damping); }
    /// Before a step, and after it or a part that stands.
    void look_at_structures() { structures_.look(); }

  private:
    friend class KeptJoint;

    /// The engine steps a joint now, whoever asked for it. May come from any thread of the engine.
    virtual void joint_stepped() {}

    void forget_me(KeptJoint& joint) {
        std::erase_if(joint.keepers_, [this](const auto& kept) { return kept.keeper == this; });
    }

    std::vector<KeptJoint*> joints_;
    Structures structures_;
};

inline void KeptJoint::leave_keepers() {
    for (auto& [keeper, forget] : std::exchange(keepers_, {})) {
        std::erase(keeper->joints_, this);
        keeper->structures_.remove(*this);
        forget();
    }
}

inline void KeptJoint::tell_keepers_of_step() const {
    for (const Kept& kept : keepers_) kept.keeper->joint_stepped();
}

} // namespace ductile
