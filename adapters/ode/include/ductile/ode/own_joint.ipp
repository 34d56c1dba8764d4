// SPDX-License-Identifier: MIT
//
// Bodies of own_joint.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "ductile/joint/rotation.hpp"
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
    ask_axis();
    axis_a_ = detail::in_body(bodies_.a, axis_);
    axis_b_ = detail::in_body(bodies_.b, axis_);
    turn_ = transposed_times(a.orientation, b.orientation);
    const Vector3<double> apart = difference(a.position, b.position);
    place_ = kind_ == dJointTypeFixed && bodies_.b != nullptr
                 ? scaled(-1, detail::in_body(bodies_.a, apart))
                 : detail::in_body(bodies_.b, apart);
    if (kind_ != dJointTypeHinge2) return;
    const Vector3<double> wheel = told(joint_, dJointGetHinge2Axis2);
    angle_ = std::atan2(norm(cross(axis_, wheel)), dot(axis_, wheel));
}

DUCTILE_INLINE bool OwnJoint::is_same() {
    constexpr double round_off = 1e-6;
    if (dJointGetType(joint_) != kind_ || attached_bodies(joint_) != bodies_) return false;
    ask_axis();
    return norm(difference(detail::in_body(bodies_.a, axis_), axis_a_)) < round_off;
}

DUCTILE_INLINE bool OwnJoint::fits() const {
    constexpr double nearly = 0.05; // [m | rad]
    switch (kind_) {
        case dJointTypeHinge:
        case dJointTypeHinge2:
            return norm(leans()) < nearly;
        case dJointTypeSlider:
            return norm(turned()) < nearly && norm(cross(axis_, shifted())) < nearly;
        case dJointTypeFixed:
            return norm(turned()) < nearly && norm(shifted()) < nearly;
        default:
            return true; // ODE tells all
    }
}

// ---- how its bodies lie

DUCTILE_INLINE void OwnJoint::ask_axis() {
    switch (kind_) {
        case dJointTypeHinge:
            axis_ = told(joint_, dJointGetHingeAxis);
            break;
        case dJointTypeSlider:
            axis_ = told(joint_, dJointGetSliderAxis);
            break;
        case dJointTypeUniversal:
            axis_ =
                told(joint_, bodies_.reversed ? dJointGetUniversalAxis2 : dJointGetUniversalAxis1);
            break;
        case dJointTypeHinge2:
            axis_ = told(joint_, dJointGetHinge2Axis1);
            break;
        default:
            break; // none
    }
}

DUCTILE_INLINE Vector3<double> OwnJoint::turned() const {
    const Matrix3<double> wanted = times(body_motion(bodies_.a).orientation, turn_);
    return rotation_vector(times_transposed(body_motion(bodies_.b).orientation, wanted));
}

DUCTILE_INLINE Vector3<double> OwnJoint::shifted() const {
    const BodyState<double> a = body_motion(bodies_.a), b = body_motion(bodies_.b);
    const bool in_a = kind_ == dJointTypeFixed && bodies_.b != nullptr;
    const Vector3<double> place =
        in_a ? scaled(-1, times(a.orientation, place_)) : times(b.orientation, place_);
    return sum(difference(b.position, a.position), place);
}

DUCTILE_INLINE Vector3<double> OwnJoint::leans() const {
    if (kind_ == dJointTypeHinge) {
        return cross(axis_, times(body_motion(bodies_.b).orientation, axis_b_));
    }
    const Vector3<double> wheel = told(joint_, dJointGetHinge2Axis2), across = cross(axis_, wheel);
    const double sine = norm(across), angle = std::atan2(sine, dot(axis_, wheel));
    return scaled(std::sin(angle - angle_) / sine, across);
}

DUCTILE_INLINE std::array<Vector3<double>, 2> OwnJoint::pins() const {
    std::array<Vector3<double>, 2> pins;
    const auto ask = [&](void (*of_a)(dJointID, dVector3), void (*of_b)(dJointID, dVector3)) {
        pins = {told(joint_, of_a), told(joint_, of_b)};
        if (bodies_.reversed) std::swap(pins[0], pins[1]);
    };
    switch (kind_) {
        case dJointTypeHinge:
            ask(dJointGetHingeAnchor, dJointGetHingeAnchor2);
            break;
        case dJointTypeUniversal:
            ask(dJointGetUniversalAnchor, dJointGetUniversalAnchor2);
            break;
        case dJointTypeHinge2:
            ask(dJointGetHinge2Anchor, dJointGetHinge2Anchor2);
            break;
        default:
            ask(dJointGetBallAnchor, dJointGetBallAnchor2);
    }
    return pins;
}

DUCTILE_INLINE double OwnJoint::parameter(int name, int axis) const {
    return double(joint_calls(kind_).get(joint_, name + dParamGroup * axis));
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
    const bool all = kind_ == dJointTypeBall;
    for (std::size_t i = 0; i < along.size(); ++i) {
        row.along = along[i];
        const bool own = all || i == 0;
        pull(step, row, (own ? rate : step.rate) * dot(error, row.along), own ? cfm : step.cfm);
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

/// A motor at its stop is a given force, as in ODE.
DUCTILE_INLINE void OwnJoint::add_axis(const Step& step, const Axis& axis) {
    constexpr double unlimited = std::numeric_limits<double>::infinity();
    const auto get = [&](int name) { return parameter(name, axis.number); };
    const double least = get(dParamLoStop), most = get(dParamHiStop), strength = get(dParamFMax),
                 speed = get(dParamVel);
    const double turn = axis.turns ? std::numbers::pi : unlimited;
    const bool stops = axis.stops && least <= most && (least > -unlimited || most < unlimited) &&
                       (least >= -turn || most <= turn);
    const bool low = stops && axis.at <= least, high = stops && !low && axis.at >= most;
    Row row = midway();
    row.along = axis.along;
    row.turns = axis.turns;
    if (strength > 0 && !low && !high) {
        solve::IslandRow& motor = pull(step, row, speed, get(dParamCFM));
        motor.upper = strength * step.dt;
        motor.lower = -motor.upper;
        return;
    }
    if (!low && !high) return;
    if (strength > 0 && least < most) {
        double force = speed > 0 || (speed == 0 && high) ? strength : -strength;
        if ((low && speed > 0) || (high && speed < 0)) force *= get(dParamFudgeFactor);
        solve::IslandRow& given = pull(step, row, 0, 0);
        given.lower = given.upper = given.impulse = force * step.dt;
    }
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
    for (const Vector3<double>& along : plane_across(axis_)) {
        row.along = along;
        pull(step, row, step.rate * dot(error, along), step.cfm);
    }
}

/// `other` stays at its angle to the axis.
DUCTILE_INLINE void OwnJoint::hold_angle(const Step& step, const Vector3<double>& other,
                                         double error) {
    const Vector3<double> across = cross(axis_, other);
    pull(step, {.along = scaled(1 / norm(across), across), .turns = true}, step.rate * error,
         step.cfm);
}

DUCTILE_INLINE void OwnJoint::open_hinge(const Step& step) {
    hold_pin(step, step.world_axes, step.rate, step.cfm);
    hold_across(step, leans(), {.turns = true});
    const auto angle = double(dJointGetHingeAngle(joint_));
    add_axis(step, {.number = 0, .along = axis_, .at = bodies_.reversed ? -angle : angle});
}
DUCTILE_INLINE void OwnJoint::open_slider(const Step& step) {
    hold_turn(step);
    hold_across(step, shifted(), midway());
    add_axis(step, {.number = 0,
                    .along = scaled(bodies_.reversed ? -1 : 1, axis_),
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
    hold_angle(step, other, -dot(axis_, other));
    add_axis(step, {.number = 0, .along = axis_, .at = at[0]});
    add_axis(step, {.number = 1, .along = other, .at = at[1]});
}
DUCTILE_INLINE void OwnJoint::open_hinge2(const Step& step) {
    const auto [p, q] = plane_across(axis_);
    const Vector3<double> wheel = told(joint_, dJointGetHinge2Axis2), across = cross(axis_, wheel);
    hold_pin(step, {axis_, p, q}, parameter(dParamSuspensionERP) / step.dt,
             parameter(dParamSuspensionCFM));
    hold_angle(step, wheel, dot(leans(), across) / norm(across));
    add_axis(step, {.number = 0, .along = axis_, .at = double(dJointGetHinge2Angle1(joint_))});
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
                                        const IslandSeat& b, double dt) {
    const dWorldID world = dBodyGetWorld(bodies_.a);
    const Step step{
        island, a, b, dt, double(dWorldGetERP(world)) / dt, double(dWorldGetCFM(world))};
    first_ = int(island.rows.size());
    count_ = 0;
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
