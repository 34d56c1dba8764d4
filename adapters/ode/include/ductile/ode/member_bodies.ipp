// SPDX-License-Identifier: MIT
//
// Bodies of member.hpp: pieces, the joints between them, what holds on to them. A part of
// member.ipp.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "ductile/numeric/lu.hpp"
#include "ductile/ode/convert.hpp"
#include "ductile/ode/world_snapshot.hpp"

namespace ductile::ode {

DUCTILE_INLINE JointPlace::JointPlace(dJointID joint) {
    const auto get = [joint](auto* of, std::array<dReal, 3>& result) {
        dVector3 found;
        of(joint, found);
        std::copy_n(found, 3, result.begin());
    };
    if (dJointGetType(joint) == dJointTypeBall) {
        get(dJointGetBallAnchor, on_first_);
        get(dJointGetBallAnchor2, on_second_);
    } else if (dJointGetType(joint) == dJointTypeHinge) {
        get(dJointGetHingeAnchor, on_first_);
        get(dJointGetHingeAxis, axis_);
        angle_ = dJointGetHingeAngle(joint);
    }
}
/// Anchors stay where they are, each on its own body.
DUCTILE_INLINE void JointPlace::attach_ball(dJointID joint, dBodyID first, dBodyID second) const {
    dJointAttach(joint, first, second);
    const bool reversed = attached_bodies(joint).reversed;
    const auto &a = reversed ? on_second_ : on_first_, &b = reversed ? on_first_ : on_second_;
    dJointSetBallAnchor(joint, a[0], a[1], a[2]);
    const dBodyID other = attached_bodies(joint).b;
    dVector3 in_other{b[0], b[1], b[2], 0};
    if (other != nullptr) dBodyGetPosRelPoint(other, b[0], b[1], b[2], in_other);
    dJointSetBallAnchor2(joint, in_other[0], in_other[1], in_other[2]);
}
/// Its angle goes on: ODE begins to count where the axis is set, so that is done where the angle is
/// zero (its dJointSetHingeAxisOffset is right for bodies that are turned alike alone).
DUCTILE_INLINE void JointPlace::attach_hinge(dJointID joint, dBodyID first, dBodyID second,
                                             dBodyID changed) const {
    dJointAttach(joint, first, second);
    dJointSetHingeAnchor(joint, on_first_[0], on_first_[1], on_first_[2]);
    const BodySnapshot pose(changed);
    dMatrix3 back, turned;
    dRFromAxisAndAngle(back, axis_[0], axis_[1], axis_[2], changed == first ? -angle_ : angle_);
    dMultiply0_333(turned, back, dBodyGetRotation(changed));
    dBodySetRotation(changed, turned);
    dJointSetHingeAxis(joint, axis_[0], axis_[1], axis_[2]);
    pose.put_pose_back(changed);
}
DUCTILE_INLINE void JointPlace::attach(dJointID joint, dBodyID first, dBodyID second,
                                       dBodyID changed) const {
    switch (dJointGetType(joint)) {
        case dJointTypeBall:
            return attach_ball(joint, first, second);
        case dJointTypeHinge:
            return attach_hinge(joint, first, second, changed);
        default:
            dJointAttach(joint, first, second);
            dJointSetFixed(joint);
    }
}

namespace detail {

/// A joint of the user's that `from` has goes to `to`.
DUCTILE_INLINE void hand_over(dJointID joint, dBodyID from, dBodyID to) {
    if (from == to) return;
    std::array<dBodyID, 2> bodies{dJointGetBody(joint, 0), dJointGetBody(joint, 1)};
    std::replace(bodies.begin(), bodies.end(), from, to);
    JointPlace(joint).attach(joint, bodies[0], bodies[1], to);
}

} // namespace detail

/// The frame of a piece in its body.
DUCTILE_INLINE JointFrame<double> Member::in_body(std::size_t piece) const {
    return pieces_[piece].own ? JointFrame<double>{} : whole_in_body_;
}
DUCTILE_INLINE JointFrame<double> Member::frame_of(std::size_t piece) const {
    return placed(detail::frame_of(pieces_[piece].body), in_body(piece));
}
DUCTILE_INLINE std::vector<PlacedPiece> Member::placed_pieces() const {
    std::vector<PlacedPiece> all;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
        PlacedPiece& piece = all.emplace_back(PlacedPiece{&course_.pieces()[i], frame_of(i), {}});
        if (!piece.piece->held) piece.motion = detail::motion_of(pieces_[i].body);
    }
    if (whole() && !description().clamped()) {
        // the moment of momentum is that of the user's inertia
        all[0].motion.spin = times(all[0].piece->inverse_inertia_in_world(all[0].pose.axes),
                                   times(inertia(user_), all[0].motion.spin));
    }
    return all;
}

DUCTILE_INLINE void Member::become(const std::vector<PlacedPiece>& pieces, bool ahead) {
    const bool was_whole = pieces_.size() == 1;
    std::vector<PieceBody> old = std::exchange(pieces_, {});
    for (const PlacedPiece& placed : pieces) {
        const auto kept = std::find_if(old.begin(), old.end(), [&placed](const PieceBody& piece) {
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
        const dBodyID from = std::exchange(hold.body, body_of(hold.at.segment));
        detail::hand_over(hold.joint, from, hold.body);
        wake(hold.joint);
    }
    // joints end before their bodies
    std::erase_if(joints_, [this](const OpenSection& open) {
        const std::size_t lower = course_.piece_of(open.section);
        const dBodyID below = pieces_[lower].own ? pieces_[lower].body : nullptr;
        return !course_.section(open.section).open ||
               open.hinge->bodies() != AttachedBodies{pieces_[lower + 1].body, below, false};
    });
    for (const PieceBody& piece : old) {
        if (!piece.own) continue;
        MemberBook<Member>::all().leave(piece.body);
        world_->remove(piece.body);
        dBodyDestroy(piece.body);
    }
    make_joints(ahead);
}

DUCTILE_INLINE auto Member::make_body(const PlacedPiece& placed) -> PieceBody {
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

DUCTILE_INLINE void Member::make_joints(bool ahead) {
    for (std::size_t i = 0; i + 1 < pieces_.size(); ++i) {
        const int section = pieces_[i].run.last;
        if (std::any_of(joints_.begin(), joints_.end(),
                        [&](const OpenSection& open) { return open.section == section; })) {
            continue;
        }
        const MemberPiece &lower = course_.pieces()[i], &upper = course_.pieces()[i + 1];
        const JointFrame<double> in_lower = lower.section(description(), section, true);
        const bool held = !pieces_[i].own;
        OpenSection open{section, nullptr};
        open.hinge = std::make_unique<Hinge>(
            dBodyGetWorld(user_), pieces_[i + 1].body, held ? nullptr : pieces_[i].body,
            hinge_frame(upper.section(description(), section + 1, false)),
            hinge_frame(held ? placed(frame_of(i), in_lower) : in_lower),
            description().section(section), Meeting::as_they_are);
        go_on(*open.hinge, course_.section(section));
        world_->take_in(*open.hinge);
        if (ahead) open.hinge->begin_frame();
        joints_.push_back(std::move(open));
    }
}

} // namespace ductile::ode
