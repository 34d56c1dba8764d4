// SPDX-License-Identifier: MIT
//
// Bodies of plastic_motor.hpp.
#pragma once

#include <array>
#include <cmath>

#include "ductile/bullet/link_rows.hpp"
#include "ductile/bullet/plastic_motor.hpp"
#include "ductile/bullet/reaction.hpp"
#include "ductile/joint/joint_axis.hpp"
#include "ductile/vocabulary/angle.hpp"
#include "ductile/world/part_rows.hpp"

namespace ductile::bullet {

DUCTILE_INLINE MotorConstraint::MotorConstraint(AxisJoint& joint, btHingeConstraint& hinge,
                                                AtBreak at_break)
    : PlasticConstraint(hinge.getRigidBodyA(), hinge.getRigidBodyB()),
      AxisQueries(joint),
      hinge_(hinge),
      at_break_(at_break),
      motor_was_on_(hinge.getEnableAngularMotor()),
      velocity_was_(hinge.getMotorTargetVelocity()),
      impulse_was_(hinge.getMaxMotorImpulse()) {
    hinge_.enableMotor(false);
    position_ = measure(body_motion(m_rbA), body_motion(m_rbB), 0);
    joint_.set_plastic_offset(position_);
}

DUCTILE_INLINE MotorConstraint::~MotorConstraint() {
    hinge_.enableAngularMotor(motor_was_on_ && !joint_.broken(), velocity_was_, impulse_was_);
}

DUCTILE_INLINE void MotorConstraint::restored(double position) {
    pending_ = false;
    position_ = position;
    restored_ = true;
    release_ = {};
    find_driven();
}

DUCTILE_INLINE JointView MotorConstraint::view() const {
    JointView view{.frame_a = m_rbA.getCenterOfMassTransform() * hinge_.getAFrame(),
                   .frame_b = m_rbB.getCenterOfMassTransform() * hinge_.getBFrame(),
                   .outcome = outcome(),
                   .utilisation = utilisation()};
    view.plastic_offset[Eigen::Index(index(JointAxis::torsion))] = joint_.plastic_offset();
    return view;
}

// ---- Bullet's side

DUCTILE_INLINE void MotorConstraint::getInfo1(btConstraintInfo1* info) {
    *info = {.m_numConstraintRows = 0, .nub = 0};
    row_ = no_row;
    if (world_ == nullptr || !hinge_.isEnabled() || joint_.broken()) return;
    prepare();
    info->m_numConstraintRows = 1;
}

DUCTILE_INLINE void MotorConstraint::getInfo2(btConstraintInfo2* info) {
    write_moment(*info, 0, axis_);
    write_limits(*info, 0, {axis_, true, limits_}, m_rbA, m_rbB, pivot(), dt_);
}

// ---- an island's side

DUCTILE_INLINE void MotorConstraint::open_rows(solve::Island& island, const IslandSeat& a,
                                               const IslandSeat& b, double /*tick*/,
                                               double /*erp*/) {
    row_ = no_row;
    if (world_ == nullptr || !hinge_.isEnabled() || joint_.broken()) return;
    prepare();
    row_ = int(island.rows.size());
    solve::IslandRow& row = add_moment_row(island, a, b, axis_, limits_.bias);
    row.compliance = limits_.compliance;
    row.lower = limits_.lower * dt_;
    row.upper = limits_.upper * dt_;
}

DUCTILE_INLINE void MotorConstraint::close_rows(const solve::Island& island) {
    if (row_ == no_row) return;
    const double impulse = island.rows[std::size_t(row_)].impulse;
    internalSetAppliedImpulse(btScalar(impulse));
    moment_ = impulse / dt_;
    island_unsolved_ = island.unsolved;
    if (m_jointFeedback == nullptr) return;
    const Vector3<double> none = Vector3<double>::Zero();
    write_feedback(*m_jointFeedback, m_rbA, m_rbB, none, none, none, scaled(impulse / dt_, axis_));
}

// ---- geometry

DUCTILE_INLINE Matrix3<double> MotorConstraint::axes() const {
    return to_core(m_rbA.getCenterOfMassTransform().getBasis() * hinge_.getAFrame().getBasis());
}
DUCTILE_INLINE Vector3<double> MotorConstraint::pivot() const {
    return to_core(m_rbA.getCenterOfMassTransform() * hinge_.getAFrame().getOrigin());
}
DUCTILE_INLINE double MotorConstraint::turning(const BodyState<double>& a,
                                               const BodyState<double>& b) const {
    return dot(axis_, difference(a.spin, b.spin));
}
DUCTILE_INLINE double MotorConstraint::measure(const BodyState<double>& a,
                                               const BodyState<double>& b, double predicted) const {
    const Matrix3<double> of_a = times(a.orientation, to_core(hinge_.getAFrame().getBasis()));
    const Matrix3<double> of_b = times(b.orientation, to_core(hinge_.getBFrame().getBasis()));
    const Matrix3<double> relative = transposed_times(of_b, of_a);
    return unwrap(std::atan2(relative(1, 0), relative(0, 0)), predicted);
}
DUCTILE_INLINE Matrix6<double> MotorConstraint::inverse_mass() const {
    return inverse_mass_of_rows(body_state(m_rbA), body_state(m_rbB), pivot(), axes());
}
DUCTILE_INLINE Vector6<double> MotorConstraint::twist(const BodyState<double>& a,
                                                      const BodyState<double>& b) const {
    const Vector3<double> at = pivot();
    const auto velocity = [&at](const BodyState<double>& body) {
        return sum(body.velocity, cross(body.spin, difference(at, body.position)));
    };
    return twist_of(difference(velocity(a), velocity(b)), difference(a.spin, b.spin));
}
// ---- a tick

DUCTILE_INLINE void MotorConstraint::prepare() {
    require_bodies_in_world();
    came_into_world();
    tell_keepers_of_step();
    dt_ = double(world_->getSolverInfo().m_timeStep);
    const BodyState<double> a = at_start(0, dt_, false), b = at_start(1, dt_, false);
    island_unsolved_ = 0;
    axis_ = column(times(a.orientation, to_core(hinge_.getAFrame().getBasis())), 2);
    const double now = measure(a, b, position_);
    if (!ahead_) take_in_hands(now); // else begin_part did
    keep(now, force_);
    const double mass =
        joint_.rigid() ? 0.0 : mass_of_rows(inverse_mass(), std::array{JointAxis::torsion})(0, 0);
    const double speed = turning(a, b);
    limits_ = joint_.prepare({now, speed, mass, ahead_, now - speed * dt_ / 2}, dt_);
    pending_ = true;
}

/// Put elsewhere by hand, which is no deformation.
DUCTILE_INLINE void MotorConstraint::take_in_hands(double now) {
    const bool by_hand = std::isfinite(now) && !std::exchange(restored_, false) && now != position_;
    if (by_hand) joint_.set_plastic_offset(joint_.plastic_offset() + now - position_);
    keep(now, force_);
}

// ---- a part of a frame

DUCTILE_INLINE void MotorConstraint::begin_part() {
    settle();
    take_in_hands(measure(body_motion(m_rbA), body_motion(m_rbB), position_));
}

DUCTILE_INLINE void MotorConstraint::keep_all() {
    settle();
    keep_life();
    joint_.keep();
    kept_ = {release_,  position_,         force_, unseen_turn_, island_unsolved_,
             restored_, hinge_.isEnabled()};
}

DUCTILE_INLINE void MotorConstraint::put_all_back() {
    pending_ = booked_ = false;
    row_ = no_row;
    put_life_back();
    joint_.put_back();
    release_ = kept_.release;
    position_ = kept_.position;
    force_ = kept_.force;
    unseen_turn_ = kept_.unseen_turn;
    island_unsolved_ = kept_.island_unsolved;
    restored_ = kept_.restored;
    if (!kept_.hinge_enabled || hinge_.isEnabled()) return;
    hinge_.setEnabled(true);
    if (!std::exchange(hinge_parts_bodies_, false)) return;
    m_rbA.addConstraintRef(&hinge_);
    m_rbB.addConstraintRef(&hinge_);
}

DUCTILE_INLINE void MotorConstraint::list_part_rows(std::size_t joint,
                                                    std::vector<PartRow>& rows) const {
    settle();
    double carried = 0;
    for (const btRigidBody* body : {&m_rbA, &m_rbB}) {
        if (!body->isKinematicObject()) continue;
        carried = std::max(carried, double(body->getAngularVelocity().length()) * dt_);
    }
    add_part_row(joint_, force_, carried, joint, acts(), rows);
}

DUCTILE_INLINE void MotorConstraint::settle() const {
    // a question: what it books has happened already, and only the books change
    if (!pending_) return;
    auto* self = const_cast<MotorConstraint*>(this);
    self->book(true);
    self->finish_tick();
}

DUCTILE_INLINE void MotorConstraint::end_tick() { pending_ ? book(false) : lose_driven(); }

DUCTILE_INLINE void MotorConstraint::book(bool late) {
    pending_ = false;
    const BodyState<double> a = at_end(0, late), b = at_end(1, late);
    const double speed = turning(a, b);
    const double force = row_ != no_row ? moment_ : double(internalGetAppliedImpulse()) / dt_;
    row_ = no_row;
    const double moved = ahead_ ? dt_ / 2 : dt_; // since the row was prepared
    const double position = measure(a, b, position_ + speed * moved);
    see_turn(speed, moved, position);
    joint_.commit({force, speed, position}, dt_);
    keep(position, force);
    booked_ = true;
}

DUCTILE_INLINE void MotorConstraint::finish_tick() {
    if (!std::exchange(booked_, false) || !joint_.broken()) return;
    if (at_break_ == AtBreak::disable_joint) {
        hinge_.setEnabled(false);
        hinge_parts_bodies_ = detail::let_collide(hinge_);
        detail::let_collide(*this);
    }
    if (joint_.last().release > 0) hand_back();
}

DUCTILE_INLINE void MotorConstraint::hand_back() {
    const BodyState<double> a = body_state(m_rbA), b = body_state(m_rbB);
    const auto at_pivot = [this](const BodyState<double>& body) {
        return BodyAtJoint<double>{body.inverse_mass, body.inverse_inertia,
                                   difference(pivot(), body.position)};
    };
    const Vector6<double> direction = twist_of(Vector3<double>(0, 0, 0), column(axes(), 2));
    release_ =
        break_release(at_pivot(a), at_pivot(b), direction, twist(a, b), joint_.last().release);
    apply(m_rbA, release_.a);
    apply(m_rbB, release_.b);
}

} // namespace ductile::bullet
