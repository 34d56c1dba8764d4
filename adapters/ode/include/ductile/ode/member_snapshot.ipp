// SPDX-License-Identifier: MIT
//
// Bodies of member_snapshot.hpp.
#pragma once

#include <stdexcept>

#include "ductile/ode/member_snapshot.hpp"
#include "ductile/ode/world.hpp"

namespace ductile::ode {

DUCTILE_INLINE MemberSnapshot::MemberSnapshot(const Member& member)
    : saved_(member.save(bodies_of(member))), pressed_(member.pressed_) {
    for (const MemberBody& piece : member.pieces_) bodies_.emplace_back(piece.body);
    for (const Member::Hold& hold : member.holds_) holds_.emplace_back(hold);
}

DUCTILE_INLINE std::vector<PlacedBody> MemberSnapshot::bodies_of(const Member& member) {
    std::vector<PlacedBody> bodies;
    for (std::size_t i = 0; i < member.pieces_.size(); ++i) {
        bodies.push_back({member.frame_of(i), detail::motion_of(member.pieces_[i].body)});
    }
    return bodies;
}

DUCTILE_INLINE void MemberSnapshot::put_back(Member& member) const {
    if (member.world_ == nullptr) {
        throw std::logic_error("MemberSnapshot.member: must be in a World");
    }
    member.find_holds();
    const bool was_whole = member.whole();
    member.put_back(saved_);
    const MemberCourse& course = member.course_;
    if (was_whole && course.whole() && !course.member().clamped()) member.take_out();
    member.geoms_->put_straight();
    std::vector<PlacedPiece> pieces;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        pieces.push_back({&course.pieces()[i], saved_.bodies[i].pose, {}});
    }
    for (MemberBody& piece : member.pieces_) piece.run = {no_section, no_section};
    member.become(pieces, false);
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        bodies_[i].put_back(member.pieces_[i].body);
    }
    member.put_joints_back(saved_);
    for (const SavedHold& hold : holds_) {
        for (Member::Hold& now : member.holds_) (void)hold.put_back(now);
    }
    member.pressed_ = pressed_;
    member.world_->members_->rearranged();
}

} // namespace ductile::ode
