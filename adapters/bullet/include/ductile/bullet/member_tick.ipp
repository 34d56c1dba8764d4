// SPDX-License-Identifier: MIT
//
// Bodies of member_tick.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "ductile/bullet/convert.hpp"
#include "ductile/bullet/member_tick.hpp"

namespace ductile::bullet {

DUCTILE_INLINE void MemberTick::begin() {
    touches_.clear();
    sum_ = 0;
    steps_.resize(member_->pieces_.size());
    for (std::size_t i = 0; i < steps_.size(); ++i) steps_[i].pose = member_->frame_of(i);
}

DUCTILE_INLINE void MemberTick::read(double dt, std::span<const BodyBefore> before,
                                     const btVector3& gravity) {
    loads_.clear();
    strike_ = {};
    for (const Touch& touch : touches_) read_contact(*touch.manifold, touch.of_a, before);
    read_constraints(dt, true);
    read_forces(dt, true);
    finish_steps(dt, before, gravity);
}

/// Whatever the arms of what acted on it: those of impulses and of the masses that they move.
DUCTILE_INLINE bool MemberTick::may_be_beyond(double dt, std::span<const BodyBefore> before,
                                              const btVector3& gravity) const {
    constexpr double arms = 4; // of its length
    const MemberCourse& of = member_->course_;
    const double length = of.member().length();
    double all = sum_;
    bool solved = of.member().clamped();
    if (solved) all += of.member().mass() * double(gravity.length()) * dt;
    for (const PieceBody& piece : member_->pieces_) {
        const btRigidBody& body = *piece.body;
        if (body.isStaticObject() || !body.isActive()) continue;
        solved = true;
        const BodyBefore& was = before[std::size_t(body.getWorldArrayIndex())];
        all += double(body.getMass()) * double(was.spin.length2()) * length * dt;
    }
    return solved && arms * all * length > of.least_strength() * dt;
}

DUCTILE_INLINE int MemberTick::segment_at(const Member& member, std::size_t piece,
                                          const JointFrame<double>& pose,
                                          const Vector3<double>& point) {
    const MemberPiece& of = member.course_.pieces()[piece];
    int nearest = of.run.last;
    double least = std::numeric_limits<double>::infinity();
    for (int k = of.run.first; k <= of.run.last; ++k) {
        if (member.description().segment(k).held) continue;
        const JointFrame<double> segment = placed(pose, of.segment(k));
        Vector3<double> off = transposed_times(segment.axes, difference(point, segment.origin));
        const double half = member.description().segment(k).length / 2;
        off[2] -= std::clamp(off[2], -half, half);
        const double away = dot(off, off);
        if (away >= least) continue;
        least = away;
        nearest = k;
    }
    return nearest;
}

DUCTILE_INLINE void MemberTick::read_contact(const btPersistentManifold& manifold, bool of_a,
                                             std::span<const BodyBefore> before) {
    const btCollisionObject &a = *manifold.getBody0(), &b = *manifold.getBody1();
    const Member& member = *member_;
    std::size_t piece = 0;
    while (piece + 1 < member.pieces_.size() && member.pieces_[piece].body != (of_a ? &a : &b)) {
        ++piece;
    }
    const auto velocities = [before](const btCollisionObject& object, const btVector3& point) {
        const btRigidBody* body = btRigidBody::upcast(&object);
        std::pair<btVector3, btVector3> result{{0, 0, 0}, {0, 0, 0}};
        if (body == nullptr || body->isStaticObject()) return result;
        const BodyBefore& was = before[std::size_t(object.getWorldArrayIndex())];
        const btVector3 arm = point - body->getCenterOfMassPosition();
        result.first = was.velocity + was.spin.cross(arm);
        result.second = body->getVelocityInLocalPoint(arm);
        return result;
    };
    for (int k = 0; k < manifold.getNumContacts(); ++k) {
        const btManifoldPoint& point = manifold.getContactPoint(k);
        const btVector3 impulse = point.m_appliedImpulse * point.m_normalWorldOnB +
                                  point.m_appliedImpulseLateral1 * point.m_lateralFrictionDir1 +
                                  point.m_appliedImpulseLateral2 * point.m_lateralFrictionDir2;
        if (impulse.isZero()) continue;
        const btVector3 at = of_a ? point.getPositionWorldOnA() : point.getPositionWorldOnB();
        MemberLoad& load = loads_.emplace_back();
        load.segment = segment_at(member, piece, steps_[piece].pose, to_core(at));
        load.point = to_core(at);
        load.impulse = to_core(of_a ? impulse : -impulse);
        const auto [a_before, a_after] = velocities(a, at);
        const auto [b_before, b_after] = velocities(b, at);
        const auto closing = double(point.m_normalWorldOnB.dot(a_before - b_before));
        const auto after = double(point.m_normalWorldOnB.dot(a_after - b_after));
        strike_.energy -= double(point.m_appliedImpulse) * (closing + after) / 2;
        if (-closing > strike_.speed) {
            strike_.speed = -closing;
            strike_.segment = load.segment;
        }
    }
}

/// Of attachments and of its own joints.
DUCTILE_INLINE void MemberTick::read_constraints(double dt, bool lists) {
    const Member& member = *member_;
    const auto add = [&](const btTypedConstraint& constraint, std::size_t piece, int segment) {
        const btRigidBody* body = member.pieces_[piece].body;
        const btJointFeedback& told = *constraint.getJointFeedback();
        const bool of_a = &constraint.getRigidBodyA() == body;
        const btVector3 force = of_a ? told.m_appliedForceBodyA : told.m_appliedForceBodyB;
        const btVector3 torque = of_a ? told.m_appliedTorqueBodyA : told.m_appliedTorqueBodyB;
        sum_ +=
            dt * (double(force.length()) + double(torque.length()) / member.description().length());
        if (!lists) return;
        // about the body's centre, which was where its piece was
        JointFrame<double> pose = steps_[piece].pose;
        if (body == &member.user_) pose = frame_around(pose, member.maker_->whole_in_body());
        loads_.push_back(
            {segment, pose.origin, scaled(dt, to_core(force)), scaled(dt, to_core(torque))});
    };
    for (const Member::Attachment& attachment : member.attachments_) {
        const btTypedConstraint& constraint = *attachment.constraint;
        if (!constraint.isEnabled()) continue;
        const bool solved =
            constraint.getRigidBodyA().isActive() || constraint.getRigidBodyB().isActive();
        if (!solved) continue;
        add(constraint, member.course_.piece_of(attachment.segment), attachment.segment);
    }
    for (const Member::OpenSection& open : member.joints_) {
        if (!open.hinge->isEnabled()) continue;
        const std::size_t lower = member.course_.piece_of(open.section);
        if (member.pieces_[lower].own != nullptr) add(*open.hinge, lower, open.section);
        add(*open.hinge, lower + 1, open.section + 1);
    }
}

DUCTILE_INLINE void MemberTick::read_forces(double dt, bool lists) {
    const Member& member = *member_;
    for (const Member::Force& force : member.forces_) {
        sum_ += dt * norm(force.force);
        if (!lists) continue;
        const std::size_t piece = member.course_.piece_of(force.segment);
        const JointFrame<double> at =
            placed(steps_[piece].pose, member.course_.pieces()[piece].segment(force.segment));
        MemberLoad& load = loads_.emplace_back();
        load.segment = force.segment;
        load.point = sum(at.origin, times(at.axes, force.in_segment));
        load.impulse = scaled(dt, force.force);
    }
}

/// How its pieces went through the tick.
DUCTILE_INLINE void MemberTick::finish_steps(double dt, std::span<const BodyBefore> before,
                                             const btVector3& gravity) {
    const Member& member = *member_;
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
        const BodyBefore& was = before[std::size_t(body.getWorldArrayIndex())];
        const double keeps = std::pow(1 - double(body.getLinearDamping()), dt);
        const double keeps_spin = std::pow(1 - double(body.getAngularDamping()), dt);
        const Vector3<double> free =
            sum(scaled(keeps, to_core(was.velocity)), scaled(dt, to_core(body.getGravity())));
        step.spin = scaled(keeps_spin, to_core(was.spin));
        step.change.velocity = difference(to_core(body.getLinearVelocity()), free);
        step.change.spin = difference(to_core(body.getAngularVelocity()), step.spin);
        const bool turns = (body.getFlags() & BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_BODY) != 0;
        if (turns) step.dt = dt;
        if (&body == &member.user_) {
            // its inertia is the user's
            const Vector3<double> about =
                times(to_core(body.getInvInertiaTensorWorld().inverse()), step.change.spin);
            step.change.spin = times(piece.inverse_inertia_in_world(step.pose.axes), about);
        }
    }
}

} // namespace ductile::bullet
