// SPDX-License-Identifier: MIT
//
// Bodies of joint_constraint.hpp.
#pragma once

#include "ductile/bullet/joint_constraint.hpp"
#include "ductile/bullet/link_rows.hpp"
#include "ductile/bullet/reaction.hpp"
#include "ductile/vocabulary/check.hpp"
#include "ductile/world/part_rows.hpp"

namespace ductile::bullet {

struct JointConstraint::Reading {
    btJointFeedback feedback; ///< for who has none of his own
    ReactionArm arm;
};

DUCTILE_INLINE JointConstraint::JointConstraint(AnyLink<double>& link, btRigidBody& a,
                                                btRigidBody& b, Feedback feedback, Meeting meeting)
    : PlasticConstraint(a, b),
      LinkQueries(link),
      feedback_(feedback),
      order_(rigid_rotations_first(link.axes())) {
    link_.start(body_motion(m_rbA), body_motion(m_rbB));
    if (meeting == Meeting::required) require_meeting("JointConstraint", link_);
}

DUCTILE_INLINE JointConstraint::~JointConstraint() = default;

DUCTILE_INLINE JointView JointConstraint::view() const {
    JointView view{.frame_a = m_rbA.getCenterOfMassTransform() * to_bullet(link_.frame_in_a()),
                   .frame_b = m_rbB.getCenterOfMassTransform() * to_bullet(link_.frame_in_b()),
                   .outcome = outcome(),
                   .utilisation = utilisation()};
    for (const JointAxis axis : all_joint_axes) {
        view.plastic_offset[Eigen::Index(index(axis))] = link_.plastic_offset(axis);
    }
    return view;
}

DUCTILE_INLINE void JointConstraint::restored(bool was_broken) {
    open_ = Open::nothing;
    release_ = {};
    find_driven();
    link_.look(body_motion(m_rbA), body_motion(m_rbB));
    if (link_.broken() != was_broken) was_broken ? hold_again() : let_go();
}

// ---- Bullet's side

DUCTILE_INLINE void JointConstraint::buildJacobian() {
    settle_late(true);
    told_ = false;
}

DUCTILE_INLINE void JointConstraint::getInfo1(btConstraintInfo1* info) {
    *info = {.m_numConstraintRows = 0, .nub = 0};
    if (link_.broken() && open_ != Open::hand_back) return;
    if (feedback_ == Feedback::all_rows && m_jointFeedback == nullptr) {
        m_jointFeedback = &reading().feedback;
    }
    info->m_numConstraintRows = 6;
}

DUCTILE_INLINE void JointConstraint::getInfo2(btConstraintInfo2* info) {
    if (open_ == Open::hand_back) {
        write_impulse(*info, m_rbA, m_rbB, link_.point(), handed_);
        return;
    }
    prepare(1 / double(info->fps), double(info->erp));
    if (feedback_ == Feedback::all_rows) {
        reading().arm = reaction_arm(m_rbA, m_rbB, link_.pose().arm_a(), link_.pose().arm_b());
    }
    write_rows(*info, m_rbA, m_rbB, link_, order_, dt_);
}

// ---- an island's side

DUCTILE_INLINE void JointConstraint::open_rows(solve::Island& island, const IslandSeat& a,
                                               const IslandSeat& b, double tick, double erp) {
    first_row_ = no_rows;
    if (open_ == Open::hand_back) {
        add_given_rows(island, a, b, link_.pose(), handed_);
        return;
    }
    if (link_.broken()) return;
    prepare(tick, erp);
    first_row_ = add_rows(island, link_, a, b, dt_);
}

DUCTILE_INLINE bool JointConstraint::turn_rows(solve::Island& island, const IslandSeat& a,
                                               const IslandSeat& b) {
    if (first_row_ == no_rows || !ahead_) return false; // a step as it is begins where rows are
    return ductile::turn_rows(island, link_, first_row_, a, m_rbA, b, m_rbB, body_motion, dt_);
}

DUCTILE_INLINE void JointConstraint::close_rows(const solve::Island& island) {
    if (first_row_ == no_rows) return;
    forces_ = take_forces(island, link_, first_row_, dt_);
    told_ = true;
    internalSetAppliedImpulse(btScalar(forces_[Eigen::Index(order_.back())] * dt_));
    if (m_jointFeedback == nullptr) return;
    const LinkPose<double>& pose = link_.pose();
    write_feedback(*m_jointFeedback, m_rbA, m_rbB, pose.arm_a(), pose.arm_b(),
                   times(pose.axes(), linear(forces_)),
                   times(pose.moment_axes(), angular(forces_)));
}

DUCTILE_INLINE void JointConstraint::setParam(int num, btScalar value, int /*axis*/) {
    if (num == BT_CONSTRAINT_ERP || num == BT_CONSTRAINT_STOP_ERP) {
        rigid_erp_ = value < 0 ? btScalar(-1)
                               : check::between("JointConstraint.erp", value, btScalar(0),
                                                btScalar(1), "", true);
    } else if (num == BT_CONSTRAINT_CFM || num == BT_CONSTRAINT_STOP_CFM) {
        check::fail("JointConstraint.cfm", value, "",
                    "left alone: compliance follows from the joint's stiffness");
    }
}

DUCTILE_INLINE btScalar JointConstraint::getParam(int num, int /*axis*/) const {
    return num == BT_CONSTRAINT_ERP || num == BT_CONSTRAINT_STOP_ERP ? rigid_erp_ : btScalar(0);
}

// ---- a tick

DUCTILE_INLINE void JointConstraint::prepare(double tick, double erp) {
    require_bodies_in_world();
    came_into_world();
    tell_keepers_of_step();
    dt_ = tick;
    const bool masses = link_.reads_mass();
    const BodyState<double> a = at_start(0, tick, masses), b = at_start(1, tick, masses);
    if (!ahead_) link_.teleport(a, b); // else begin_part has looked
    link_.prepare(a, b, dt_, (rigid_erp_ < 0 ? erp : double(rigid_erp_)) / tick, ahead_);
    open_ = Open::tick;
}

DUCTILE_INLINE void JointConstraint::end_tick() {
    if (open_ == Open::nothing) {
        lose_driven();
    } else {
        book(false);
    }
}

DUCTILE_INLINE void JointConstraint::finish_tick() { finish(false); }

DUCTILE_INLINE void JointConstraint::settle_late(bool in_solver) {
    if (open_ == Open::nothing) return;
    book(true);
    finish(in_solver);
}

DUCTILE_INLINE void JointConstraint::settle() const {
    // a question: what it books has happened already, and only the books change
    if (open_ != Open::nothing) const_cast<JointConstraint*>(this)->settle_late(false);
}

DUCTILE_INLINE void JointConstraint::book(bool late) {
    const Open was = std::exchange(open_, Open::nothing);
    if (was == Open::hand_back) let_go();
    if (was != Open::tick) return;
    const Vector6<double> forces = reaction();
    const BodyState<double> a = at_end(0, late), b = at_end(1, late);
    link_.commit_rows(a, b, forces, dt_);
    booked_ = true;
}

DUCTILE_INLINE void JointConstraint::finish(bool in_solver) {
    if (!std::exchange(booked_, false) || !link_.broken()) return;
    const BodyState<double> now_a = body_state(m_rbA), now_b = body_state(m_rbB);
    release_ = link_.release(now_a, now_b);
    if (in_solver && release_.energy > 0) {
        handed_ = link_.release_impulse(now_a, now_b);
        open_ = Open::hand_back;
        return;
    }
    let_go();
    if (release_.energy > 0) {
        apply(m_rbA, release_.a);
        apply(m_rbB, release_.b);
    }
}

// ---- a part of a frame

DUCTILE_INLINE void JointConstraint::begin_part() {
    settle_late(false);
    link_.teleport(body_motion(m_rbA), body_motion(m_rbB));
}

DUCTILE_INLINE void JointConstraint::keep_all() {
    settle_late(false);
    keep_life();
    link_.keep();
    kept_.set({release_, forces_, told_});
}

DUCTILE_INLINE void JointConstraint::put_all_back() {
    open_ = Open::nothing;
    booked_ = false;
    put_life_back();
    link_.put_back();
    release_ = kept_->release;
    forces_ = kept_->forces;
    told_ = kept_->told;
}

DUCTILE_INLINE void JointConstraint::list_part_rows(std::size_t joint,
                                                    std::vector<PartRow>& rows) const {
    settle();
    add_part_rows(link_, joint, is_awake(), rows);
}

// ---- what the solver did

DUCTILE_INLINE Vector6<double> JointConstraint::reaction() {
    if (told_) return forces_;
    Vector6<double> forces = Vector6<double>::Zero();
    if (feedback_ == Feedback::all_rows && m_jointFeedback != nullptr) {
        forces = forces_of_rows(*m_jointFeedback, reading().arm, link_);
    }
    if (one_axis()) {
        forces[Eigen::Index(order_.back())] = double(internalGetAppliedImpulse()) / dt_;
    }
    return forces;
}

DUCTILE_INLINE JointConstraint::Reading& JointConstraint::reading() {
    if (reading_ == nullptr) reading_ = std::make_unique<Reading>();
    return *reading_;
}

} // namespace ductile::bullet
