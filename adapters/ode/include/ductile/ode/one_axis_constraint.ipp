// SPDX-License-Identifier: MIT
//
// Bodies of one_axis_constraint.hpp.
#pragma once

#include <cmath>
#include <limits>
#include <stdexcept>

#include "ductile/ode/convert.hpp"
#include "ductile/ode/one_axis_constraint.hpp"
#include "ductile/ode/precision_check.hpp"
#include "ductile/vocabulary/finite.hpp"
#include "ductile/vocabulary/linkage.hpp"
#include "ductile/vocabulary/symmetric_row.hpp"

namespace ductile::ode {

namespace detail {

inline constexpr const char* stop_refused =
    "OneAxisConstraint.row: the axis has a stop (dParamLoStop or dParamHiStop is "
    "finite): ODE applies a motor at its stop as an outside force, so no row can be "
    "plastic there; set both to infinity";

} // namespace detail

DUCTILE_INLINE OneAxisConstraint::OneAxisConstraint(AxisJoint& joint, const MotorAxis& row,
                                                    AtBreak at_break, bool owned)
    : AxisQueries(joint),
      row_(row),
      life_(WorldLife::of(dBodyGetWorld(row.bodies().a))),
      at_break_(at_break),
      owned_(owned) {
    require_matching_precision();
    if (has_stop(row_)) throw std::invalid_argument(detail::stop_refused);
    position_ = row_.measure(0);
    joint_.set_plastic_offset(position_);
    wait_for_world(row_.bodies().a, row_.bodies().b);
}

DUCTILE_INLINE OneAxisConstraint::~OneAxisConstraint() {
    if (!world_goes_on()) return;
    if (dJointGetFeedback(row_.joint()) == &feedback_) dJointSetFeedback(row_.joint(), nullptr);
    if (owned_) dJointDestroy(row_.joint());
}

DUCTILE_INLINE void OneAxisConstraint::restored(double position) {
    position_ = position;
    restored_ = true;
    driven_.forget();
    if (joint_.broken()) part(); // broken is broken, also when it was saved
}

DUCTILE_INLINE void OneAxisConstraint::add_speeds(JointReport<double>& report) const {
    if (!row_.attached() || dJointIsEnabled(id()) == 0) return;
    const double velocity = is_where_left() ? pose_.velocity(row_) : row_.velocity();
    (row_.turns() ? report.rotation_rate : report.elongation_rate) = std::abs(velocity);
}

// ---- life

DUCTILE_INLINE bool OneAxisConstraint::has_stop(const MotorAxis& row) {
    return std::isfinite(row.get(dParamLoStop)) || std::isfinite(row.get(dParamHiStop));
}

DUCTILE_INLINE void OneAxisConstraint::check() const {
    if (joint_.broken() || !row_.attached() || !has_stop(row_)) return;
    throw std::logic_error(detail::stop_refused);
}

DUCTILE_INLINE bool OneAxisConstraint::may_act() const {
    const auto& [a, b, reversed] = row_.bodies();
    return !detached_ && dJointIsEnabled(id()) != 0 && (can_move(a) || can_move(b));
}

DUCTILE_INLINE bool OneAxisConstraint::solved() const {
    const auto& [a, b, reversed] = row_.bodies();
    return dBodyIsEnabled(a) != 0 || (b != nullptr && dBodyIsEnabled(b) != 0);
}

DUCTILE_INLINE void OneAxisConstraint::suspend() {
    joint_.pause();
    driven_.forget();
    rigid_residual_ = unseen_turn_ = 0;
    rigid_unsolved_ = false;
}

DUCTILE_INLINE double OneAxisConstraint::follow_teleport() {
    const double now = row_.measure(position_);
    if (!std::isfinite(now)) return now;
    if (now != position_ && !restored_) {
        joint_.set_plastic_offset(joint_.plastic_offset() + now - position_);
    }
    restored_ = false;
    return position_ = now;
}

DUCTILE_INLINE void OneAxisConstraint::part() {
    row_.set(dParamFMax, 0);
    if (at_break_ != AtBreak::disable_joint) return;
    dJointDisable(id());
    dJointAttach(id(), nullptr, nullptr);
}

// ---- a step

DUCTILE_INLINE void OneAxisConstraint::prepare(double dt) {
    acting_ = false;
    outside_ = {};
    detached_ = !joint_.broken() && !row_.attached();
    if (joint_.broken()) {
        force_ = 0;
        if (row_.attached()) part();
        return;
    }
    if (!may_act()) {
        suspend();
        force_ = 0;
        return;
    }
    acting_ = true;
    double position = position_;
    if (restored_ || !is_where_left()) {
        pose_.look(row_);
        position = follow_teleport();
    }
    Motion<double> motion{position, start_velocity(dt), 0, force_share_.midway};
    if (!joint_.rigid()) motion.mass = mass();
    set_motor(joint_.prepare(motion, force_share_.value * dt), dt);
    rigid_target_ = rigid_target(dt);
}

DUCTILE_INLINE void OneAxisConstraint::commit(double dt) {
    if (!acting_) return;
    if (!solved()) {
        take_back();
        suspend();
        return;
    }
    const Vector6<double> twist = pose_.twist(row_);
    const double velocity = pose_.along(row_, twist);
    driven_.booked(0, row_.bodies().a, dt);
    driven_.booked(1, row_.bodies().b, dt);
    certify_rigid_rows(twist);
    const double force = row_force();
    const double position =
        row_.measured()
            ? row_.measure(position_ + velocity * dt)
            : position_ + row_.increment(pose_.placement(), pose_.axis(), pose_.point());
    if (row_.turns()) see_turn(velocity, dt, position);
    joint_.commit({force, velocity, position}, force_share_.value * dt);
    keep(position, force);
    pose_.look(row_);
    joint_.carry(pose_.velocity(row_)); // seen from where the bodies are now
    booked_ = true;
}

DUCTILE_INLINE void OneAxisConstraint::finish() {
    if (!std::exchange(booked_, false) || !joint_.broken()) return;
    if (joint_.last().release > 0) hand_back(joint_.last().release);
    part();
}

// ---- the row

DUCTILE_INLINE double OneAxisConstraint::erp() const {
    return double(dWorldGetERP(dBodyGetWorld(row_.bodies().a)));
}

DUCTILE_INLINE Vector6<double> OneAxisConstraint::rigid_target(double dt) const {
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    return twist_of(scaled(erp() / dt, row_.pin_error(pose_.point())),
                    Vector3<double>(unknown, unknown, unknown));
}

DUCTILE_INLINE Vector6<double> OneAxisConstraint::direction() const {
    const Vector3<double> none(0, 0, 0);
    return row_.turns() ? twist_of(none, pose_.axis()) : twist_of(pose_.axis(), none);
}

DUCTILE_INLINE double OneAxisConstraint::mass() const {
    const Vector6<double> response = row_.response(at_joint(row_.bodies().a, pose_.point()),
                                                   at_joint(row_.bodies().b, pose_.point()));
    const double result = dot(direction(), response);
    return std::isfinite(result) ? result : 0;
}

DUCTILE_INLINE double OneAxisConstraint::start_velocity(double dt) const {
    double velocity = pose_.velocity(row_);
    for (const int side : {0, 1}) {
        const dBodyID body = side == 0 ? row_.bodies().a : row_.bodies().b;
        if (!DrivenPair::is_driven(body)) continue;
        const BodyState<double> now = body_motion(body);
        const BodyState<double> then = driven_.at_start(side, body, now, dt);
        const Vector3<double> turn = difference(then.spin, now.spin);
        const Vector3<double>& arm = side == 0 ? pose_.arm_a() : pose_.arm_b();
        const Vector3<double> move = sum(difference(then.velocity, now.velocity), cross(turn, arm));
        velocity += (side == 0 ? 1 : -1) * dot(pose_.axis(), row_.turns() ? turn : move);
    }
    return velocity;
}

DUCTILE_INLINE void OneAxisConstraint::set_motor(const RowLimits<double>& limits, double dt) {
    const SymmetricRow row = symmetric_row(limits, dt, force_share_.value);
    centre_ = row.centre;
    strength_ = row.strength;
    row_.set(dParamCFM, row.cfm);
    row_.set(dParamVel, row.velocity);
    row_.set(dParamFMax, strength_);
    if (dJointGetFeedback(id()) == nullptr) dJointSetFeedback(id(), &feedback_);
    if (centre_ != 0) apply_centre();
}

DUCTILE_INLINE void OneAxisConstraint::apply_centre() {
    if (row_.turns()) {
        outside_.torque_a = scaled(centre_, pose_.axis());
        outside_.torque_b = scaled(-1, outside_.torque_a);
    } else {
        outside_.force = scaled(centre_, pose_.axis());
        outside_.torque_a = cross(pose_.arm_a(), outside_.force);
        outside_.torque_b = cross(outside_.force, pose_.arm_b());
    }
    add_outside(1);
}

DUCTILE_INLINE void OneAxisConstraint::take_back() {
    if (centre_ != 0) add_outside(-1);
    outside_ = {};
}

DUCTILE_INLINE void OneAxisConstraint::add_outside(double sign) {
    const auto& [a, b, reversed] = row_.bodies();
    add_force(a, scaled(sign, outside_.force), scaled(sign, outside_.torque_a));
    if (b != nullptr) add_force(b, scaled(-sign, outside_.force), scaled(sign, outside_.torque_b));
}

DUCTILE_INLINE void OneAxisConstraint::certify_rigid_rows(const Vector6<double>& twist) {
    const Vector3<double>& axis = pose_.axis();
    const auto off = [&](const Vector3<double>& is, const Vector3<double>& wanted, bool of_row) {
        if (!is_finite(wanted)) return Vector3<double>(0, 0, 0); // not known
        const Vector3<double> whole = difference(is, wanted);
        return of_row ? difference(whole, scaled(dot(axis, whole), axis)) : whole;
    };
    const Vector3<double> moving = off(linear(twist), linear(rigid_target_), !row_.turns());
    const Vector3<double> turning = off(angular(twist), angular(rigid_target_), row_.turns());
    rigid_residual_ = 0;
    for (int i = 0; i < 3; ++i) {
        rigid_residual_ = worse(rigid_residual_, worse(std::abs(moving[i]), std::abs(turning[i])));
    }

    const double speed = norm(moving), spin = norm(turning);
    rigid_unsolved_ = false;
    if (worse(speed, spin) <= joint_.allowed_residual(0)) return;
    const dBodyID a = row_.bodies().a;
    const Vector3<double> w = angular_velocity(a);
    const Vector3<double> v = sum(linear_velocity(a), cross(w, pose_.arm_a()));
    rigid_unsolved_ =
        !(speed <= joint_.allowed_residual(norm(v)) && spin <= joint_.allowed_residual(norm(w)));
}

DUCTILE_INLINE double OneAxisConstraint::row_force() const {
    const dJointFeedback* feedback = dJointGetFeedback(id());
    if (!(strength_ > 0) || feedback == nullptr) return centre_ / force_share_.value;
    return (centre_ + row_.force(*feedback, pose_.axes(), pose_.arm_a())) / force_share_.value;
}

DUCTILE_INLINE void OneAxisConstraint::hand_back(double energy) {
    const auto a = at_joint(row_.bodies().a, pose_.point());
    const auto b = at_joint(row_.bodies().b, pose_.point());
    release_ = break_release(
        a, b, release_impulse(row_.response(a, b), direction(), pose_.twist(row_), energy), energy);
    if (a.inverse_mass > 0) apply(row_.bodies().a, release_.a);
    if (b.inverse_mass > 0) apply(row_.bodies().b, release_.b);
}

} // namespace ductile::ode
