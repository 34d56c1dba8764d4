// SPDX-License-Identifier: MIT
//
// Bodies of member_snapshot.hpp.
#pragma once

#include <stdexcept>
#include <string>

#include "ductile/bullet/convert.hpp"
#include "ductile/bullet/member_snapshot.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile::bullet {

DUCTILE_INLINE MemberSnapshot::MemberSnapshot(const Member& member)
    : state_(member.state()),
      vibration_(member.course_.vibration()),
      redundant_(member.course_.redundant()) {
    for (const PieceBody& piece : member.pieces_) {
        bodies_.push_back({piece.body->getCenterOfMassTransform(), piece.body->getLinearVelocity(),
                           piece.body->getAngularVelocity()});
    }
    for (std::size_t i = 0; i + 1 < member.pieces_.size(); ++i) {
        for (const OpenSection& open : member.joints_) {
            if (open.section == member.pieces_[i].run.last) joints_.push_back(open.hinge->state());
        }
    }
}

DUCTILE_INLINE void MemberSnapshot::put_back(Member& member) const {
    if (member.world_ == nullptr) {
        throw std::logic_error("MemberSnapshot.member: must be in a World");
    }
    const int sections = member.description().sections();
    if (state_.size() != std::size_t(sections)) {
        check::fail("MemberSnapshot.member.sections", double(sections), "",
                    std::to_string(state_.size()) + ", as of the member that was saved");
    }
    MemberCourse& course = member.course_;
    course.restore(state_);
    course.restore(vibration_);
    course.restore(redundant_);
    std::vector<PlacedPiece> pieces;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        const MemberPiece& piece = course.pieces()[i];
        PlacedPiece& placed_piece = pieces.emplace_back();
        placed_piece.piece = &piece;
        placed_piece.pose = piece.held ? member.held_ : to_core(bodies_[i].pose);
        if (bodies_.size() == 1 && !piece.held && course.is_straight()) {
            placed_piece.pose = placed(placed_piece.pose, member.maker_->first_in_body());
        }
        if (piece.held) continue;
        placed_piece.motion = {to_core(bodies_[i].velocity), to_core(bodies_[i].spin)};
    }
    // all anew: what follows must not hang on what there is now
    member.joints_.clear();
    for (Member::Attachment& attachment : member.attachments_) member.drop_attachment(attachment);
    for (PieceBody& piece : member.pieces_) piece.run = {no_section, no_section};
    member.become(pieces, {});
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        if (course.pieces()[i].held) continue;
        btRigidBody& body = *member.pieces_[i].body;
        body.setCenterOfMassTransform(bodies_[i].pose);
        body.setInterpolationWorldTransform(bodies_[i].pose);
        set_motion(body, {to_core(bodies_[i].velocity), to_core(bodies_[i].spin)});
    }
    for (std::size_t i = 0; i < joints_.size(); ++i) {
        member.joints_[i].hinge->restore(joints_[i]);
    }
    member.rearranged_();
}

} // namespace ductile::bullet
