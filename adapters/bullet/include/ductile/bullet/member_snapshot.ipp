// SPDX-License-Identifier: MIT
//
// Bodies of member_snapshot.hpp.
#pragma once

#include <stdexcept>

#include "ductile/bullet/convert.hpp"
#include "ductile/bullet/member_snapshot.hpp"

namespace ductile::bullet {

DUCTILE_INLINE MemberSnapshot::MemberSnapshot(const Member& member) : saved_(member.save()) {
    for (const PieceBody& piece : member.pieces_) {
        bodies_.push_back({piece.body->getCenterOfMassTransform(), piece.body->getLinearVelocity(),
                           piece.body->getAngularVelocity()});
    }
}

DUCTILE_INLINE void MemberSnapshot::put_back(Member& member) const {
    if (member.world_ == nullptr) {
        throw std::logic_error("MemberSnapshot.member: must be in a World");
    }
    member.put_back(saved_);
    const MemberCourse& course = member.course_;
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
    for (Member::Attachment& attachment : member.attachments_) attachment.drop(*member.world_);
    for (PieceBody& piece : member.pieces_) piece.run = {no_section, no_section};
    member.become(pieces, {});
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        if (course.pieces()[i].held) continue;
        btRigidBody& body = *member.pieces_[i].body;
        body.setCenterOfMassTransform(bodies_[i].pose);
        body.setInterpolationWorldTransform(bodies_[i].pose);
        set_motion(body, {to_core(bodies_[i].velocity), to_core(bodies_[i].spin)});
    }
    member.put_joints_back(saved_);
    member.rearranged_();
}

} // namespace ductile::bullet
