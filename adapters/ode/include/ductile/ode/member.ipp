// SPDX-License-Identifier: MIT
//
// Bodies of member.hpp.
#pragma once

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "ductile/ode/convert.hpp"
#include "ductile/ode/member.hpp"
#include "ductile/world/joint_checks.hpp"

namespace ductile::ode {

namespace detail {

[[nodiscard]] DUCTILE_INLINE dBodyID require_body(dBodyID body) {
    if (body == nullptr) throw std::invalid_argument("Member.body = null: must be a body");
    return body;
}

/// What cannot move, or slides along a rail of what cannot and does no more.
[[nodiscard]] DUCTILE_INLINE HeldBy support_by(dBodyID body) {
    if (!can_move(body)) return {.holds = true};
    for (int i = 0, count = dBodyGetNumJoints(body); i < count; ++i) {
        const dJointID joint = dBodyGetJoint(body, i);
        if (dJointGetType(joint) != dJointTypeSlider || dJointIsEnabled(joint) == 0) continue;
        if (can_move(dJointGetBody(joint, 0)) && can_move(dJointGetBody(joint, 1))) continue;
        dVector3 axis;
        dJointGetSliderAxis(joint, axis);
        return {.holds = true, .rail = to_core(axis)};
    }
    return {};
}

} // namespace detail

DUCTILE_INLINE Member::Member(dBodyID body, ductile::Member member,
                              const JointFrame<double>& start_in_body, const MemberBox& box)
    : SteppedMember(std::move(member)),
      user_(detail::require_body(body)),
      life_(WorldLife::of(dBodyGetWorld(body))) {
    const ductile::Member& of = description();
    if ((dBodyIsKinematic(body) != 0) != of.clamped()) {
        throw std::invalid_argument(
            of.clamped() ? "Member.body: must be kinematic for a clamped member"
                         : "Member.body: must not be kinematic where the member is not clamped");
    }
    if (Member::of(body) != nullptr) {
        throw std::invalid_argument("Member.body: must not be a member already");
    }
    constexpr double round_off = 1e-9;
    require_frame("Member.start_in_body", start_in_body, round_off);
    box.validate(of);
    dBodyGetMass(body, &mass_);
    const MemberPiece& whole = course_.pieces().front();
    first_in_body_ = whole_in_body_ = whole_in_body(of, whole, start_in_body, double(mass_.mass));
    geoms_ = std::make_unique<MemberGeoms>(body, of, box, whole, first_in_body_);
    pieces_.push_back({user_, whole.run, false});
    MemberBook<Member>::all().enter(user_, this);
}

DUCTILE_INLINE Member::~Member() {
    if (world_ != nullptr) world_->remove(*this);
    for (const MemberBody& piece : pieces_) MemberBook<Member>::all().leave(piece.body);
    MemberBook<Member>::all().leave(user_);
}

DUCTILE_INLINE Member* Member::of(dBodyID body) { return MemberBook<Member>::all().find(body); }

// ---- what it says

DUCTILE_INLINE std::vector<dBodyID> Member::pieces() const {
    std::vector<dBodyID> bodies;
    for (const MemberBody& piece : pieces_) {
        const bool ground = piece.run.first == piece.run.last && description().clamped();
        if (piece.own || !ground) bodies.push_back(piece.body);
    }
    return bodies;
}
DUCTILE_INLINE std::vector<dBodyID> Member::bodies() const {
    std::vector<dBodyID> bodies;
    for (const MemberBody& piece : pieces_) bodies.push_back(piece.body);
    return bodies;
}
DUCTILE_INLINE dBodyID Member::body_of(int segment) const { return piece_of(segment).body; }
DUCTILE_INLINE JointFrame<double> Member::pose(int segment) const {
    const std::size_t piece = course_.piece_of(segment);
    return placed(frame_of(piece), course_.pieces()[piece].segment(segment));
}
DUCTILE_INLINE const MemberBody& Member::piece_on(dBodyID body) const {
    return *std::find_if(pieces_.begin(), pieces_.end(),
                         [body](const MemberBody& piece) { return piece.body == body; });
}
/// Pieces that hang together do, those with a broken section between them meet.
DUCTILE_INLINE bool Member::hangs_together(dBodyID a, dBodyID b) const {
    const int first = piece_on(a).run.first, second = piece_on(b).run.first;
    for (const OpenSection& open : joints_) {
        const bool between =
            std::min(first, second) <= open.section && open.section < std::max(first, second);
        if (between && open.hinge->queries().broken()) return false;
    }
    return true;
}
/// While it is whole the user's collisions leave out what a joint holds to its body; so do then all
/// pieces.
DUCTILE_INLINE bool Member::holds(dBodyID own, dBodyID other) const {
    return std::any_of(holds_.begin(), holds_.end(), [&](const Hold& hold) {
        return hold.acts() && hold.other() == other && hangs_together(own, hold.body);
    });
}

// ---- its life

DUCTILE_INLINE void Member::attach(double place, dJointID joint) {
    if (joint == nullptr)
        throw std::invalid_argument("Member.attach.joint = null: must be a joint");
    const MemberPlace at = description().on_axis("Member.attach.place", place);
    std::erase_if(told_, [joint](const auto& told) { return told.first == joint; });
    told_.emplace_back(joint, at);
}
DUCTILE_INLINE void Member::apply_force(const Vector3<double>& force, double place) {
    forces_.push_back(force_at(force, place));
    const dBodyID body = body_of(forces_.back().at.segment);
    if (can_move(body)) dBodyEnable(body);
}

DUCTILE_INLINE void Member::enter(World& world) {
    if (world_ != nullptr) {
        throw std::invalid_argument("World.add.member: must not be in a world already");
    }
    if (!life_->goes_on() || dBodyGetWorld(user_) != world.id()) {
        throw std::invalid_argument("World.add.member: its body must be one of this world");
    }
    require_possible();
    world_ = &world;
    for (const Hold& hold : holds_) {
        if (dJointGetType(hold.joint) != dJointTypeFixed) continue;
        if (!detail::support_by(hold.other()).holds) continue;
        const std::string said = said_of_fixed(description(), hold.at);
        if (!said.empty()) world.supervisor().say(said);
    }
}
DUCTILE_INLINE void Member::leave() {
    if (world_ == nullptr) return;
    if (life_->goes_on() && !whole()) {
        find_holds();
        note_sections();
        become(course_.close(all_open(), placed_pieces()), false);
    }
    world_ = nullptr;
}

DUCTILE_INLINE void Member::require_possible() {
    if (is_missing_) throw std::logic_error("Member.body: must be in the World: World::add it");
    if ((dBodyIsKinematic(user_) != 0) != description().clamped()) {
        throw std::logic_error(
            "Member.body: must be kinematic where the member is clamped, and "
            "nowhere else");
    }
    if (whole()) {
        dMass now;
        dBodyGetMass(user_, &now);
        require_mass(description(), double(now.mass));
    }
    if (description().clamped()) {
        if (!is_zero(linear_velocity(user_)) || !is_zero(angular_velocity(user_))) {
            throw std::logic_error("Member.body: must not move where the member is clamped");
        }
        dBodyDisable(user_); // what hangs on it may sleep
    }
    find_holds();
}

/// Where a joint on a piece holds.
DUCTILE_INLINE MemberPlace Member::place_of(dJointID joint, std::size_t piece) const {
    const auto anchor = anchor_of(joint, pieces_[piece].body, "World.add.member");
    for (const auto& [told, at] : told_) {
        if (told == joint) return at;
    }
    if (!anchor) {
        throw std::invalid_argument(
            "World.add.member: a fixed joint of its body must be told where it holds: "
            "Member::attach");
    }
    const MemberPiece& of = course_.pieces()[piece];
    const JointFrame<double> frame = frame_of(piece);
    const int segment = nearest_segment(description(), of, frame, *anchor);
    const JointFrame<double> at = placed(frame, of.segment(segment));
    return {segment, transposed_times(at.axes, difference(*anchor, at.origin))};
}
DUCTILE_INLINE void Member::find_holds() {
    const std::vector<Hold> before = std::exchange(holds_, {});
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
        const dBodyID body = pieces_[i].body;
        for (int k = 0, count = dBodyGetNumJoints(body); k < count; ++k) {
            const dJointID joint = dBodyGetJoint(body, k);
            const bool own =
                std::any_of(joints_.begin(), joints_.end(),
                            [joint](const OpenSection& open) { return open.hinge->id() == joint; });
            if (own || dJointGetType(joint) == dJointTypeContact) continue;
            Hold& hold = holds_.emplace_back(
                Hold{{{joint, body, dJointIsEnabled(joint) != 0}}, place_of(joint, i)});
            for (const Hold& was : before) {
                if (was.joint == joint && was.body == body) hold.wrench = was.wrench;
            }
        }
    }
}

} // namespace ductile::ode

#include "ductile/ode/member_bodies.ipp" // IWYU pragma: keep
#include "ductile/ode/member_step.ipp"   // IWYU pragma: keep
