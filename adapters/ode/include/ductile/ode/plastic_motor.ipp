// SPDX-License-Identifier: MIT
//
// Bodies of plastic_motor.hpp.
#pragma once

#include <cmath>
#include <stdexcept>

#include "ductile/ode/convert.hpp"
#include "ductile/ode/plastic_motor.hpp"
#include "ductile/ode/precision_check.hpp"
#include "ductile/vocabulary/finite.hpp"
#include "ductile/vocabulary/symmetric_row.hpp"
#include "ductile/world/part_rows.hpp"

namespace ductile::ode {

namespace detail {

inline constexpr const char* stop_refused =
    "PlasticMotor.axis: has a stop (dParamLoStop or dParamHiStop is finite): ODE applies a motor "
    "at its stop as an outside force, so no row can be plastic there; set both to infinity";

} // namespace detail

DUCTILE_INLINE MotorConstraint::MotorConstraint(AxisJoint& joint, const MotorAxis& row,
                                                AtBreak at_break)
    : AxisQueries(joint),
      row_(row),
      life_(WorldLife::of(dBodyGetWorld(row.bodies().a))),
      at_break_(at_break),
      users_{row.get(dParamVel), row.get(dParamFMax), row.get(dParamCFM)} {
    require_matching_precision();
    if (has_stop(row_)) throw std::invalid_argument(detail::stop_refused);
    position_ = row_.measure(0);
    joint_.set_plastic_offset(position_);
    wait_for_world(row_.bodies().a, row_.bodies().b);
}

DUCTILE_INLINE MotorConstraint::~MotorConstraint() {
    if (!life_->goes_on()) return;
    if (dJointGetFeedback(row_.joint()) == &feedback_) dJointSetFeedback(row_.joint(), nullptr);
    give_motor_back();
}

DUCTILE_INLINE void MotorConstraint::give_motor_back() {
    if (!life_->goes_on()) return;
    row_.set(dParamVel, users_.velocity);
    row_.set(dParamFMax, joint_.broken() ? 0 : users_.strength);
    row_.set(dParamCFM, users_.cfm);
}

DUCTILE_INLINE void MotorConstraint::restored(double position) {
    position_ = position;
    restored_ = true;
    driven_.forget();
    if (joint_.broken()) part(); // broken is broken, also when it was saved
}

// ---- life

DUCTILE_INLINE bool MotorConstraint::has_stop(const MotorAxis& row) {
    return std::isfinite(row.get(dParamLoStop)) || std::isfinite(row.get(dParamHiStop));
}

DUCTILE_INLINE void MotorConstraint::check() const {
    if (joint_.broken() || !row_.attached() || !has_stop(row_)) return;
    throw std::logic_error(detail::stop_refused);
}

DUCTILE_INLINE bool MotorConstraint::may_act() const {
    const auto& [a, b, reversed] = row_.bodies();
    return !detached_ && dJointIsEnabled(id()) != 0 && (can_move(a) || can_move(b));
}

DUCTILE_INLINE bool MotorConstraint::solved() const {
    const auto& [a, b, reversed] = row_.bodies();
    return dBodyIsEnabled(a) != 0 || (b != nullptr && dBodyIsEnabled(b) != 0);
}

DUCTILE_INLINE void MotorConstraint::suspend() {
    joint_.pause();
    driven_.forget();
    rigid_residual_ = unseen_turn_ = 0;
    rigid_unsolved_ = false;
}

DUCTILE_INLINE double MotorConstraint::follow_teleport() {
    const double now = row_.measure(position_);
    if (!std::isfinite(now)) return now;
    if (now != position_ && !restored_) {
        joint_.set_plastic_offset(joint_.plastic_offset() + now - position_);
    }
    restored_ = false;
    return position_ = now;
}

DUCTILE_INLINE double MotorConstraint::moved_from(const MotorPose& last, double way) const {
    if (row_.measured()) return row_.measure(position_ + way);
    return position_ + row_.increment(last.placement(), last.axis(), last.point());
}

DUCTILE_INLINE void MotorConstraint::part() {
    row_.set(dParamFMax, 0);
    if (at_break_ != AtBreak::disable_joint) return;
    dJointDisable(id());
    dJointAttach(id(), nullptr, nullptr);
}

// ---- a step

DUCTILE_INLINE void MotorConstraint::prepare(double dt) {
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
    length_ = dt;
    Motion<double> motion{.ahead = ahead_};
    if (ahead_) {
        const MotorPose last = pose_;
        pose_.look(row_);
        motion.velocity = start_velocity(dt);
        motion.position = moved_from(last, motion.velocity * dt / 2);
        keep(motion.position, force_);
        motion.before = motion.position - motion.velocity * dt / 2;
    } else {
        pose_.look(row_);
        motion.position = follow_teleport();
        motion.velocity = start_velocity(dt);
    }
    if (!joint_.rigid()) motion.mass = mass();
    set_motor(joint_.prepare(motion, dt), dt);
    const auto erp = double(dWorldGetERP(dBodyGetWorld(row_.bodies().a)));
    const Vector3<double> error = row_.pin_error(pose_.point());
    pin_target_ = turned_pin_ = scaled(erp / dt, error);
    if (ahead_) {
        const auto [a, b, reversed] = row_.bodies();
        const Vector3<double> at = pose_.point(),
                              moves = difference(velocity_at(a, at), velocity_at(b, at));
        turned_pin_ = scaled(erp / dt, pin_as_began(error, moves, pin_turning(dt), dt / 2));
    }
}

/// By its bodies' spins as they are now.
DUCTILE_INLINE Vector3<double> MotorConstraint::pin_turning(double dt) const {
    const auto [a, b, reversed] = row_.bodies();
    return turned_pin(contact_body(a), pose_.arm_a(), contact_body(b), arm_of(b, pose_.point()),
                      dt / 2);
}

DUCTILE_INLINE void MotorConstraint::commit(double dt) {
    if (!acting_) return;
    if (!solved()) {
        take_back();
        suspend();
        acting_ = false;
        return;
    }
    const Vector6<double> twist = pose_.twist(row_);
    const double velocity = pose_.along(row_, twist);
    if (!ahead_) {
        driven_.booked(0, row_.bodies().a, dt);
        driven_.booked(1, row_.bodies().b, dt);
    }
    certify_pin(linear(twist), dt);
    const double force = row_force();
    const double moved = ahead_ ? dt / 2 : dt; // since the row was prepared
    const double position = moved_from(pose_, velocity * moved);
    if (row_.turns()) see_turn(velocity, moved, position);
    joint_.commit({force, velocity, position}, dt);
    keep(position, force);
    pose_.look(row_);
    joint_.carry(pose_.velocity(row_)); // seen from where the bodies are now
    booked_ = true;
}

DUCTILE_INLINE void MotorConstraint::finish() {
    if (!std::exchange(booked_, false) || !joint_.broken()) return;
    if (joint_.last().release > 0) hand_back(joint_.last().release);
    holds_on_ = true;
}

DUCTILE_INLINE void MotorConstraint::stand() {
    if (std::exchange(holds_on_, false)) part();
}

// ---- a part of a frame

DUCTILE_INLINE void MotorConstraint::driven_begins(dBodyID body, const Vector3<double>& velocity,
                                                   const Vector3<double>& spin) {
    for (const int side : {0, 1}) {
        const dBodyID of_side = side == 0 ? row_.bodies().a : row_.bodies().b;
        if (of_side == body) driven_.begins_part(side, velocity, spin);
    }
}

DUCTILE_INLINE bool MotorConstraint::begin_frame() {
    if (joint_.broken() || !row_.attached()) return false;
    pose_.look(row_);
    const bool put_back = restored_;
    (void)follow_teleport();
    return put_back;
}

DUCTILE_INLINE void MotorConstraint::keep_all() {
    joint_.keep();
    kept_ = {release_,        position_, force_, unseen_turn_, rigid_residual_,
             rigid_unsolved_, restored_, pose_,  outside_,     driven_};
}

DUCTILE_INLINE void MotorConstraint::put_all_back() {
    booked_ = acting_ = holds_on_ = false;
    joint_.put_back();
    release_ = kept_.release;
    position_ = kept_.position;
    force_ = kept_.force;
    unseen_turn_ = kept_.unseen_turn;
    rigid_residual_ = kept_.rigid_residual;
    rigid_unsolved_ = kept_.rigid_unsolved;
    restored_ = kept_.restored;
    pose_ = kept_.pose;
    outside_ = kept_.outside;
    driven_ = kept_.driven;
}

DUCTILE_INLINE void MotorConstraint::list_part_rows(std::size_t joint,
                                                    std::vector<PartRow>& rows) const {
    double carried = 0;
    for (const dBodyID body : {row_.bodies().a, row_.bodies().b}) {
        if (DrivenPair::is_driven(body)) {
            carried = std::max(carried, norm(angular_velocity(body)) * length_);
        }
    }
    add_part_row(joint_, force_, carried, joint, acting_, rows);
}

// ---- the row

DUCTILE_INLINE Vector6<double> MotorConstraint::direction() const {
    const Vector3<double> none(0, 0, 0);
    return row_.turns() ? twist_of(none, pose_.axis()) : twist_of(pose_.axis(), none);
}

DUCTILE_INLINE double MotorConstraint::mass() const {
    const Vector6<double> response = row_.response(at_joint(row_.bodies().a, pose_.point()),
                                                   at_joint(row_.bodies().b, pose_.point()));
    const double result = dot(direction(), response);
    return std::isfinite(result) ? result : 0;
}

DUCTILE_INLINE double MotorConstraint::start_velocity(double dt) const {
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

DUCTILE_INLINE void MotorConstraint::set_motor(const RowLimits<double>& limits, double dt) {
    const SymmetricRow row = symmetric_row(limits, dt);
    centre_ = row.centre;
    strength_ = row.strength;
    row_.set(dParamCFM, row.cfm);
    row_.set(dParamVel, row.velocity);
    row_.set(dParamFMax, strength_);
    if (dJointGetFeedback(id()) == nullptr) dJointSetFeedback(id(), &feedback_);
    if (centre_ != 0) apply_centre();
}

DUCTILE_INLINE void MotorConstraint::apply_centre() {
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

DUCTILE_INLINE void MotorConstraint::take_back() {
    if (centre_ != 0) add_outside(-1);
    outside_ = {};
}

DUCTILE_INLINE void MotorConstraint::add_outside(double sign) {
    const auto& [a, b, reversed] = row_.bodies();
    add_force(a, scaled(sign, outside_.force), scaled(sign, outside_.torque_a));
    if (b != nullptr) add_force(b, scaled(-sign, outside_.force), scaled(sign, outside_.torque_b));
}

DUCTILE_INLINE void MotorConstraint::certify_pin(const Vector3<double>& apart, double dt) {
    rigid_residual_ = 0;
    rigid_unsolved_ = false;
    if (!is_finite(pin_target_)) return; // not known
    Vector3<double> off = difference(apart, pin_target_);
    if (ahead_) { // of an island that was solved at once, not by ODE
        const Vector3<double> at_end = difference(difference(apart, turned_pin_), pin_turning(dt));
        if (norm(at_end) < norm(off)) off = at_end;
    }
    for (int i = 0; i < 3; ++i) rigid_residual_ = worse(rigid_residual_, std::abs(off[i]));

    const double speed = norm(off);
    if (speed <= joint_.allowed_residual(0)) return;
    const dBodyID a = row_.bodies().a;
    const Vector3<double> v = sum(linear_velocity(a), cross(angular_velocity(a), pose_.arm_a()));
    rigid_unsolved_ = !(speed <= joint_.allowed_residual(norm(v)));
}

DUCTILE_INLINE double MotorConstraint::row_force() const {
    const dJointFeedback* feedback = dJointGetFeedback(id());
    if (!(strength_ > 0) || feedback == nullptr) return centre_;
    return centre_ + row_.force(*feedback, pose_.axes(), pose_.arm_a());
}

DUCTILE_INLINE void MotorConstraint::hand_back(double energy) {
    const auto a = at_joint(row_.bodies().a, pose_.point());
    const auto b = at_joint(row_.bodies().b, pose_.point());
    release_ = break_release(
        a, b, release_impulse(row_.response(a, b), direction(), pose_.twist(row_), energy), energy);
    if (a.inverse_mass > 0) apply(row_.bodies().a, release_.a);
    if (b.inverse_mass > 0) apply(row_.bodies().b, release_.b);
}

} // namespace ductile::ode
