// SPDX-License-Identifier: MIT
//
// Bodies of member.hpp.
#pragma once

#include <cmath>
#include <stdexcept>
#include <utility>

#include "ductile/bullet/convert.hpp"
#include "ductile/bullet/member.hpp"
#include "ductile/world/joint_checks.hpp"

namespace ductile::bullet {

DUCTILE_INLINE Member::Member(btRigidBody& body, ductile::Member member,
                              const btTransform& start_in_body, const MemberBox& box)
    : SteppedMember(std::move(member)), user_(body) {
    const ductile::Member& of = description();
    if (body.isKinematicObject()) {
        throw std::invalid_argument("Member.body: must not be kinematic");
    }
    if (body.isStaticObject() != of.clamped()) {
        throw std::invalid_argument(of.clamped()
                                        ? "Member.body: must be static for a clamped member"
                                        : "Member.body: must move where the member is not clamped");
    }
    if (Member::of(&body) != nullptr) {
        throw std::invalid_argument("Member.body: must not be a member already");
    }
    box.validate(of);
    const MemberPiece& whole = course_.pieces().front();
    const JointFrame<double> start = to_core(start_in_body);
    constexpr double round_off = sizeof(btScalar) == sizeof(double) ? 1e-9 : 1e-5;
    require_frame("Member.start_in_body", start, round_off);
    const JointFrame<double> in_body = whole_in_body(of, whole, start, double(body.getMass()));
    maker_ = std::make_unique<PieceMaker>(body, of, box, in_body);
    held_ = placed(to_core(body.getCenterOfMassTransform()), start);
    pieces_.push_back({&user_, nullptr, nullptr, whole.run});
    for (int k = 0; k < of.segments(); ++k) {
        own_about_x_ += of.segment(k).inertia[0];
        for (int i = 0; i < 3; ++i) own_inertia_ += of.segment(k).inertia[i];
    }
    MemberBook<Member>::all().enter(&user_, this);
}

DUCTILE_INLINE Member::~Member() {
    if (const auto ends = std::exchange(ends_, nullptr)) ends();
    leave();
    for (const PieceBody& piece : pieces_) MemberBook<Member>::all().leave(piece.body);
    MemberBook<Member>::all().leave(&user_);
}

DUCTILE_INLINE Member* Member::of(const btCollisionObject* object) {
    return MemberBook<Member>::all().find(object);
}

// ---- what it says

DUCTILE_INLINE std::vector<btRigidBody*> Member::pieces() const {
    std::vector<btRigidBody*> bodies;
    for (const PieceBody& piece : pieces_) {
        if (piece.own != nullptr || piece.body == &user_) bodies.push_back(piece.body);
    }
    return bodies;
}

DUCTILE_INLINE btRigidBody& Member::body_of(int segment) const { return *piece_of(segment).body; }

DUCTILE_INLINE btTransform Member::pose(int segment) const {
    const std::size_t piece = course_.piece_of(segment);
    return to_bullet(placed(frame_of(piece), course_.pieces()[piece].segment(segment)));
}

// ---- its life

DUCTILE_INLINE void Member::attach(double place, Maker maker) {
    if (world_ != nullptr) {
        throw std::logic_error("Member.attach: must be called before the member is in a World");
    }
    const MemberPlace at = description().on_axis("Member.attach.place", place);
    holds_.push_back({{.maker = std::move(maker)}, at});
}

DUCTILE_INLINE void Member::apply_force(const btVector3& force, double place) {
    const Force applied = force_at(to_core(force), place);
    if (forces_.empty() && pushed_) pushed_();
    forces_.push_back(applied);
    body_of(applied.at.segment).activate();
}

DUCTILE_INLINE void Member::require_possible() const {
    if (whole() && user_.getBroadphaseHandle() == nullptr) {
        throw std::logic_error("Member.body: must be in the world: addRigidBody it");
    }
    if (user_.isKinematicObject()) throw std::logic_error("Member.body: must not be kinematic");
    if (whole()) require_mass(description(), double(user_.getMass()));
    if (description().clamped() &&
        !(user_.getLinearVelocity().isZero() && user_.getAngularVelocity().isZero())) {
        throw std::logic_error("Member.body: must not move where the member is clamped");
    }
    if (!whole() && user_.getBroadphaseHandle() != nullptr) {
        throw std::logic_error(
            "Member.body: must not be in the world while the member is open: removeRigidBody it");
    }
    for (const PieceBody& piece : pieces_) {
        if (piece.own == nullptr || piece.body->getBroadphaseHandle() != nullptr) continue;
        throw std::logic_error(
            "Member.pieces: must stay in the world while the member is open: addRigidBody them, or "
            "end the member");
    }
}

/// Of a member that is whole.
DUCTILE_INLINE void Member::require_free(const btDiscreteDynamicsWorld& world) const {
    for (int i = 0; i < world.getNumConstraints(); ++i) {
        const btTypedConstraint& constraint = *world.getConstraint(i);
        if (&constraint.getRigidBodyA() != &user_ && &constraint.getRigidBodyB() != &user_) {
            continue;
        }
        require_attached(constraint);
    }
}
DUCTILE_INLINE void Member::require_attached(const btTypedConstraint& constraint) const {
    for (const Hold& held : holds_) {
        if (held.constraint.get() == &constraint) return;
    }
    if (Member::of(&constraint.getRigidBodyA()) != nullptr &&
        Member::of(&constraint.getRigidBodyB()) != nullptr) {
        throw std::invalid_argument(
            "Member.attach.maker: must not hold a body of another member, as that comes and goes: "
            "members that are joined are one StructureInTime");
    }
    throw std::invalid_argument(
        "World.add.member: no constraint of the world may hold its body but by Member::attach, as "
        "Bullet's constraints cannot change their bodies");
}

DUCTILE_INLINE void Member::enter(btDiscreteDynamicsWorld& world) {
    if (world_ != nullptr) {
        throw std::invalid_argument("World.add.member: must not be in a world already");
    }
    const int place = user_.getWorldArrayIndex();
    const bool here = user_.getBroadphaseHandle() != nullptr && place >= 0 &&
                      place < world.getNumCollisionObjects() &&
                      world.getCollisionObjectArray()[place] == &user_;
    if (!here) {
        throw std::invalid_argument(
            "World.add.member: its body must be in the world before: addRigidBody it");
    }
    require_free(world);
    world_ = &world;
    maker_->enter(world);
    make_attachments();
}

DUCTILE_INLINE void Member::leave() {
    if (world_ == nullptr) return;
    pushed_ = rearranged_ = nullptr;
    ends_ = nullptr;
    note_sections();
    if (!whole()) become(course_.close(all_open(), placed_pieces()), false);
    for (Hold& hold : holds_) hold.drop(*world_);
    world_ = nullptr;
}

DUCTILE_INLINE JointFrame<double> Member::frame_of(std::size_t piece) const {
    if (course_.pieces()[piece].held) return held_;
    const JointFrame<double> body = to_core(pieces_[piece].body->getCenterOfMassTransform());
    return pieces_[piece].body == &user_ ? placed(body, maker_->whole_in_body()) : body;
}
DUCTILE_INLINE BodyMotion Member::motion_of(std::size_t piece) const {
    const btRigidBody& body = *pieces_[piece].body;
    return {to_core(body.getLinearVelocity()), to_core(body.getAngularVelocity())};
}
DUCTILE_INLINE Vector3<double> Member::momentum() const {
    return to_core(user_.getInvInertiaTensorWorld().inverse() * user_.getAngularVelocity());
}
DUCTILE_INLINE Vector3<double> Member::point_of(const MemberPlace& at) const {
    return to_core(pose(at.segment) * to_bullet(at.in_segment));
}

} // namespace ductile::bullet

#include "ductile/bullet/member_bodies.ipp" // IWYU pragma: keep
#include "ductile/bullet/member_step.ipp"   // IWYU pragma: keep
