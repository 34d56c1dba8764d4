// SPDX-License-Identifier: MIT
//
// Bodies of member.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "ductile/bullet/convert.hpp"
#include "ductile/bullet/member.hpp"
#include "ductile/bullet/member_book.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile::bullet {

namespace detail {

/// PlasticHinge turns about z, a member bends about x.
[[nodiscard]] DUCTILE_INLINE btTransform hinge_frame(const JointFrame<double>& frame) {
    Matrix3<double> axes;
    for (int i = 0; i < 3; ++i) {
        axes(i, 0) = frame.axes(i, 1);
        axes(i, 1) = frame.axes(i, 2);
        axes(i, 2) = frame.axes(i, 0);
    }
    return to_bullet(JointFrame<double>{frame.origin, axes});
}

} // namespace detail

DUCTILE_INLINE Member::Member(btRigidBody& body, ductile::Member member,
                              const btTransform& start_in_body, const MemberBox& box)
    : user_(body), course_(std::move(member)) {
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
    if (box.half_width != 0 || box.half_height != 0) {
        check::positive("Member.box.half_width", box.half_width, "m");
        check::positive("Member.box.half_height", box.half_height, "m");
    }
    const MemberPiece& whole = course_.pieces().front();
    const JointFrame<double> start = to_core(start_in_body);
    JointFrame<double> whole_in_body = frame_around(start, whole.section(of, 0, false));
    if (!of.clamped()) {
        constexpr double share = 1e-3;
        const auto mass = double(body.getMass());
        if (!(std::abs(mass - of.mass()) <= share * of.mass())) {
            check::fail("Member.body.mass", mass, "kg",
                        "that of the member, " + number_text(of.mass(), 6) + " kg");
        }
        const double off = norm(whole_in_body.origin);
        if (!(off <= share * of.length())) {
            check::fail("Member.start_in_body", off, "m",
                        "0: the member's centre is to be the body's");
        }
        whole_in_body.origin.setZero();
    }
    maker_ = std::make_unique<PieceMaker>(body, of, box, whole_in_body);
    held_ = placed(to_core(body.getCenterOfMassTransform()), start);
    pieces_.push_back({&user_, nullptr, nullptr, whole.run});
    detail::MemberBook::all().enter(&user_, this);
}

DUCTILE_INLINE Member::~Member() {
    if (const auto ends = std::exchange(ends_, nullptr)) ends();
    leave();
    for (const PieceBody& piece : pieces_) detail::MemberBook::all().leave(piece.body);
    detail::MemberBook::all().leave(&user_);
}

DUCTILE_INLINE Member* Member::of(const btCollisionObject* object) {
    return detail::MemberBook::all().find(object);
}

// ---- what it says

DUCTILE_INLINE std::vector<btRigidBody*> Member::pieces() const {
    std::vector<btRigidBody*> bodies;
    for (const PieceBody& piece : pieces_) {
        if (piece.own != nullptr || piece.body == &user_) bodies.push_back(piece.body);
    }
    return bodies;
}

DUCTILE_INLINE btRigidBody& Member::body_of(int segment) const {
    return *pieces_[course_.piece_of(segment)].body;
}

DUCTILE_INLINE btTransform Member::pose(int segment) const {
    const std::size_t piece = course_.piece_of(segment);
    return to_bullet(placed(frame_of(piece), course_.pieces()[piece].segment(segment)));
}

DUCTILE_INLINE double Member::plastic_rotation(int section) const {
    return state()[std::size_t(section)].joint.plastic_travel;
}

DUCTILE_INLINE double Member::bend(int section) const { return state()[std::size_t(section)].bend; }

DUCTILE_INLINE MemberState Member::state() const {
    MemberState state = course_.state();
    for (const OpenSection& open : joints_) {
        SectionState& section = state[std::size_t(open.section)];
        section.joint = open.hinge->joint().state();
        section.bend = open.hinge->rotation();
    }
    return state;
}

DUCTILE_INLINE double Member::absorbed_energy() const {
    double sum = course_.closed_work() - vibration();
    for (const OpenSection& open : joints_) sum += open.hinge->absorbed_energy();
    return sum;
}

DUCTILE_INLINE JointReport<double> Member::report() const {
    JointReport<double> all;
    for (const OpenSection& open : joints_) {
        const JointReport<double> report = open.hinge->queries().report();
        all.first_yield = all.first_yield || report.first_yield;
        all.coarse = all.coarse || report.coarse;
        all.residual = std::max(all.residual, report.residual);
        all.step_error = std::max(all.step_error, report.step_error);
        all.plastic_travel += report.plastic_travel;
        if (int(report.outcome) > int(all.outcome)) all.outcome = report.outcome;
        if (report.fracture) all.fracture = report.fracture;
    }
    all.absorbed_energy = absorbed_energy();
    all.plastic_travel += course_.closed_travel();
    return all;
}

// ---- its life

/// Lengths of segments add up with round-off.
DUCTILE_INLINE void Member::require_place(const char* name, double place) const {
    const double length = description().length(), hair = 1e-9 * length;
    if (place >= -hair && place <= length + hair) return;
    check::between(name, place, 0.0, length, "m", true);
}

DUCTILE_INLINE void Member::attach(double place, Maker maker) {
    if (world_ != nullptr) {
        throw std::logic_error("Member.attach: must be called before the member is in a World");
    }
    require_place("Member.attach.place", place);
    attachments_.push_back({place, description().segment_at(place), std::move(maker), nullptr,
                            std::make_unique<btJointFeedback>()});
}

DUCTILE_INLINE void Member::apply_force(const btVector3& force, double place) {
    require_place("Member.apply_force.place", place);
    const int segment = description().segment_at(place);
    const double middle = (segment > 0 ? description().place(segment - 1) : 0) +
                          description().segment(segment).length / 2;
    if (forces_.empty() && pushed_) pushed_();
    forces_.push_back({to_core(force), segment, {0, 0, place - middle}});
    body_of(segment).activate();
}

DUCTILE_INLINE void Member::require_possible() const {
    if (whole() && user_.getBroadphaseHandle() == nullptr) {
        throw std::logic_error("Member.body: must be in the world: addRigidBody it");
    }
    if (user_.isKinematicObject()) throw std::logic_error("Member.body: must not be kinematic");
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
        const bool own = std::any_of(attachments_.begin(), attachments_.end(),
                                     [&](const Attachment& attachment) {
                                         return attachment.constraint.get() == &constraint;
                                     });
        if (own) continue;
        throw std::invalid_argument(
            "World.add.member: no constraint of the world may hold its body but by "
            "Member::attach, as Bullet's constraints cannot change their bodies");
    }
}

DUCTILE_INLINE void Member::enter(btDiscreteDynamicsWorld& world) {
    if (world_ != nullptr) {
        throw std::invalid_argument("World.add.member: must not be in a world already");
    }
    if (!whole()) {
        throw std::invalid_argument("World.add.member: must be whole, no section of it open");
    }
    if (user_.getBroadphaseHandle() == nullptr) {
        throw std::invalid_argument(
            "World.add.member: its body must be in the world before: addRigidBody it");
    }
    require_free(world);
    world_ = &world;
    maker_->enter(world);
    make_attachments();
}

/// Bodies of pieces stay, so that what it says stays.
DUCTILE_INLINE void Member::leave() {
    if (world_ == nullptr) return;
    pushed_ = rearranged_ = nullptr;
    ends_ = nullptr;
    for (Attachment& attachment : attachments_) drop_attachment(attachment);
    note_sections();
    joints_.clear();
    for (PieceBody& piece : pieces_) {
        if (piece.own != nullptr) world_->removeRigidBody(piece.body);
    }
    world_ = nullptr;
}

DUCTILE_INLINE JointFrame<double> Member::frame_of(std::size_t piece) const {
    if (course_.pieces()[piece].held) return held_;
    const JointFrame<double> body = to_core(pieces_[piece].body->getCenterOfMassTransform());
    return pieces_[piece].body == &user_ ? placed(body, maker_->whole_in_body()) : body;
}

DUCTILE_INLINE PlacedPiece Member::placed_piece(std::size_t piece) const {
    const btRigidBody& body = *pieces_[piece].body;
    PlacedPiece result{&course_.pieces()[piece], frame_of(piece), {}};
    if (result.piece->held) return result;
    result.motion = {to_core(body.getLinearVelocity()), to_core(body.getAngularVelocity())};
    return result;
}

DUCTILE_INLINE std::vector<PlacedPiece> Member::placed_pieces() const {
    std::vector<PlacedPiece> all;
    for (std::size_t i = 0; i < pieces_.size(); ++i) all.push_back(placed_piece(i));
    if (whole() && !description().clamped()) {
        // the moment of momentum is that of the user's inertia
        const btMatrix3x3& inverse = user_.getInvInertiaTensorWorld();
        const btVector3 about = inverse.inverse() * user_.getAngularVelocity();
        all[0].motion.spin =
            times(all[0].piece->inverse_inertia_in_world(all[0].pose.axes), to_core(about));
    }
    return all;
}

/// Into the course's state what the joints of open sections went through.
DUCTILE_INLINE void Member::note_sections() {
    for (const OpenSection& open : joints_) {
        SectionState& section = course_.section(open.section);
        section.joint = open.hinge->joint().state();
        if (!open.hinge->is_awake_member()) section.joint.flowing = false; // not any more
        section.bend = open.hinge->rotation();
    }
}

DUCTILE_INLINE void Member::open(std::span<const int> sections, bool ahead) {
    if (whole()) require_free(*world_);
    note_sections();
    become(course_.open(sections, placed_pieces()), ahead);
}

DUCTILE_INLINE void Member::close(std::span<const int> sections, bool ahead) {
    become(course_.close(sections, placed_pieces()), ahead);
}

} // namespace ductile::bullet

#include "ductile/bullet/member_bodies.ipp" // IWYU pragma: keep
