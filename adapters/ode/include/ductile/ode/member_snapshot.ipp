// SPDX-License-Identifier: MIT
//
// Bodies of member_snapshot.hpp.
#pragma once

#include <algorithm>
#include <stdexcept>

#include "ductile/ode/convert.hpp"
#include "ductile/ode/member_snapshot.hpp"
#include "ductile/ode/world.hpp"

namespace ductile::ode {

DUCTILE_INLINE MemberSnapshot::MemberSnapshot(const Member& member)
    : saved_(member.save()), pressed_(member.pressed_) {
    for (std::size_t i = 0; i < member.pieces_.size(); ++i) {
        pieces_.push_back({member.frame_of(i), BodySnapshot(member.pieces_[i].body)});
    }
    for (const Member::Hold& hold : member.holds_) {
        const dBodyID first = dJointGetBody(hold.joint, 0);
        const dBodyID other = first == hold.body ? dJointGetBody(hold.joint, 1) : first;
        holds_.push_back({hold.joint, JointPlace(hold.joint), hold.wrench, other});
        if (other != nullptr) holds_.back().other_was.emplace(other);
    }
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
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
        pieces.push_back({&course.pieces()[i], pieces_[i].pose, {}});
    }
    for (Member::PieceBody& piece : member.pieces_) piece.run = {no_section, no_section};
    member.become(pieces, false);
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
        pieces_[i].body.put_back(member.pieces_[i].body);
    }
    member.put_joints_back(saved_);
    for (const Hold& hold : holds_) hold_again(hold, member);
    member.pressed_ = pressed_;
    member.world_->members_->rearranged();
}

/// Its pieces are where they were, what it holds on to may be elsewhere.
DUCTILE_INLINE void MemberSnapshot::hold_again(const Hold& hold, Member& member) {
    const auto now = std::find_if(member.holds_.begin(), member.holds_.end(),
                                  [&](const Member::Hold& one) { return one.joint == hold.joint; });
    if (now == member.holds_.end()) return;
    const dBodyID first = dJointGetBody(hold.joint, 0), second = dJointGetBody(hold.joint, 1);
    if (hold.other != (first == now->body ? second : first)) return;
    std::optional<BodySnapshot> other_is;
    if (hold.other != nullptr) {
        other_is.emplace(hold.other);
        hold.other_was->put_pose_back(hold.other);
    }
    hold.place.attach(hold.joint, first, second, now->body);
    if (hold.other != nullptr) other_is->put_pose_back(hold.other);
    now->wrench = hold.wrench;
}

} // namespace ductile::ode
