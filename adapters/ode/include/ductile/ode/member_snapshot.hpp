// SPDX-License-Identifier: MIT
//
// A member as it was, open or whole, kept and put back:
//
//   const ductile::ode::MemberSnapshot saved(post);
//   ...
//   saved.put_back(post);
//
// As many bodies as then, where they were, with the velocities that they had; joints of the user's
// hold where they held. With all else put back, too, every run from there is the same bit for bit
// in steps without a tolerance.
#pragma once

#include <ode/ode.h>

#include <vector>

#include "ductile/ode/member.hpp"
#include "ductile/ode/user_joint.hpp"
#include "ductile/ode/world_snapshot.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::ode {

/// Plain value.
class MemberSnapshot {
  public:
    explicit MemberSnapshot(const Member& member);
    /// Between steps. Joints of the user's that there are no more are left out; what holds a joint
    /// at its other end need not be put back before.
    /// @throws std::invalid_argument where the member has other sections, or a body that was saved
    /// was nowhere or moved at no finite velocity; std::logic_error where it is in no World.
    void put_back(Member& member) const;

  private:
    [[nodiscard]] static std::vector<PlacedBody> bodies_of(const Member& member);
    Member::Saved saved_;
    std::vector<BodySnapshot> bodies_; ///< by piece
    std::vector<SavedHold> holds_;
    PressedTouches pressed_;
};

} // namespace ductile::ode

#ifndef DUCTILE_COMPILED
#include "ductile/ode/member_snapshot.ipp"
#endif
