// SPDX-License-Identifier: MIT
//
// A joint of the user's between a body of a member or structure and something else: it goes along
// where these become other bodies, anchors, axes and angle as they are. That is known of balls,
// hinges and fixed joints.
//
// Not thread-safe.
#pragma once

#include <ode/ode.h>

#include <algorithm>
#include <array>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "ductile/member/member_course.hpp"
#include "ductile/ode/convert.hpp"
#include "ductile/ode/piece.hpp"
#include "ductile/ode/world_snapshot.hpp"

namespace ductile::ode {

/// Where in the world a joint of the user's holds: a ball, a hinge or a fixed one. Plain value.
class JointPlace {
  public:
    explicit JointPlace(dJointID joint) {
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
    /// It holds there then, bodies being where they were, but for `changed`, one of the two.
    void attach(dJointID joint, dBodyID first, dBodyID second, dBodyID changed) const {
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

  private:
    /// Anchors stay where they are, each on its own body.
    void attach_ball(dJointID joint, dBodyID first, dBodyID second) const {
        dJointAttach(joint, first, second);
        const bool reversed = attached_bodies(joint).reversed;
        const auto &a = reversed ? on_second_ : on_first_, &b = reversed ? on_first_ : on_second_;
        dJointSetBallAnchor(joint, a[0], a[1], a[2]);
        const dBodyID other = attached_bodies(joint).b;
        dVector3 in_other{b[0], b[1], b[2], 0};
        if (other != nullptr) dBodyGetPosRelPoint(other, b[0], b[1], b[2], in_other);
        dJointSetBallAnchor2(joint, in_other[0], in_other[1], in_other[2]);
    }
    /// Its angle goes on: ODE begins to count where the axis is set, so that is done where the
    /// angle is zero (its dJointSetHingeAxisOffset is right for bodies that are turned alike
    /// alone).
    void attach_hinge(dJointID joint, dBodyID first, dBodyID second, dBodyID changed) const {
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

    std::array<dReal, 3> on_first_{}, on_second_{}, axis_{};
    dReal angle_ = 0;
};

/// Where a joint holds on to one of its bodies; nothing: a fixed one, it does not say.
/// @throws std::invalid_argument, beginning with `field`, of a joint that cannot go to another
/// body.
[[nodiscard]] inline std::optional<Vector3<double>> anchor_of(dJointID joint, dBodyID body,
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

struct UserJoint {
    dJointID joint;
    dBodyID body; ///< of the member or structure
    bool enabled;
    Wrench wrench{};   ///< when it was last solved; the ledger may have lent its feedback
    Wrench on_other{}; ///< the same, on what is on its other side
    std::array<ContactBody, 2> before{}; ///< a blow: of its body, of the other

    /// Null: the static world.
    [[nodiscard]] dBodyID other() const {
        const AttachedBodies bodies = attached_bodies(joint);
        return bodies.a == body ? bodies.b : bodies.a;
    }
    [[nodiscard]] bool acts() const noexcept { return enabled; }
    /// In steps: what sleeps carries on as when it was solved; between what cannot move nothing is.
    [[nodiscard]] bool is_solved() const {
        return acts() && (detail::is_solved(body) || detail::is_solved(other()));
    }
    /// Of what can move: it acts no more, or again; false: it is none.
    bool switch_on(bool on) const {
        if (!acts() || !can_move(other())) return false;
        (on ? dJointEnable : dJointDisable)(joint);
        return true;
    }
    void see_coming() { before = {contact_body(body), contact_body(other())}; }
    /// After a solve; false: it was none of this.
    bool see() {
        if (!is_solved()) return false;
        const bool of_a = attached_bodies(joint).a == body;
        wrench = wrench_of(*dJointGetFeedback(joint), of_a);
        on_other = wrench_of(*dJointGetFeedback(joint), !of_a);
        return true;
    }
    /// Holds on to this from now on.
    void go_to(dBodyID to) {
        const dBodyID from = std::exchange(body, to);
        if (from == to) return;
        std::array<dBodyID, 2> bodies{dJointGetBody(joint, 0), dJointGetBody(joint, 1)};
        std::replace(bodies.begin(), bodies.end(), from, to);
        JointPlace(joint).attach(joint, bodies[0], bodies[1], to);
    }
    /// In a blow of `dt` [s] that was seen, of its own body or of the other; `place`: where it
    /// holds, world [m].
    [[nodiscard]] JointSide side(bool own, const Vector3<double>& place, double dt) const {
        const dBodyID of = own ? body : other();
        if (of == nullptr || !is_solved()) return {};
        const Wrench& given = own ? wrench : on_other;
        return {.before = before[own ? 0 : 1],
                .after = contact_body(of),
                .arm = difference(place, to_core(dBodyGetPosition(of))),
                .impulse = scaled(dt, given.force),
                .moment = scaled(dt, given.torque)};
    }
};

/// One as it was. Plain value.
class SavedHold {
  public:
    explicit SavedHold(const UserJoint& hold)
        : joint_(hold.joint), place_(hold.joint), wrench_(hold.wrench), other_(hold.other()) {
        if (other_ != nullptr) other_was_.emplace(other_);
    }
    /// It holds where it did, the bodies of the member or structure being where they were; what it
    /// holds on to may be elsewhere. False: it is another one, or holds something else now.
    bool put_back(UserJoint& now) const {
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

  private:
    dJointID joint_;
    JointPlace place_;
    Wrench wrench_;
    dBodyID other_; ///< on which it holds; null: the world
    std::optional<BodySnapshot> other_was_{};
};

} // namespace ductile::ode
