// SPDX-License-Identifier: MIT
//
// Bodies of member.hpp: what acted on it in a tick, and how its pieces went through it. A part of
// member.ipp.
#pragma once

#include <BulletDynamics/ConstraintSolver/btGeneric6DofSpring2Constraint.h>
#include <BulletDynamics/ConstraintSolver/btPoint2PointConstraint.h>

#include <algorithm>

#include "ductile/bullet/contact_load.hpp"

namespace ductile::bullet {

DUCTILE_INLINE void Member::add_force(int segment, const Vector3<double>& force,
                                      const Vector3<double>& at) {
    btRigidBody& body = body_of(segment);
    if (body.isStaticObject()) return;
    body.applyForce(to_bullet(force), to_bullet(at) - body.getCenterOfMassPosition());
}

DUCTILE_INLINE void Member::find_beyond(double dt, std::span<const BodyBefore> before,
                                        const btVector3& gravity, std::vector<int>& sections) {
    read(dt, before, gravity);
    sections = course_.beyond(steps_, loads_, dt);
}
DUCTILE_INLINE void Member::find_struck(double dt, std::span<const BodyBefore> before,
                                        const btVector3& gravity, std::vector<int>& sections) {
    read(dt, before, gravity);
    look_blow(dt, strike_, sections);
}

DUCTILE_INLINE void Member::read(double dt, std::span<const BodyBefore> before,
                                 const btVector3& gravity) {
    loads_.clear();
    strike_ = {};
    steps_.resize(pieces_.size());
    for (std::size_t i = 0; i < steps_.size(); ++i) {
        const btRigidBody& body = *pieces_[i].body;
        if (course_.pieces()[i].held) {
            steps_[i].pose = held_;
            continue;
        }
        const JointFrame<double> pose =
            to_core(before[std::size_t(body.getWorldArrayIndex())].pose);
        steps_[i].pose = &body == &user_ ? placed(pose, maker_->whole_in_body()) : pose;
    }
    for (const ContactTouch& touch : touches_) read_contact(touch, before);
    read_constraints(dt, true);
    read_forces(dt, true);
    finish_steps(dt, before, gravity);
}

/// Whatever the arms of what acted on it: those of impulses and of the masses that they move, and
/// of what moved it beside those. Where that says too little, along the member's axes.
DUCTILE_INLINE double Member::most_share(double dt, std::span<const BodyBefore> before,
                                         const btVector3& gravity) const {
    constexpr double arms = 4; // of its length
    const MemberCourse& of = course_;
    const double length = of.member().length();
    double all = 0, moved = 0; // by whatever
    bool solved = of.member().clamped();
    if (solved) all += of.member().mass() * double(gravity.length()) * dt;
    for (const PieceBody& piece : pieces_) {
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
    const double strength = of.least_strength() * dt;
    const double share = solved ? arms * all * length / strength : 0;
    if (!(share > 1) || !is_plain()) return share;
    return largest_moment(dt, before, gravity) / strength;
}

DUCTILE_INLINE bool Member::is_plain() const {
    return whole() && course_.is_straight() && holds_.empty() && forces_.empty();
}

/// Every arm is the largest that it can be; where the body is now it may be off from where it was
/// solved by what it moved in the tick.
DUCTILE_INLINE double Member::largest_moment(double dt, std::span<const BodyBefore> before,
                                             const btVector3& gravity) const {
    const ductile::Member& of = description();
    const MemberPiece& whole = course_.pieces().front();
    const btRigidBody& body = user_;
    const double length = of.length();
    const JointFrame<double> pose = frame_of(0);
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

DUCTILE_INLINE void Member::read_contact(const ContactTouch& touch,
                                         std::span<const BodyBefore> before) {
    const btPersistentManifold& manifold = *touch.manifold;
    const btCollisionObject &a = *manifold.getBody0(), &b = *manifold.getBody1();
    std::size_t piece = 0;
    while (piece + 1 < pieces_.size() && pieces_[piece].body != (touch.of_a ? &a : &b)) {
        ++piece;
    }
    for (int k = 0; k < manifold.getNumContacts(); ++k) {
        const ContactLoad contact =
            contact_load(manifold, manifold.getContactPoint(k), touch.of_a, before);
        if (contact.impulse.isZero()) continue;
        MemberLoad& load = loads_.emplace_back();
        load.point = to_core(contact.at);
        load.segment =
            nearest_segment(description(), course_.pieces()[piece], steps_[piece].pose, load.point);
        load.impulse = scaled(touch.share, to_core(contact.impulse));
        strike_.add(contact.energy, contact.closing, load.segment);
    }
}

/// It holds on to what cannot move, and does not break.
DUCTILE_INLINE bool Member::is_support(const Hold& attachment) {
    return attachment.other().isStaticOrKinematicObject() &&
           attachment.constraint->getBreakingImpulseThreshold() >= SIMD_INFINITY;
}
DUCTILE_INLINE std::vector<std::string> Member::remarks() const {
    std::vector<std::string> lines;
    for (const Hold& attachment : holds_) {
        const MemberPlace& at = attachment.at;
        if (!is_support(attachment)) continue;
        if (!borne_by(*attachment.constraint, pose(at.segment))[2]) continue;
        const std::string said = said_of_fixed(description(), at);
        if (!said.empty()) lines.push_back(said);
    }
    return lines;
}

/// What a constraint locks of a force along y and z of the segment at `pose`, a moment about x.
DUCTILE_INLINE std::array<bool, 3> Member::borne_by(btTypedConstraint& constraint,
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
DUCTILE_INLINE void Member::read_constraints(double dt, bool lists) {
    const auto add = [&](const btVector3& force, const btVector3& torque, std::size_t piece,
                         int segment) {
        const btRigidBody* body = pieces_[piece].body;
        sum_ += dt * (double(force.length()) + double(torque.length()) / description().length());
        if (!lists) return;
        // about the body's centre, which was where its piece was
        JointFrame<double> pose = steps_[piece].pose;
        if (body == &user_) pose = frame_around(pose, maker_->whole_in_body());
        loads_.push_back(
            {segment, pose.origin, scaled(dt, to_core(force)), scaled(dt, to_core(torque))});
    };
    for (Hold& attachment : holds_) {
        if (!attachment.acts()) continue;
        (void)attachment.see();
        const int segment = attachment.at.segment;
        add(attachment.force(), attachment.torque(), course_.piece_of(segment), segment);
        if (!lists || !is_support(attachment)) continue;
        loads_.back().support = &attachment;
        loads_.back().held_at = attachment.at.in_segment;
        loads_.back().bears = borne_by(*attachment.constraint, pose(segment));
    }
    for (const OpenSection& open : joints_) {
        if (!open.hinge->isEnabled()) continue;
        const std::size_t lower = course_.piece_of(open.section);
        const btJointFeedback& told = *open.feedback; // its first body is the upper piece
        if (pieces_[lower].own != nullptr) {
            add(told.m_appliedForceBodyB, told.m_appliedTorqueBodyB, lower, open.section);
        }
        add(told.m_appliedForceBodyA, told.m_appliedTorqueBodyA, lower + 1, open.section + 1);
    }
}

DUCTILE_INLINE void Member::read_forces(double dt, bool lists) {
    for (const auto& force : forces_) {
        sum_ += dt * norm(force.force);
        if (!lists) continue;
        const std::size_t piece = course_.piece_of(force.at.segment);
        loads_.push_back(load(force, steps_[piece].pose, dt));
    }
}

/// How its pieces went through the tick.
DUCTILE_INLINE void Member::finish_steps(double dt, std::span<const BodyBefore> before,
                                         const btVector3& gravity) {
    for (std::size_t i = 0; i < steps_.size(); ++i) {
        PieceStep& step = steps_[i];
        const btRigidBody& body = *pieces_[i].body;
        const MemberPiece& piece = course_.pieces()[i];
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
                              description().length() * norm(went.spin));
    }
}

} // namespace ductile::bullet
