// SPDX-License-Identifier: MIT
//
// A member as it was, open or whole, kept and put back:
//
//   const ductile::bullet::MemberSnapshot saved(post);
//   ...
//   saved.put_back(post);
//
// As many bodies as then, where they were, with the velocities that they had. With all else put
// back, too, every run from there is the same bit for bit in steps without a tolerance; contacts
// begin cold.
#pragma once

#include <vector>

#include "ductile/bullet/member.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::bullet {

/// Plain value.
class MemberSnapshot {
  public:
    explicit MemberSnapshot(const Member& member);
    /// Between steps.
    /// @throws std::invalid_argument where the member has other sections, or a body that was saved
    /// was nowhere or moved at no finite velocity; std::logic_error where it
    /// is in no World.
    void put_back(Member& member) const;

  private:
    [[nodiscard]] static std::vector<PlacedBody> bodies_of(const Member& member);
    Member::Saved saved_;
};

} // namespace ductile::bullet

#ifndef DUCTILE_COMPILED
#include "ductile/bullet/member_snapshot.ipp"
#endif
