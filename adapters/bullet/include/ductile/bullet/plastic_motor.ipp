// SPDX-License-Identifier: MIT
//
// Bodies of plastic_motor.hpp.
#pragma once

#include <array>
#include <cmath>
#include <utility>

#include "ductile/bullet/link_rows.hpp"
#include "ductile/bullet/plastic_motor.hpp"
#include "ductile/joint/isolated_pair.hpp"
#include "ductile/joint/joint_axis.hpp"
#include "ductile/vocabulary/angle.hpp"
#include "ductile/vocabulary/linkage.hpp"

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
    position_ = measure(0);
    joint_.set_plastic_offset(position_);
}

DUCTILE_INLINE MotorConstraint::~MotorConstraint() {
    hinge_.enableAngularMotor(motor_was_on_ && !joint_.broken(), velocity_was_, impulse_was_);
}

DUCTILE_INLINE void MotorConstraint::restored(double position) {
    pending_ = false;
    position_ = position;
    release_ = {};
}

DUCTILE_INLINE JointView MotorConstraint::view() const {
    JointView view{.frame_a = m_rbA.getCenterOfMassTransform() * hinge_.getAFrame(),
                   .frame_b = m_rbB.getCenterOfMassTransform() * hinge_.getBFrame(),
                   .outcome = outcome(),
                   .utilisation = utilisation()};
    view.plastic_offset[Eigen::Index(index(JointAxis::torsion))] = joint_.plastic_offset();
    return view;
}

DUCTILE_INLINE void MotorConstraint::add_speeds(JointReport<double>& report) const {
    const Vector3<double> spin =
        difference(to_core(m_rbA.getAngularVelocity()), to_core(m_rbB.getAngularVelocity()));
    report.rotation_rate = std::abs(dot(column(axes(), 2), spin));
}

// ---- Bullet's side

DUCTILE_INLINE void MotorConstraint::getInfo1(btConstraintInfo1* info) {
    *info = {.m_numConstraintRows = 0, .nub = 0};
    close();
    if (world_ == nullptr || !hinge_.isEnabled() || joint_.broken()) return;
    prepare();
    SweepGroup* sweeps = sweeps_of_solver(*this, world_);
    if (sweeps == nullptr) {
        info->m_numConstraintRows = 1;
        return;
    }
    RowLimits<double> limits = limits_;
    limits.lower *= dt_;
    limits.upper *= dt_;
    const Vector3<double> none = Vector3<double>::Zero();
    open(*sweeps, m_rbA, m_rbB, none, none).add(none, axis_, limits);
}

DUCTILE_INLINE void MotorConstraint::getInfo2(btConstraintInfo2* info) {
    write_moment(*info, 0, axis_);
    write_limits(*info, 0, {axis_, true, limits_}, m_rbA, m_rbB, pivot(), compliance_is_exact(),
                 dt_, [this] { return moment_alone(); });
}

// ---- geometry

DUCTILE_INLINE Matrix3<double> MotorConstraint::axes() const {
    return to_core(m_rbA.getCenterOfMassTransform().getBasis() * hinge_.getAFrame().getBasis());
}
DUCTILE_INLINE Vector3<double> MotorConstraint::pivot() const {
    return to_core(m_rbA.getCenterOfMassTransform() * hinge_.getAFrame().getOrigin());
}
DUCTILE_INLINE double MotorConstraint::turning() const {
    return dot(axis_, difference(to_core(m_rbA.getAngularVelocity()),
                                 to_core(m_rbB.getAngularVelocity())));
}
DUCTILE_INLINE double MotorConstraint::measure(double predicted) const {
    const btMatrix3x3 a =
        m_rbA.getCenterOfMassTransform().getBasis() * hinge_.getAFrame().getBasis();
    const btMatrix3x3 b =
        m_rbB.getCenterOfMassTransform().getBasis() * hinge_.getBFrame().getBasis();
    const btMatrix3x3 relative = b.transposeTimes(a);
    return unwrap(std::atan2(double(relative[1][0]), double(relative[0][0])), predicted);
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
DUCTILE_INLINE double MotorConstraint::moment_alone() const {
    const Vector6<double> free = twist(free_state(m_rbA, tick_), free_state(m_rbB, tick_));
    const Matrix3<double> frame = axes();
    const Vector6<double> along_axes =
        twist_of(transposed_times(frame, linear(free)), transposed_times(frame, angular(free)));
    std::array<RowLimits<double>, 6> rows{};
    rows[index(JointAxis::torsion)] = limits_;
    return forces_of_isolated_pair(rows, inverse_mass(), along_axes,
                                   dt_)[Eigen::Index(index(JointAxis::torsion))];
}

// ---- a tick

DUCTILE_INLINE void MotorConstraint::prepare() {
    tell_keepers_of_step();
    tick_ = double(world_->getSolverInfo().m_timeStep);
    dt_ = force_share_.value * tick_;
    axis_ = column(axes(), 2);
    position_ = measure(position_);
    const double mass =
        joint_.rigid() ? 0.0 : mass_of_rows(inverse_mass(), std::array{JointAxis::torsion})(0, 0);
    limits_ = joint_.prepare({position_, turning(), mass, force_share_.midway}, dt_);
    pending_ = true;
}

DUCTILE_INLINE void MotorConstraint::settle() const {
    // a question: what it books has happened already, and only the books change
    if (pending_) const_cast<MotorConstraint*>(this)->settle_tick();
}

DUCTILE_INLINE void MotorConstraint::settle_tick() {
    pending_ = false;
    const double speed = turning();
    force_ = double(internalGetAppliedImpulse()) / dt_;
    if (is_open()) read_own_row();
    position_ = measure(position_ + speed * tick_);
    const Step<double>& step = joint_.commit({force_, speed, position_}, dt_);
    if (step.outcome != Outcome::broken) return;
    if (at_break_ == AtBreak::disable_joint) {
        hinge_.setEnabled(false);
        detail::let_collide(hinge_);
        detail::let_collide(*this);
    }
    if (step.release > 0) hand_back();
}

DUCTILE_INLINE void MotorConstraint::read_own_row() {
    force_ = impulses()[0] / dt_;
    internalSetAppliedImpulse(btScalar(impulses()[0]));
    if (m_jointFeedback == nullptr) return;
    const Vector3<double> none = Vector3<double>::Zero();
    write_feedback(*m_jointFeedback, m_rbA, m_rbB, none, none, none,
                   scaled(impulses()[0] / tick_, axis_));
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
