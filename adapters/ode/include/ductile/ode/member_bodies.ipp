// SPDX-License-Identifier: MIT
//
// Bodies of member.hpp: pieces, the joints between them, what holds on to them. A part of
// member.ipp.
#pragma once

#include "ductile/numeric/lu.hpp"

namespace ductile::ode {

/// The frame of a piece in its body.
DUCTILE_INLINE JointFrame<double> Member::in_body(std::size_t piece) const {
    return pieces_[piece].own ? JointFrame<double>{} : whole_in_body_;
}
DUCTILE_INLINE JointFrame<double> Member::frame_of(std::size_t piece) const {
    return placed(detail::frame_of(pieces_[piece].body), in_body(piece));
}
DUCTILE_INLINE BodyMotion Member::motion_of(std::size_t piece) const {
    return detail::motion_of(pieces_[piece].body);
}
DUCTILE_INLINE Vector3<double> Member::momentum() const {
    return times(inertia(user_), angular_velocity(user_));
}
DUCTILE_INLINE Vector3<double> Member::point_of(const MemberPlace& at) const {
    return placed(pose(at.segment), {.origin = at.in_segment}).origin;
}

DUCTILE_INLINE void Member::become(const std::vector<PlacedPiece>& pieces, bool ahead) {
    const bool was_whole = pieces_.size() == 1;
    std::vector<MemberBody> old = std::exchange(pieces_, {});
    for (const PlacedPiece& placed : pieces) {
        const auto kept = std::find_if(old.begin(), old.end(), [&placed](const MemberBody& piece) {
            return piece.own && piece.run == placed.piece->run;
        });
        if (pieces.size() > 1 && kept != old.end()) {
            pieces_.push_back(*kept);
            old.erase(kept);
        } else {
            pieces_.push_back(make_body(placed));
        }
    }
    if (!description().clamped()) {
        if (pieces.size() == 1) {
            put_whole(pieces[0]);
        } else if (was_whole) {
            take_out();
        }
    }
    put_geoms();
    for (Hold& hold : holds_) {
        hold.go_to(body_of(hold.at.segment));
        wake(hold.joint);
    }
    // joints end before their bodies
    std::erase_if(joints_, [this](const OpenSection& open) {
        const std::size_t lower = course_.piece_of(open.section);
        const dBodyID below = pieces_[lower].own ? pieces_[lower].body : nullptr;
        return !course_.section(open.section).open ||
               open.hinge->bodies() != AttachedBodies{pieces_[lower + 1].body, below, false};
    });
    for (const MemberBody& piece : old) {
        if (!piece.own) continue;
        MemberBook<Member>::all().leave(piece.body);
        world_->remove(piece.body);
        dBodyDestroy(piece.body);
    }
    make_joints(ahead);
}

DUCTILE_INLINE MemberBody Member::make_body(const PlacedPiece& placed) {
    const MemberPiece& of = *placed.piece;
    if (of.held || of.run == MemberRun{0, description().segments() - 1}) {
        return {user_, of.run, false};
    }
    const dBodyID body = dBodyCreate(dBodyGetWorld(user_));
    detail::set_mass(body, of.mass, of.inertia);
    detail::copy_manners(user_, body);
    detail::put(body, placed.pose, placed.motion);
    world_->add(body);
    MemberBook<Member>::all().enter(body, this);
    return {body, of.run, true};
}

DUCTILE_INLINE void Member::take_out() {
    detail::put(user_, detail::frame_of(user_), {});
    dBodyDisable(user_);
    world_->remove(user_);
    is_missing_ = false;
}

/// Of a member that moves.
DUCTILE_INLINE void Member::put_whole(const PlacedPiece& placed) {
    const MemberPiece& of = *placed.piece;
    if (course_.is_straight()) {
        dBodySetMass(user_, &mass_);
        whole_in_body_ = first_in_body_;
    } else {
        // the frame of a piece is that of its centre and main axes
        detail::set_mass(user_, of.mass, of.inertia);
        whole_in_body_ = {};
    }
    detail::put(user_, frame_around(placed.pose, whole_in_body_), placed.motion);
    // the moment of momentum is that of the pieces
    const Vector3<double> about = times(of.inertia_in_world(placed.pose.axes), placed.motion.spin);
    const Vector3<double> spin = times(numeric::inverse(inertia(user_)), about);
    dBodySetAngularVel(user_, dReal(spin.x()), dReal(spin.y()), dReal(spin.z()));
    dBodyEnable(user_);
    world_->add(user_);
}

DUCTILE_INLINE void Member::put_geoms() {
    if (whole() && course_.is_straight()) {
        geoms_->put_straight();
        return;
    }
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
        geoms_->put(course_.pieces()[i], pieces_[i].body, in_body(i));
    }
}

DUCTILE_INLINE OpenSection Member::make_joint(std::size_t lower, const JointFrame<double>& in_lower,
                                              const JointFrame<double>& in_upper) {
    const int section = pieces_[lower].run.last;
    return {section, std::make_unique<PlasticHinge<UsualAxisJoint>>(
                         dBodyGetWorld(user_), pieces_[lower + 1].body,
                         pieces_[lower].own ? pieces_[lower].body : nullptr, in_upper, in_lower,
                         description().section(section), Meeting::as_they_are)};
}
DUCTILE_INLINE void Member::enter_joint(OpenSection& open, bool ahead) {
    world_->take_in(*open.hinge);
    if (ahead) (void)open.hinge->begin_frame();
}

} // namespace ductile::ode
