// SPDX-License-Identifier: MIT
//
// Bodies of member_snapshot.hpp.
#pragma once

#include <stdexcept>

#include "ductile/bullet/convert.hpp"
#include "ductile/bullet/member_snapshot.hpp"

namespace ductile::bullet {

DUCTILE_INLINE MemberSnapshot::MemberSnapshot(const Member& member)
    : saved_(member.save(bodies_of(member))) {}

DUCTILE_INLINE std::vector<PlacedBody> MemberSnapshot::bodies_of(const Member& member) {
    std::vector<PlacedBody> bodies;
    for (const PieceBody& piece : member.pieces_) {
        const btRigidBody& body = *piece.body;
        bodies.push_back({to_core(body.getCenterOfMassTransform()),
                          {to_core(body.getLinearVelocity()), to_core(body.getAngularVelocity())}});
    }
    return bodies;
}

DUCTILE_INLINE void MemberSnapshot::put_back(Member& member) const {
    if (member.world_ == nullptr) {
        throw std::logic_error("MemberSnapshot.member: must be in a World");
    }
    member.put_back(saved_);
    const MemberCourse& course = member.course_;
    std::vector<PlacedPiece> pieces;
    for (std::size_t i = 0; i < saved_.bodies.size(); ++i) {
        const MemberPiece& piece = course.pieces()[i];
        PlacedPiece& placed_piece = pieces.emplace_back();
        placed_piece.piece = &piece;
        placed_piece.pose = piece.held ? member.held_ : saved_.bodies[i].pose;
        if (saved_.bodies.size() == 1 && !piece.held && course.is_straight()) {
            placed_piece.pose = placed(placed_piece.pose, member.maker_->first_in_body());
        }
        if (piece.held) continue;
        placed_piece.motion = saved_.bodies[i].motion;
    }
    for (Member::Hold& hold : member.holds_) hold.drop(*member.world_);
    for (PieceBody& piece : member.pieces_) piece.run = {no_section, no_section};
    member.become(pieces, {});
    for (std::size_t i = 0; i < saved_.bodies.size(); ++i) {
        if (course.pieces()[i].held) continue;
        btRigidBody& body = *member.pieces_[i].body;
        const btTransform pose = to_bullet(saved_.bodies[i].pose);
        body.setCenterOfMassTransform(pose);
        body.setInterpolationWorldTransform(pose);
        set_motion(body, saved_.bodies[i].motion);
    }
    member.put_joints_back(saved_);
    member.rearranged_();
}

} // namespace ductile::bullet
