// SPDX-License-Identifier: MIT
//
// Bodies of own_joint.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "ductile/ode/joint_calls.hpp"
#include "ductile/ode/own_joint.hpp"

namespace ductile::ode {

namespace detail {

[[nodiscard]] DUCTILE_INLINE Vector3<double> in_body(dBodyID body, const Vector3<double>& axis) {
    return transposed_times(body_motion(body).orientation, axis);
}

/// Of a row's own effect: ODE's CFM of 1e-10 s/kg is there to keep its matrix regular, and is no
/// compliance of the joint [-].
inline constexpr double negligible = 1e-6;

/// No stop of it can be read.
[[nodiscard]] DUCTILE_INLINE bool has_angular_stops(dJointID motor) {
    for (int i = 0; i < dJointGetAMotorNumAxes(motor); ++i) {
        for (const int stop : {dParamLoStop, dParamHiStop}) {
            if (std::isfinite(dJointGetAMotorParam(motor, stop + dParamGroup * i))) return true;
        }
    }
    return false;
}

} // namespace detail

/// What all rows of a step have in common.
struct OwnJoint::Step {
    solve::Island& island;
    const IslandSeat &a, &b;
    double dt, rate, cfm; ///< [s], k, [s/kg]
    bool ahead;
    Vector3<double> axis; ///< the joint's, in A, world
    std::array<Vector3<double>, 3> world_axes{Vector3<double>(1, 0, 0), Vector3<double>(0, 1, 0),
                                              Vector3<double>(0, 0, 1)};
};

DUCTILE_INLINE bool OwnJoint::is_known(dJointID joint) {
    const AttachedBodies bodies = attached_bodies(joint);
    if (bodies.a == nullptr) return false;
    switch (dJointGetType(joint)) {
        case dJointTypeBall:
        case dJointTypeHinge:
        case dJointTypeSlider:
        case dJointTypeUniversal:
        case dJointTypeFixed:
            return true;
        case dJointTypeHinge2:
            return bodies.b != nullptr;
        case dJointTypeAMotor:
            return dJointGetAMotorMode(joint) == dAMotorUser && !detail::has_angular_stops(joint);
        default:
            return false;
    }
}

DUCTILE_INLINE OwnJoint::OwnJoint(dJointID joint)
    : joint_(joint), kind_(dJointGetType(joint)), bodies_(attached_bodies(joint)) {
    const BodyState<double> a = body_motion(bodies_.a), b = body_motion(bodies_.b);
    const Vector3<double> axis = axis_of(joint, bodies_.reversed);
    axis_a_ = detail::in_body(bodies_.a, axis);
    axis_b_ = detail::in_body(bodies_.b, axis);
    turn_ = transposed_times(a.orientation, b.orientation);
    const Vector3<double> apart = difference(a.position, b.position);
    place_ = kind_ == dJointTypeFixed && bodies_.b != nullptr
                 ? scaled(-1, detail::in_body(bodies_.a, apart))
                 : detail::in_body(bodies_.b, apart);
    if (kind_ != dJointTypeHinge2) return;
    const Vector3<double> wheel = told(joint_, dJointGetHinge2Axis2);
    angle_ = std::atan2(norm(cross(axis, wheel)), dot(axis, wheel));
}

DUCTILE_INLINE bool OwnJoint::is_same() const {
    constexpr double round_off = 1e-6;
    if (dJointGetType(joint_) != kind_ || attached_bodies(joint_) != bodies_) return false;
    const Vector3<double> axis = detail::in_body(bodies_.a, axis_of(joint_, bodies_.reversed));
    return norm(difference(axis, axis_a_)) < round_off;
}

DUCTILE_INLINE bool OwnJoint::fits() const {
    constexpr double nearly = 0.05; // [m | rad]
    switch (kind_) {
        case dJointTypeHinge:
        case dJointTypeHinge2:
            return norm(leans()) < nearly;
        case dJointTypeSlider: {
            const Vector3<double> axis = axis_of(joint_, bodies_.reversed);
            return norm(turned()) < nearly && norm(cross(axis, shifted())) < nearly;
        }
        case dJointTypeFixed:
            return norm(turned()) < nearly && norm(shifted()) < nearly;
        default:
            return true; // ODE tells all
    }
}

// ---- its rows

DUCTILE_INLINE solve::IslandRow& OwnJoint::pull(const Step& step, const Row& row, double target,
                                                double cfm) {
    rows_[std::size_t(count_++)] = row;
    solve::IslandRow& added =
        row.turns ? add_moment_row(step.island, step.a, step.b, row.along, target)
                  : add_row(step.island, step.a, step.b, row.arm_a, row.arm_b, row.along, target);
    const double compliance = cfm / step.dt;
    if (compliance > detail::negligible * solve::own_effect(step.island, added)) {
        added.compliance = compliance;
    }
    return added;
}

/// The last two rows by the world's settings, the first by these.
DUCTILE_INLINE void OwnJoint::hold_pin(const Step& step,
                                       const std::array<Vector3<double>, 3>& along, double rate,
                                       double cfm) {
    const auto [of_a, of_b] = pins();
    const Vector3<double> error = difference(of_b, of_a);
    Row row{.arm_a = arm_of(bodies_.a, of_a), .arm_b = arm_of(bodies_.b, of_b)};
    pinned_ = int(along.size());
    asked_ = Vector3<double>::Zero();
    Vector3<double> began = error; // as the part did
    if (step.ahead) {
        const double half = step.dt / 2;
        asked_ = turned_pin(contact_body(bodies_.a), row.arm_a, contact_body(bodies_.b), row.arm_b,
                            half);
        const Vector3<double> moves =
            difference(velocity_at(bodies_.a, of_a), velocity_at(bodies_.b, of_b));
        began = pin_as_began(error, moves, asked_, half);
    }
    for (std::size_t i = 0; i < along.size(); ++i) {
        row.along = along[i];
        if (is_sprung(i)) {
            pull(step, row, rate * dot(error, row.along), cfm);
            continue;
        }
        const bool own = kind_ == dJointTypeBall || i == 0;
        pull(step, row, (own ? rate : step.rate) * dot(began, row.along) + dot(asked_, row.along),
             own ? cfm : step.cfm);
    }
}

DUCTILE_INLINE void OwnJoint::hold_turn(const Step& step) {
    const Vector3<double> error = turned();
    for (int i = 0; i < 3; ++i) {
        Row row{.turns = true};
        row.along[i] = 1;
        pull(step, row, step.rate * error[i], step.cfm);
    }
}

/// A row between the centres of two bodies, or at that of one.
DUCTILE_INLINE OwnJoint::Row OwnJoint::midway() const {
    if (bodies_.b == nullptr) return {};
    const Vector3<double> half = scaled(0.5, arm_of(bodies_.a, body_motion(bodies_.b).position));
    return {.arm_a = half, .arm_b = scaled(-1, half)};
}

/// A motor at its stop is a given force, as in ODE; in a part of a frame it has a row of its own,
/// as that force would drive it beyond its speed.
DUCTILE_INLINE void OwnJoint::add_axis(const Step& step, const Axis& axis) {
    constexpr double unlimited = std::numeric_limits<double>::infinity();
    const auto get = [&](int name) { return parameter(name, axis.number); };
    const double least = get(dParamLoStop), most = get(dParamHiStop), speed = get(dParamVel);
    const double turn = axis.turns ? std::numbers::pi : unlimited;
    const bool stops = axis.stops && least <= most && (least > -unlimited || most < unlimited) &&
                       (least >= -turn || most <= turn);
    const bool low = stops && axis.at <= least, high = stops && !low && axis.at >= most;
    Row row = midway();
    row.along = axis.along;
    row.turns = axis.turns;
    double strength = get(dParamFMax);
    if ((low && speed > 0) || (high && speed < 0)) strength *= get(dParamFudgeFactor);
    const bool stopped = low || high;
    if (strength > 0 && !(stopped && least == most)) {
        solve::IslandRow& motor = pull(step, row, speed, stopped ? 0 : get(dParamCFM));
        motor.upper = strength * step.dt;
        motor.lower = -motor.upper;
        if (stopped && !step.ahead) {
            const bool up = speed > 0 || (speed == 0 && high);
            motor.lower = motor.upper = motor.impulse = up ? motor.upper : motor.lower;
        }
    }
    if (!stopped) return;
    const double beyond = axis.at - (low ? least : most);
    double target = -get(dParamStopERP) / step.dt * beyond;
    const Vector3<double> apart =
        axis.turns ? difference(angular_velocity(bodies_.a), angular_velocity(bodies_.b))
                   : difference(linear_velocity(bodies_.a), linear_velocity(bodies_.b));
    const double back = -get(dParamBounce) * dot(axis.along, apart);
    if (least < most) target = low ? std::max(target, back) : std::min(target, back);
    solve::IslandRow& stop = pull(step, row, target, get(dParamStopCFM));
    if (least == most) return;
    (low ? stop.lower : stop.upper) = 0;
}

/// Along, or about, two axes across its own.
DUCTILE_INLINE void OwnJoint::hold_across(const Step& step, const Vector3<double>& error, Row row) {
    for (const Vector3<double>& along : plane_across(step.axis)) {
        row.along = along;
        pull(step, row, step.rate * dot(error, along), step.cfm);
    }
}

/// `other` stays at its angle to the axis.
DUCTILE_INLINE void OwnJoint::hold_angle(const Step& step, const Vector3<double>& other,
                                         double error) {
    const Vector3<double> across = cross(step.axis, other);
    pull(step, {.along = scaled(1 / norm(across), across), .turns = true}, step.rate * error,
         step.cfm);
}

DUCTILE_INLINE void OwnJoint::open_hinge(const Step& step) {
    hold_pin(step, step.world_axes, step.rate, step.cfm);
    hold_across(step, leans(), {.turns = true});
    const auto angle = double(dJointGetHingeAngle(joint_));
    add_axis(step, {.number = 0, .along = step.axis, .at = bodies_.reversed ? -angle : angle});
}
DUCTILE_INLINE void OwnJoint::open_slider(const Step& step) {
    hold_turn(step);
    hold_across(step, shifted(), midway());
    add_axis(step, {.number = 0,
                    .along = scaled(bodies_.reversed ? -1 : 1, step.axis),
                    .turns = false,
                    .at = double(dJointGetSliderPosition(joint_))});
}
DUCTILE_INLINE void OwnJoint::open_universal(const Step& step) {
    const Vector3<double> other =
        told(joint_, bodies_.reversed ? dJointGetUniversalAxis1 : dJointGetUniversalAxis2);
    std::array<double, 2> at{double(dJointGetUniversalAngle1(joint_)),
                             double(dJointGetUniversalAngle2(joint_))};
    if (bodies_.reversed) at = {-at[1], at[0]};
    hold_pin(step, step.world_axes, step.rate, step.cfm);
    hold_angle(step, other, -dot(step.axis, other));
    add_axis(step, {.number = 0, .along = step.axis, .at = at[0]});
    add_axis(step, {.number = 1, .along = other, .at = at[1]});
}
DUCTILE_INLINE void OwnJoint::open_hinge2(const Step& step) {
    const auto [p, q] = plane_across(step.axis);
    const Vector3<double> wheel = told(joint_, dJointGetHinge2Axis2),
                          across = cross(step.axis, wheel);
    hold_pin(step, {step.axis, p, q}, parameter(dParamSuspensionERP) / step.dt,
             parameter(dParamSuspensionCFM));
    hold_angle(step, wheel, dot(leans(), across) / norm(across));
    add_axis(step, {.number = 0, .along = step.axis, .at = double(dJointGetHinge2Angle1(joint_))});
    add_axis(step, {.number = 1, .along = wheel, .stops = false});
}
DUCTILE_INLINE void OwnJoint::open_fixed(const Step& step) {
    const Vector3<double> error = shifted();
    Row row;
    if (bodies_.b != nullptr) {
        row.arm_a = difference(arm_of(bodies_.a, body_motion(bodies_.b).position), error);
    }
    for (const Vector3<double>& along : step.world_axes) {
        row.along = along;
        pull(step, row, parameter(dParamERP) / step.dt * dot(error, along), parameter(dParamCFM));
    }
    hold_turn(step);
}
DUCTILE_INLINE void OwnJoint::open_motor(const Step& step) {
    for (int i = 0; i < dJointGetAMotorNumAxes(joint_); ++i) {
        dVector3 axis;
        dJointGetAMotorAxis(joint_, i, axis);
        add_axis(step, {.number = i, .along = to_core(axis), .stops = false});
    }
}

DUCTILE_INLINE void OwnJoint::open_rows(solve::Island& island, const IslandSeat& a,
                                        const IslandSeat& b, double dt, bool ahead) {
    const dWorldID world = dBodyGetWorld(bodies_.a);
    const Step step{island,
                    a,
                    b,
                    dt,
                    double(dWorldGetERP(world)) / dt,
                    double(dWorldGetCFM(world)),
                    ahead,
                    axis_of(joint_, bodies_.reversed)};
    first_ = int(island.rows.size());
    count_ = pinned_ = 0;
    switch (kind_) {
        case dJointTypeBall:
            hold_pin(step, step.world_axes, parameter(dParamERP) / dt, parameter(dParamCFM));
            break;
        case dJointTypeHinge:
            open_hinge(step);
            break;
        case dJointTypeSlider:
            open_slider(step);
            break;
        case dJointTypeUniversal:
            open_universal(step);
            break;
        case dJointTypeHinge2:
            open_hinge2(step);
            break;
        case dJointTypeFixed:
            open_fixed(step);
            break;
        default:
            open_motor(step);
    }
}

DUCTILE_INLINE bool OwnJoint::turn_rows(solve::Island& island, const IslandSeat& a,
                                        const IslandSeat& b, double dt) {
    constexpr double noticed = 1e-4; // [m/s]
    if (pinned_ == 0) return false;
    const ContactBody of_a{.spin = leaving_spin(island, a)}, of_b{.spin = leaving_spin(island, b)};
    if (!(std::max(norm(of_a.spin), norm(of_b.spin)) * dt <= small_turn<double> / 2)) return false;
    const Row& pin = rows_.front();
    const Vector3<double> change =
        difference(turned_pin(of_a, pin.arm_a, of_b, pin.arm_b, dt / 2), asked_);
    if (!(norm(change) > noticed)) return false;
    for (int i = 0; i < pinned_; ++i) {
        if (is_sprung(std::size_t(i))) continue;
        island.rows[std::size_t(first_ + i)].target += dot(change, rows_[std::size_t(i)].along);
    }
    return true;
}

DUCTILE_INLINE void OwnJoint::close_rows(const solve::Island& island, double dt) const {
    Vector3<double> force(0, 0, 0), torque_a(0, 0, 0), torque_b(0, 0, 0);
    for (int i = 0; i < count_; ++i) {
        const Row& row = rows_[std::size_t(i)];
        const double impulse = island.rows[std::size_t(first_ + i)].impulse;
        const Vector3<double> acts = scaled(impulse / dt, row.along);
        if (!row.turns) force = sum(force, acts);
        torque_a = sum(torque_a, row.turns ? acts : cross(row.arm_a, acts));
        torque_b = difference(torque_b, row.turns ? acts : cross(row.arm_b, acts));
    }
    push(joint_, force, torque_a, torque_b);
}

} // namespace ductile::ode

#include "ductile/ode/own_joint_pose.ipp" // IWYU pragma: keep
