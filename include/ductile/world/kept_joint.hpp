// SPDX-License-Identifier: MIT
//
// Who looks after joints, and the joints that it looks after: whichever ends first, neither is left
// with the address of the other.
#pragma once

#include <functional>
#include <vector>

#include "ductile/vocabulary/linkage.hpp"
#include "ductile/world/structures.hpp"

namespace ductile {

class JointKeeper;

/// What an engine's constraint is beside its joint. Not thread-safe.
class KeptJoint : public StructureMember {
  public:
    KeptJoint(const KeptJoint&) = delete;
    KeptJoint& operator=(const KeptJoint&) = delete;

  protected:
    KeptJoint() = default;
    DUCTILE_INLINE ~KeptJoint() override;
    /// Until it comes into a world, Worlds that have one of the bodies may say that it is missing.
    void wait_for_world(const void* a, const void* b);
    void came_into_world();
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
    DUCTILE_INLINE virtual ~JointKeeper();
    /// `forget` is called where the joint ends before `let_go`.
    void keep(KeptJoint& joint, std::function<void()> forget);
    void let_go(KeptJoint& joint);
    /// As Structures'.
    void set_rest_damping(double damping) noexcept { structures_.set_damping(damping); }
    /// Before a step, and after it or a part that stands.
    void look_at_structures() { structures_.look(); }

  private:
    friend class KeptJoint;

    /// The engine steps a joint now, whoever asked for it. May come from any thread of the engine.
    virtual void joint_stepped() {}

    void forget_me(KeptJoint& joint);

    std::vector<KeptJoint*> joints_;
    Structures structures_;
};

} // namespace ductile

#ifndef DUCTILE_COMPILED
#include "ductile/world/kept_joint.ipp"
#endif
