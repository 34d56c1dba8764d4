// SPDX-License-Identifier: MIT
//
// A joint of the user's between a body of a member or structure and something else: it goes along
// where these become other bodies, anchors, axes and angle as they are. That is known of balls,
// hinges and fixed joints.
//
// Not thread-safe.
#pragma once

#include <ode/ode.h>

#include <array>
#include <optional>
#include <string>

#include "ductile/member/member_course.hpp"
#include "ductile/ode/piece.hpp"
#include "ductile/ode/world_snapshot.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::ode {

/// Where in the world a joint of the user's holds: a ball, a hinge or a fixed one. Plain value.
class JointPlace {
  public:
    explicit JointPlace(dJointID joint);
    /// It holds there then, bodies being where they were, but for `changed`, one of the two.
    void attach(dJointID joint, dBodyID first, dBodyID second, dBodyID changed) const;

  private:
    void attach_ball(dJointID joint, dBodyID first, dBodyID second) const;
    void attach_hinge(dJointID joint, dBodyID first, dBodyID second, dBodyID changed) const;

    std::array<dReal, 3> on_first_{}, on_second_{}, axis_{};
    dReal angle_ = 0;
};

/// Where a joint holds on to one of its bodies; nothing: a fixed one, it does not say.
/// @throws std::invalid_argument, beginning with `field`, of a joint that cannot go to another
/// body.
[[nodiscard]] std::optional<Vector3<double>> anchor_of(dJointID joint, dBodyID body,
                                                       const std::string& field);

struct UserJoint {
    dJointID joint;
    dBodyID body; ///< of the member or structure
    bool enabled;
    Wrench wrench{};   ///< when it was last solved; the ledger may have lent its feedback
    Wrench on_other{}; ///< the same, on what is on its other side
    std::array<ContactBody, 2> before{}; ///< a blow: of its body, of the other

    /// Null: the static world.
    [[nodiscard]] dBodyID other() const;
    [[nodiscard]] bool acts() const noexcept { return enabled; }
    /// In steps: what sleeps carries on as when it was solved; between what cannot move nothing is.
    [[nodiscard]] bool is_solved() const;
    /// Of what can move: it acts no more, or again; false: it is none.
    bool switch_on(bool on) const;
    void see_coming();
    /// After a solve; false: it was none of this.
    bool see();
    /// Holds on to this from now on.
    void go_to(dBodyID to);
    /// In a blow of `dt` [s] that was seen, of its own body or of the other; `place`: where it
    /// holds, world [m].
    [[nodiscard]] JointSide side(bool own, const Vector3<double>& place, double dt) const;
};

/// One as it was. Plain value.
class SavedHold {
  public:
    explicit SavedHold(const UserJoint& hold);
    /// It holds where it did, the bodies of the member or structure being where they were; what it
    /// holds on to may be elsewhere. False: it is another one, or holds something else now.
    bool put_back(UserJoint& now) const;

  private:
    dJointID joint_;
    JointPlace place_;
    Wrench wrench_;
    dBodyID other_; ///< on which it holds; null: the world
    std::optional<BodySnapshot> other_was_{};
};

} // namespace ductile::ode

#ifndef DUCTILE_COMPILED
#include "ductile/ode/user_joint.ipp"
#endif
