// SPDX-License-Identifier: MIT
//
// Bodies of member_tick.hpp.
#pragma once

#include <BulletDynamics/ConstraintSolver/btGeneric6DofSpring2Constraint.h>
#include <BulletDynamics/ConstraintSolver/btPoint2PointConstraint.h>

#include <algorithm>
#include <cmath>

#include "ductile/bullet/contact_load.hpp"
#include "ductile/bullet/convert.hpp"
#include "ductile/bullet/member_tick.hpp"

namespace ductile::bullet {

DUCTILE_INLINE std::span<const PieceBody> MemberTick::pieces() const { return member_.pieces_; }
DUCTILE_INLINE bool MemberTick::whole() const { return member_.whole(); }
DUCTILE_INLINE bool MemberTick::idle() const {
    return member_.whole() && member_.course_.member().clamped() && member_.attachments_.empty();
}
DUCTILE_INLINE bool MemberTick::doubts() const {
    return member_.course_.unmodelled() != Unmodelled::nothing;
}
DUCTILE_INLINE void MemberTick::driven_through() { member_.course_.doubt(Unmodelled::driven); }
DUCTILE_INLINE void MemberTick::require_possible() const { member_.require_possible(); }
DUCTILE_INLINE void MemberTick::leave() { member_.leave(); }
DUCTILE_INLINE double MemberTick::closed_work() const { return member_.course_.closed_work(); }
DUCTILE_INLINE double MemberTick::unmissed_work() const { return member_.course_.unmissed_work(); }

DUCTILE_INLINE int MemberTick::section_of(const PlasticConstraint& joint) const {
    for (const OpenSection& open : member_.joints_) {
        if (open.hinge.get() == &joint) return open.section;
    }
    return no_section;
}

DUCTILE_INLINE void MemberTick::apply_forces() {
    for (const auto& force : member_.forces_) {
        btRigidBody& body = member_.body_of(force.at.segment);
        if (body.isStaticObject()) continue;
        const btTransform pose = member_.pose(force.at.segment);
        body.applyForce(to_bullet(force.force),
                        pose * to_bullet(force.at.in_segment) - body.getCenterOfMassPosition());
    }
}
DUCTILE_INLINE void MemberTick::drop_forces() { member_.forces_.clear(); }

DUCTILE_INLINE void MemberTick::find_beyond(double dt, std::span<const BodyBefore> before,
                                            const btVector3& gravity, std::vector<int>& sections) {
    read(dt, before, gravity);
    sections = member_.course_.beyond(steps_, loads_, dt);
}
DUCTILE_INLINE void MemberTick::begin_blow(double noticed) { member_.course_.begin_blow(noticed); }
DUCTILE_INLINE void MemberTick::require_attached(const btTypedConstraint& constraint) const {
    member_.require_attached(constraint);
}
DUCTILE_INLINE bool MemberTick::is_held() const { return !member_.attachments_.empty(); }
DUCTILE_INLINE void MemberTick::list_holds(std::vector<const btTypedConstraint*>& list) const {
    for (const Member::Attachment& held : member_.attachments_) {
        list.push_back(held.constraint.get());
    }
}
DUCTILE_INLINE bool MemberTick::switch_holds(bool on) {
    bool any = false;
    for (const Member::Attachment& held : member_.attachments_) any = held.switch_on(on) || any;
    return any;
}
DUCTILE_INLINE void MemberTick::see_coming() {
    for (Member::Attachment& held : member_.attachments_) held.see_coming();
}
DUCTILE_INLINE void MemberTick::find_struck(double dt, std::span<const BodyBefore> before,
                                            const btVector3& gravity, std::vector<int>& sections) {
    read(dt, before, gravity);
    const int section = member_.course_.struck(steps_, loads_, strike_, by_joints_);
    if (section != no_section) sections.push_back(section);
}
DUCTILE_INLINE void MemberTick::open(std::span<const int> sections, bool ahead) {
    member_.open(sections, ahead);
}
DUCTILE_INLINE double MemberTick::count_vibration() {
    if (member_.joints_.empty()) return 0;
    member_.note_sections();
    return member_.course_.count_vibration();
}
DUCTILE_INLINE std::vector<int> MemberTick::close_held(Closing when, bool ahead) {
    if (member_.joints_.empty()) return {};
    member_.note_sections();
    for (const OpenSection& open : member_.joints_) { // slower than Bullet's threshold, too
        if (member_.course_.section(open.section).joint.flowing) open.hinge->keep_awake();
    }
    std::vector<int> held = member_.course_.held(when);
    if (held.empty()) {
        member_.note_broken();
    } else {
        member_.close(held, ahead);
    }
    return held;
}

DUCTILE_INLINE MemberTick::MemberTick(Member& member) : member_(member) {
    const ductile::Member& of = member.description();
    for (int k = 0; k < of.segments(); ++k) {
        own_about_x_ += of.segment(k).inertia[0];
        for (int i = 0; i < 3; ++i) own_inertia_ += of.segment(k).inertia[i];
    }
}

DUCTILE_INLINE void MemberTick::begin() {
    member_.course_.begin_step();
    touches_.clear();
    sum_ = 0;
}

DUCTILE_INLINE void MemberTick::read(double dt, std::span<const BodyBefore> before,
                                     const btVector3& gravity) {
    loads_.clear();
    strike_ = by_joints_ = {};
    steps_.resize(member_.pieces_.size());
    for (std::size_t i = 0; i < steps_.size(); ++i) {
        const btRigidBody& body = *member_.pieces_[i].body;
        if (member_.course_.pieces()[i].held) {
            steps_[i].pose = member_.held_;
            continue;
        }
        const JointFrame<double> pose =
            to_core(before[std::size_t(body.getWorldArrayIndex())].pose);
        steps_[i].pose =
            &body == &member_.user_ ? placed(pose, member_.maker_->whole_in_body()) : pose;
    }
    for (const ContactTouch& touch : touches_) read_contact(touch, before);
    read_constraints(dt, true);
    read_attachments(dt);
    read_forces(dt, true);
    finish_steps(dt, before, gravity);
}

/// Whatever the arms of what acted on it: those of impulses and of the masses that they move, and
/// of what moved it beside those. Where that says too little, along the member's axes.
DUCTILE_INLINE bool MemberTick::may_be_beyond(double dt, std::span<const BodyBefore> before,
                                              const btVector3& gravity) const {
    constexpr double arms = 4; // of its length
    const MemberCourse& of = member_.course_;
    const double length = of.member().length();
    double all = 0, moved = 0; // by whatever
    bool solved = of.member().clamped();
    if (solved) all += of.member().mass() * double(gravity.length()) * dt;
    for (const PieceBody& piece : member_.pieces_) {
        const btRigidBody& body = *piece.body;
        if (body.isStaticObject() || !body.isActive()) continue;
        solved = true;
        const BodyBefore& was = before[std::size_t(body.getWorldArrayIndex())];
        all += double(body.getMass()) * double(was.spin.length2()) * length * dt;
        const btVector3 fallen = body.getGravity() * btScalar(dt);
        moved += double(body.getMass()) *
                 double((body.getLinearVelocity() - was.velocity - fallen).length());
    }
    all += std::max(moved, sum_);
    if (!solved || arms * all * length <= of.least_strength() * dt) return false;
    return !is_plain() || largest_moment(dt, before, gravity) > of.least_strength() * dt;
}

DUCTILE_INLINE bool MemberTick::is_plain() const {
    return member_.whole() && member_.course_.is_straight() && member_.attachments_.empty() &&
           member_.forces_.empty();
}

/// Every arm is the largest that it can be; where the body is now it may be off from where it was
/// solved by what it moved in the tick.
DUCTILE_INLINE double MemberTick::largest_moment(double dt, std::span<const BodyBefore> before,
                                                 const btVector3& gravity) const {
    const ductile::Member& of = member_.description();
    const MemberPiece& whole = member_.course_.pieces().front();
    const btRigidBody& body = member_.user_;
    const double length = of.length();
    const JointFrame<double> pose = member_.frame_of(0);
    // a straight piece has the axes of its segments
    const Vector3<double> y = column(pose.axes, 1), z = column(pose.axes, 2);
    const double before_start = whole.segments.front().origin[2] - of.segment(0).length / 2;
    const Vector3<double> start = sum(pose.origin, scaled(before_start, z));
    double moved = 0, turned = 0, sum = 0;
    const double half_arm = of.mass() * length / 2;
    if (of.clamped()) {
        sum += half_arm * dt * std::abs(dot(to_core(gravity), y));
    } else {
        const BodyBefore& was = before[std::size_t(body.getWorldArrayIndex())];
        const Vector3<double> spin = to_core(body.getAngularVelocity()),
                              before_spin = to_core(was.spin),
                              velocity = to_core(body.getLinearVelocity());
        const double fastest = std::max(norm(spin), norm(before_spin));
        moved = dt * norm(velocity);
        turned = dt * fastest;
        const Vector3<double> change = difference(difference(velocity, to_core(was.velocity)),
                                                  scaled(dt, to_core(body.getGravity())));
        const btVector3& inverse = body.getInvInertiaDiagLocal();
        const double least = double(std::min({inverse.x(), inverse.y(), inverse.z()}));
        // the user's inertia may be another than the member's
        const double around_user = norm(difference(spin, before_spin)) / least;
        const double damped = double(body.getLinearDamping()) * norm(velocity) * 2 * dt,
                     spin_damped = double(body.getAngularDamping()) * fastest * 2 * dt;
        const double across = std::abs(dot(change, y)) + norm(change) * turned + damped;
        const double around = around_user / whole.inertia[0] + spin_damped;
        sum += half_arm * (across + length / 2 * around + dt * fastest * fastest * length) +
               own_about_x_ * around + own_inertia_ * dt * fastest * fastest;
    }
    for (const ContactTouch& touch : touches_) {
        for (int k = 0; k < touch.manifold->getNumContacts(); ++k) {
            const btManifoldPoint& point = touch.manifold->getContactPoint(k);
            const Vector3<double> impulse = scaled(
                touch.share, to_core(point.m_appliedImpulse * point.m_normalWorldOnB +
                                     point.m_appliedImpulseLateral1 * point.m_lateralFrictionDir1 +
                                     point.m_appliedImpulseLateral2 * point.m_lateralFrictionDir2));
            const Vector3<double> arm = difference(
                to_core(touch.of_a ? point.getPositionWorldOnA() : point.getPositionWorldOnB()),
                start);
            const double along = std::abs(dot(arm, z)), off = std::abs(dot(arm, y));
            const double reach = std::max(along, length);
            sum += std::abs(dot(impulse, z)) * off + std::abs(dot(impulse, y)) * reach +
                   norm(impulse) * (moved + turned * (2 * reach + off));
        }
    }
    constexpr double hair = 1e-6; // by which a straight member may be bent
    return sum * (1 + hair);
}

DUCTILE_INLINE void MemberTick::read_contact(const ContactTouch& touch,
                                             std::span<const BodyBefore> before) {
    const btPersistentManifold& manifold = *touch.manifold;
    const btCollisionObject &a = *manifold.getBody0(), &b = *manifold.getBody1();
    const Member& member = member_;
    std::size_t piece = 0;
    while (piece + 1 < member.pieces_.size() &&
           member.pieces_[piece].body != (touch.of_a ? &a : &b)) {
        ++piece;
    }
    for (int k = 0; k < manifold.getNumContacts(); ++k) {
        const ContactLoad contact =
            contact_load(manifold, manifold.getContactPoint(k), touch.of_a, before);
        if (contact.impulse.isZero()) continue;
        MemberLoad& load = loads_.emplace_back();
        load.point = to_core(contact.at);
        load.segment = nearest_segment(member.description(), member.course_.pieces()[piece],
                                       steps_[piece].pose, load.point);
        load.impulse = scaled(touch.share, to_core(contact.impulse));
        strike_.add(contact.energy, contact.closing, load.segment);
    }
}

/// What constraints took that hold it, as a blow.
DUCTILE_INLINE void MemberTick::read_attachments(double dt) {
    for (const Member::Attachment& held : member_.attachments_) {
        if (!held.acts()) continue;
        const Vector3<double> place =
            to_core(member_.pose(held.at.segment) * to_bullet(held.at.in_segment));
        by_joints_.add(held.side(true, place, dt), held.side(false, place, dt), held.at.segment);
    }
}

/// It holds on to what cannot move, and does not break.
DUCTILE_INLINE bool MemberTick::is_support(const Member::Attachment& attachment) {
    return attachment.other().isStaticOrKinematicObject() &&
           attachment.constraint->getBreakingImpulseThreshold() >= SIMD_INFINITY;
}
DUCTILE_INLINE std::vector<std::string> MemberTick::remarks() const {
    std::vector<std::string> lines;
    for (const Member::Attachment& attachment : member_.attachments_) {
        const MemberPlace& at = attachment.at;
        if (!is_support(attachment)) continue;
        if (!borne_by(*attachment.constraint, member_.pose(at.segment))[2]) continue;
        const std::string said = said_of_fixed(member_.description(), at);
        if (!said.empty()) lines.push_back(said);
    }
    return lines;
}

/// What a constraint locks of a force along y and z of the segment at `pose`, a moment about x.
DUCTILE_INLINE std::array<bool, 3> MemberTick::borne_by(btTypedConstraint& constraint,
                                                        const btTransform& pose) {
    if (const auto* point = dynamic_cast<const btPoint2PointConstraint*>(&constraint)) {
        const bool rigid = point->m_setting.m_impulseClamp == 0;
        return {rigid, rigid, false};
    }
    auto* axes = dynamic_cast<btGeneric6DofSpring2Constraint*>(&constraint);
    if (axes == nullptr) return {};
    axes->calculateTransforms();
    const btMatrix3x3 &frame = axes->getCalculatedTransformA().getBasis(), &own = pose.getBasis();
    const btTranslationalLimitMotor2& move = *axes->getTranslationalLimitMotor();
    const auto locks = [&](bool turns, int along) {
        constexpr double aligned = 1 - 1e-6;
        for (int i = 0; i < 3; ++i) {
            const btRotationalLimitMotor2& turn = *axes->getRotationalLimitMotor(i);
            const bool locked = turns ? turn.m_loLimit == turn.m_hiLimit
                                      : move.m_lowerLimit[i] == move.m_upperLimit[i];
            const double share = std::abs(double(frame.getColumn(i).dot(own.getColumn(along))));
            if (locked && share > aligned) return true;
        }
        return false;
    };
    return {locks(false, 1), locks(false, 2), locks(true, 0)};
}

/// Of attachments and of its own joints.
DUCTILE_INLINE void MemberTick::read_constraints(double dt, bool lists) {
    Member& member = member_;
    const auto add = [&](const btVector3& force, const btVector3& torque, std::size_t piece,
                         int segment) {
        const btRigidBody* body = member.pieces_[piece].body;
        sum_ +=
            dt * (double(force.length()) + double(torque.length()) / member.description().length());
        if (!lists) return;
        // about the body's centre, which was where its piece was
        JointFrame<double> pose = steps_[piece].pose;
        if (body == &member.user_) pose = frame_around(pose, member.maker_->whole_in_body());
        loads_.push_back(
            {segment, pose.origin, scaled(dt, to_core(force)), scaled(dt, to_core(torque))});
    };
    for (Member::Attachment& attachment : member.attachments_) {
        if (!attachment.acts()) continue;
        (void)attachment.see();
        const int segment = attachment.at.segment;
        add(attachment.force(), attachment.torque(), member.course_.piece_of(segment), segment);
        if (!lists || !is_support(attachment)) continue;
        loads_.back().support = &attachment;
        loads_.back().held_at = attachment.at.in_segment;
        loads_.back().bears = borne_by(*attachment.constraint, member.pose(segment));
    }
    for (const OpenSection& open : member.joints_) {
        if (!open.hinge->isEnabled()) continue;
        const std::size_t lower = member.course_.piece_of(open.section);
        const btJointFeedback& told = *open.feedback; // its first body is the upper piece
        if (member.pieces_[lower].own != nullptr) {
            add(told.m_appliedForceBodyB, told.m_appliedTorqueBodyB, lower, open.section);
        }
        add(told.m_appliedForceBodyA, told.m_appliedTorqueBodyA, lower + 1, open.section + 1);
    }
}

DUCTILE_INLINE void MemberTick::read_forces(double dt, bool lists) {
    const Member& member = member_;
    for (const auto& force : member.forces_) {
        sum_ += dt * norm(force.force);
        if (!lists) continue;
        const std::size_t piece = member.course_.piece_of(force.at.segment);
        loads_.push_back(member.load(force, steps_[piece].pose, dt));
    }
}

/// How its pieces went through the tick.
DUCTILE_INLINE void MemberTick::finish_steps(double dt, std::span<const BodyBefore> before,
                                             const btVector3& gravity) {
    const Member& member = member_;
    for (std::size_t i = 0; i < steps_.size(); ++i) {
        PieceStep& step = steps_[i];
        const btRigidBody& body = *member.pieces_[i].body;
        const MemberPiece& piece = member.course_.pieces()[i];
        step.dt = 0;
        step.spin.setZero();
        if (piece.held) {
            step.change = {scaled(-dt, to_core(gravity)), Vector3<double>::Zero()};
            continue;
        }
        const BodyChange went =
            body_change(body, before[std::size_t(body.getWorldArrayIndex())], dt);
        step.change = went.of(piece.inertia, step.pose.axes);
        step.spin = went.spin;
        step.dt = went.dt;
        constexpr double digits = 8 * double(SIMD_EPSILON);
        step.blur = digits * (norm(to_core(body.getLinearVelocity())) +
                              member.description().length() * norm(went.spin));
    }
}

} // namespace ductile::bullet
