// SPDX-License-Identifier: MIT
//
// Bodies of user_joint.hpp.
#pragma once

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "ductile/ode/convert.hpp"
#include "ductile/ode/user_joint.hpp"

namespace ductile::ode {

DUCTILE_INLINE JointPlace::JointPlace(dJointID joint) {
    const auto get = [joint](auto* of, std::array<dReal, 3>& result) {
        dVector3 found;
        of(joint, found);
        std::copy_n(found, 3, result.begin());
    };
    if (dJointGetType(joint) == dJointTypeBall) {
        get(dJointGetBallAnchor, on_first_);
        get(dJointGetBallAnchor2, on_second_);
    } else if (dJointGetType(joint) == dJointTypeHinge) {
        get(dJointGetHingeAnchor, on_first_);
        get(dJointGetHingeAxis, axis_);
        angle_ = dJointGetHingeAngle(joint);
    }
}
/// Anchors stay where they are, each on its own body.
DUCTILE_INLINE void JointPlace::attach_ball(dJointID joint, dBodyID first, dBodyID second) const {
    dJointAttach(joint, first, second);
    const bool reversed = attached_bodies(joint).reversed;
    const auto &a = reversed ? on_second_ : on_first_, &b = reversed ? on_first_ : on_second_;
    dJointSetBallAnchor(joint, a[0], a[1], a[2]);
    const dBodyID other = attached_bodies(joint).b;
    dVector3 in_other{b[0], b[1], b[2], 0};
    if (other != nullptr) dBodyGetPosRelPoint(other, b[0], b[1], b[2], in_other);
    dJointSetBallAnchor2(joint, in_other[0], in_other[1], in_other[2]);
}
/// Its angle goes on: ODE begins to count where the axis is set, so that is done where the angle is
/// zero (its dJointSetHingeAxisOffset is right for bodies that are turned alike alone).
DUCTILE_INLINE void JointPlace::attach_hinge(dJointID joint, dBodyID first, dBodyID second,
                                             dBodyID changed) const {
    dJointAttach(joint, first, second);
    dJointSetHingeAnchor(joint, on_first_[0], on_first_[1], on_first_[2]);
    const BodySnapshot pose(changed);
    dMatrix3 back, turned;
    dRFromAxisAndAngle(back, axis_[0], axis_[1], axis_[2], changed == first ? -angle_ : angle_);
    dMultiply0_333(turned, back, dBodyGetRotation(changed));
    dBodySetRotation(changed, turned);
    dJointSetHingeAxis(joint, axis_[0], axis_[1], axis_[2]);
    pose.put_pose_back(changed);
}
DUCTILE_INLINE void JointPlace::attach(dJointID joint, dBodyID first, dBodyID second,
                                       dBodyID changed) const {
    switch (dJointGetType(joint)) {
        case dJointTypeBall:
            return attach_ball(joint, first, second);
        case dJointTypeHinge:
            return attach_hinge(joint, first, second, changed);
        default:
            dJointAttach(joint, first, second);
            dJointSetFixed(joint);
    }
}

DUCTILE_INLINE std::optional<Vector3<double>> anchor_of(dJointID joint, dBodyID body,
                                                        const std::string& field) {
    const bool first = dJointGetBody(joint, 0) == body;
    switch (dJointGetType(joint)) {
        case dJointTypeBall:
            return told(joint, first ? dJointGetBallAnchor : dJointGetBallAnchor2);
        case dJointTypeHinge:
            return told(joint, first ? dJointGetHingeAnchor : dJointGetHingeAnchor2);
        case dJointTypeFixed:
            return std::nullopt;
        default:
            throw std::invalid_argument(
                field +
                ": joints of its body must be balls, hinges or fixed: others, also plastic ones, "
                "cannot go to another body as they are");
    }
}

DUCTILE_INLINE dBodyID UserJoint::other() const {
    const AttachedBodies bodies = attached_bodies(joint);
    return bodies.a == body ? bodies.b : bodies.a;
}
DUCTILE_INLINE bool UserJoint::is_solved() const {
    return acts() && (detail::is_solved(body) || detail::is_solved(other()));
}
DUCTILE_INLINE bool UserJoint::switch_on(bool on) const {
    if (!acts() || !can_move(other())) return false;
    (on ? dJointEnable : dJointDisable)(joint);
    return true;
}
DUCTILE_INLINE void UserJoint::see_coming() {
    before = {contact_body(body), contact_body(other())};
}
DUCTILE_INLINE bool UserJoint::see() {
    if (!is_solved()) return false;
    const bool of_a = attached_bodies(joint).a == body;
    wrench = wrench_of(*dJointGetFeedback(joint), of_a);
    on_other = wrench_of(*dJointGetFeedback(joint), !of_a);
    return true;
}
DUCTILE_INLINE void UserJoint::go_to(dBodyID to) {
    const dBodyID from = std::exchange(body, to);
    if (from == to) return;
    std::array<dBodyID, 2> bodies{dJointGetBody(joint, 0), dJointGetBody(joint, 1)};
    std::replace(bodies.begin(), bodies.end(), from, to);
    JointPlace(joint).attach(joint, bodies[0], bodies[1], to);
}
DUCTILE_INLINE JointSide UserJoint::side(bool own, const Vector3<double>& place, double dt) const {
    const dBodyID of = own ? body : other();
    if (of == nullptr || !is_solved()) return {};
    const Wrench& given = own ? wrench : on_other;
    return {.before = before[own ? 0 : 1],
            .after = contact_body(of),
            .arm = difference(place, to_core(dBodyGetPosition(of))),
            .impulse = scaled(dt, given.force),
            .moment = scaled(dt, given.torque)};
}

DUCTILE_INLINE SavedHold::SavedHold(const UserJoint& hold)
    : joint_(hold.joint), place_(hold.joint), wrench_(hold.wrench), other_(hold.other()) {
    if (other_ != nullptr) other_was_.emplace(other_);
}
DUCTILE_INLINE bool SavedHold::put_back(UserJoint& now) const {
    if (now.joint != joint_ || now.other() != other_) return false;
    std::optional<BodySnapshot> other_is;
    if (other_ != nullptr) {
        other_is.emplace(other_);
        other_was_->put_pose_back(other_);
    }
    place_.attach(joint_, dJointGetBody(joint_, 0), dJointGetBody(joint_, 1), now.body);
    if (other_ != nullptr) other_is->put_pose_back(other_);
    now.wrench = wrench_;
    return true;
}

} // namespace ductile::ode
