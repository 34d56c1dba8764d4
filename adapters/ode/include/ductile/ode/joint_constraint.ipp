// SPDX-License-Identifier: MIT
//
// Bodies of joint_constraint.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>

#include "ductile/ode/convert.hpp"
#include "ductile/ode/joint_constraint.hpp"
#include "ductile/ode/precision_check.hpp"
#include "ductile/vocabulary/symmetric_row.hpp"
#include "ductile/world/part_rows.hpp"

namespace ductile::ode {

namespace detail {

/// Share of its own effect by which a row yields [-]. Ties between repeated rows are then
/// solved to some 1e-4 of the force, and single rows are off by this share.
inline constexpr double softness = 1e-12;

/// Velocity of the row that a unit impulse of its own gives to one body [1/kg | 1/(kg m²)].
DUCTILE_INLINE double mobility(const BodyState<double>& body, const Vector3<double>& arm,
                               const LinkRow<double>& row) {
    const Vector3<double> turn = row.turns ? row.direction : cross(arm, row.direction);
    return (row.turns ? 0 : body.inverse_mass) + dot(turn, times(body.inverse_inertia, turn));
}

} // namespace detail

DUCTILE_INLINE JointConstraint::JointConstraint(AnyLink<double>& link, dWorldID world, dBodyID a,
                                                dBodyID b, Meeting meeting)
    : LinkQueries(link), a_(a), b_(b), life_(WorldLife::of(world)), forces_(world) {
    require_matching_precision();
    link_.start(body_motion(a_), body_motion(b_));
    if (meeting == Meeting::required) require_meeting("PlasticJoint", link_);
    id_ = dJointCreateAMotor(world, nullptr);
    dJointAttach(id_, a_, b_);
    dJointSetAMotorNumAxes(id_, 3);
    dJointSetFeedback(id_, &moments_);
    wait_for_world(a_, b_);
}

DUCTILE_INLINE JointConstraint::~JointConstraint() {
    if (life_->goes_on()) dJointDestroy(id_);
}

DUCTILE_INLINE dBodyID JointConstraint::require_bodies(const char* kind, dWorldID world, dBodyID a,
                                                       dBodyID b) {
    const auto require = [kind](bool right, const char* what) {
        if (!right) throw std::invalid_argument(kind + std::string(what));
    };
    require(a != nullptr, ".a = null: must be a body (only b may be the static world)");
    require(a != b, ".b: must not be body a itself");
    require(dBodyGetWorld(a) == world, ".a: must be a body of the joint's world");
    require(b == nullptr || dBodyGetWorld(b) == world, ".b: must be a body of the joint's world");
    return a;
}

DUCTILE_INLINE const JointFrame<double>& JointConstraint::require_frame(const char* name,
                                                                        const Frame& frame) {
    constexpr double round_off = 1e-9;
    return ductile::require_frame(std::string("PlasticJoint.") + name, frame, round_off);
}

DUCTILE_INLINE JointFrame<double> JointConstraint::frame_along(const std::string& kind,
                                                               const Vector3<double>& axis,
                                                               const Vector3<double>& origin) {
    if (!is_finite(axis) || !(norm(axis) > 0)) {
        throw std::invalid_argument(kind + ".axis: must be finite and of a length > 0");
    }
    if (!is_finite(origin)) throw std::invalid_argument(kind + ".anchor: must be finite [m]");
    constexpr double aside = 0.8;
    const Vector3<double> z = scaled(1 / norm(axis), axis);
    const Vector3<double> other =
        std::abs(z.x()) < aside ? Vector3<double>(1, 0, 0) : Vector3<double>(0, 1, 0);
    const Vector3<double> across = cross(z, other), y = scaled(1 / norm(across), across),
                          x = cross(y, z);
    JointFrame<double> frame{.origin = origin};
    for (int i = 0; i < 3; ++i) {
        frame.axes(i, 0) = x[i];
        frame.axes(i, 1) = y[i];
        frame.axes(i, 2) = z[i];
    }
    return frame;
}

DUCTILE_INLINE Vector3<double> JointConstraint::midway(dBodyID a, dBodyID b) {
    const Vector3<double> of_a = body_motion(a).position;
    return b == nullptr ? of_a : scaled(0.5, sum(of_a, body_motion(b).position));
}

DUCTILE_INLINE JointFrame<double> JointConstraint::frame_in(dBodyID body, const Frame& world) {
    const BodyState<double> at = body_motion(body);
    return {.origin = transposed_times(at.orientation, difference(world.origin, at.position)),
            .axes = transposed_times(at.orientation, world.axes)};
}

DUCTILE_INLINE void JointConstraint::restored(bool was_broken) {
    put_back_ = true;
    driven_.forget();
    silent_ = link_.broken();
    if (link_.broken()) {
        let_go();
        return;
    }
    dJointEnable(id_);
    if (was_broken) dJointAttach(id_, a_, b_);
}

// ---- life

DUCTILE_INLINE bool JointConstraint::detached() const {
    return !link_.broken() && (dJointGetBody(id_, 0) != a_ || dJointGetBody(id_, 1) != b_);
}
DUCTILE_INLINE bool JointConstraint::may_act() const {
    return !detached() && dJointIsEnabled(id_) != 0 && (can_move(a_) || can_move(b_));
}
DUCTILE_INLINE bool JointConstraint::solved() const {
    return dBodyIsEnabled(a_) != 0 || (b_ != nullptr && dBodyIsEnabled(b_) != 0);
}

// ---- a structure's side

DUCTILE_INLINE bool JointConstraint::is_awake_member() const { return may_act() && solved(); }
DUCTILE_INLINE std::array<const void*, 2> JointConstraint::moving_bodies() const {
    if (detached()) return {};
    const auto moving = [](dBodyID body) { return can_move(body) ? body : nullptr; };
    return {moving(a_), moving(b_)};
}
/// ODE begins to count anew.
DUCTILE_INLINE void JointConstraint::keep_awake() {
    for (const dBodyID body : {a_, b_}) {
        if (can_move(body) && dBodyIsEnabled(body) != 0) dBodyEnable(body);
    }
}

// ---- a step

DUCTILE_INLINE void JointConstraint::prepare(double dt) {
    acting_ = false;
    outside_ = {};
    if (link_.broken() || !may_act()) {
        if (!link_.broken()) link_.pause();
        driven_.forget();
        silent_ = true;
        return;
    }
    acting_ = true;
    const auto [a, b] = at_start(dt);
    const double rate = double(dWorldGetERP(dBodyGetWorld(a_))) / dt;
    link_.prepare(a, b, dt, rate, ahead_);
    arm_a_ = difference(link_.point(), a.position);
    arm_b_ = difference(link_.point(), b.position);
    centre_ = {};
    solved_rows_.reset();
    moments_ = {}; // ODE leaves it alone where the motor has no row
}

/// In a part of a frame begin_frame has looked.
DUCTILE_INLINE std::array<BodyState<double>, 2> JointConstraint::at_start(double dt) {
    const auto now = [this](dBodyID body) {
        if (link_.reads_mass()) return body_state(body);
        BodyState<double> motion = body_motion(body);
        // a part asks what is driven
        if (ahead_ && can_move(body)) motion.inverse_mass = 1 / mass(body);
        return motion;
    };
    const std::array<BodyState<double>, 2> bodies{driven_.at_start(0, a_, now(a_), dt),
                                                  driven_.at_start(1, b_, now(b_), dt)};
    if (!ahead_ && !std::exchange(put_back_, false)) link_.teleport(bodies[0], bodies[1]);
    return bodies;
}

DUCTILE_INLINE void JointConstraint::open_rows(solve::Island& island, const IslandSeat& a,
                                               const IslandSeat& b, double dt) {
    first_row_ = add_rows(island, link_, a, b, dt);
}

DUCTILE_INLINE bool JointConstraint::turn_rows(solve::Island& island, const IslandSeat& a,
                                               const IslandSeat& b, double dt) {
    return ductile::turn_rows(island, link_, first_row_, a, a_, b, b_, body_motion, dt);
}

DUCTILE_INLINE void JointConstraint::close_rows(const solve::Island& island, double dt) {
    const Vector6<double> forces = take_forces(island, link_, first_row_, dt);
    solved_rows_ = forces;
    const LinkPose<double>& pose = link_.pose();
    centre_ = {.force = times(pose.axes(), linear(forces)),
               .moment = times(pose.moment_axes(), angular(forces))};
    rest_motor();
    add_centre(1);
}

DUCTILE_INLINE void JointConstraint::make_rows(double dt) {
    const BodyState<double> a = body_state(a_), b = body_state(b_);
    std::array<PointRow, 3> force_rows, moment_rows;
    bool out_of_scale = false; // a moment's row
    for (const JointAxis axis : all_joint_axes) {
        const LinkRow<double> row = link_.row(axis).along_unit();
        SymmetricRow symmetric = symmetric_row(row.limits, dt);
        const double moved = detail::mobility(a, arm_a_, row) + detail::mobility(b, arm_b_, row);
        // a spring yields enough by itself: in parts of microseconds it would miss its force by
        // that
        const double softness = row.limits.compliance > 0 ? 0 : row.limits.softness;
        symmetric.cfm += std::max(detail::softness * moved, softness) * dt;
        Vector3<double>& centre = row.turns ? centre_.moment : centre_.force;
        centre = sum(centre, scaled(symmetric.centre, row.direction));
        const double scale = row_scale(moved + symmetric.cfm / dt);
        out_of_scale = out_of_scale || (row.turns && scale != 1);
        (row.turns ? moment_rows : force_rows)[index(axis) % 3] = {row.direction, symmetric, scale};
    }
    forces_.make(a_, b_, link_.point(), force_rows);
    for (int i = 0; i < 3; ++i) set_motor(i, moment_rows[std::size_t(i)], !out_of_scale);
    if (out_of_scale) forces_.make_moments(a_, b_, moment_rows);
    motor_on_ = true;
    add_centre(1);
}

DUCTILE_INLINE void JointConstraint::commit(double dt) {
    if (!acting_) return;
    if (!solved()) {
        // ODE keeps what was applied for the step
        add_centre(-1);
        forces_.clear();
        link_.pause();
        driven_.forget();
        acting_ = false;
        return;
    }
    silent_ = false;
    if (!ahead_) {
        driven_.booked(0, a_, dt);
        driven_.booked(1, b_, dt);
    }
    outside_ = forces_.collect();
    const auto about_centre = [this](const Vector3<double>& arm) {
        return sum(cross(arm, centre_.force), centre_.moment);
    };
    outside_.force = sum(outside_.force, centre_.force);
    outside_.torque_a = sum(outside_.torque_a, about_centre(arm_a_));
    outside_.torque_b = difference(outside_.torque_b, about_centre(arm_b_));
    if (solved_rows_) {
        link_.commit_rows(body_motion(a_), body_motion(b_), *solved_rows_, dt);
    } else {
        const Vector3<double> torque = sum(outside_.torque_a, to_core(moments_.t1));
        const Vector3<double> moment = difference(torque, cross(arm_a_, outside_.force));
        link_.commit(body_motion(a_), body_motion(b_),
                     JointWrench<double>{.force = outside_.force, .moment = moment}, dt);
    }
    booked_ = true;
}

DUCTILE_INLINE void JointConstraint::finish() {
    if (!std::exchange(booked_, false) || !link_.broken()) return;
    hand_back();
    holds_on_ = true;
}

DUCTILE_INLINE void JointConstraint::stand() {
    if (std::exchange(holds_on_, false)) let_go();
}

DUCTILE_INLINE void JointConstraint::left_world() {
    if (life_->goes_on()) rest_motor();
}

// ---- a part of a frame

DUCTILE_INLINE bool JointConstraint::begin_frame() {
    if (link_.broken() || detached()) return false;
    const bool put_back = std::exchange(put_back_, false);
    if (!put_back) link_.teleport(body_motion(a_), body_motion(b_));
    return put_back;
}

DUCTILE_INLINE void JointConstraint::driven_begins(dBodyID body, const Vector3<double>& velocity,
                                                   const Vector3<double>& spin) {
    for (const int side : {0, 1}) {
        if ((side == 0 ? a_ : b_) == body) driven_.begins_part(side, velocity, spin);
    }
}

DUCTILE_INLINE void JointConstraint::keep_all() {
    link_.keep();
    kept_.set({release_, outside_, driven_, silent_});
}

DUCTILE_INLINE void JointConstraint::put_all_back() {
    booked_ = acting_ = holds_on_ = false;
    link_.put_back();
    release_ = kept_->release;
    outside_ = kept_->outside;
    driven_ = kept_->driven;
    silent_ = kept_->silent;
}

DUCTILE_INLINE void JointConstraint::list_part_rows(std::size_t joint,
                                                    std::vector<PartRow>& rows) const {
    add_part_rows(link_, joint, acting_ && !link_.broken(), rows);
}

DUCTILE_INLINE void JointConstraint::set_motor(int number, const PointRow& moment, bool on) {
    constexpr int in_world = 0;
    const Vector3<double>& axis = moment.direction;
    dJointSetAMotorAxis(id_, number, in_world, dReal(axis.x()), dReal(axis.y()), dReal(axis.z()));
    const int group = dParamGroup * number;
    dJointSetAMotorParam(id_, dParamFMax + group, dReal(on ? moment.row.strength : 0));
    dJointSetAMotorParam(id_, dParamVel + group, dReal(moment.row.velocity));
    dJointSetAMotorParam(id_, dParamCFM + group, dReal(moment.row.cfm));
}

DUCTILE_INLINE void JointConstraint::rest_motor() {
    if (!std::exchange(motor_on_, false)) return;
    for (int i = 0; i < 3; ++i) {
        dJointSetAMotorParam(id_, dParamFMax + dParamGroup * i, 0);
    }
}

DUCTILE_INLINE void JointConstraint::add_centre(double sign) {
    const Vector3<double> force = scaled(sign, centre_.force);
    const Vector3<double> moment = scaled(sign, centre_.moment);
    add_force(a_, force, sum(cross(arm_a_, force), moment));
    if (b_ == nullptr) return;
    add_force(b_, scaled(-1, force), scaled(-1, sum(cross(arm_b_, force), moment)));
}

DUCTILE_INLINE void JointConstraint::let_go() {
    dJointDisable(id_);
    dJointAttach(id_, nullptr, nullptr);
}

DUCTILE_INLINE void JointConstraint::hand_back() {
    release_ = link_.release(body_state(a_), body_state(b_));
    if (can_move(a_)) apply(a_, release_.a);
    if (can_move(b_)) apply(b_, release_.b);
}

} // namespace ductile::ode
