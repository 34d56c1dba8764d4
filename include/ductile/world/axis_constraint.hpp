// SPDX-License-Identifier: MIT
//
// A joint of a given type in an engine's constraint of one row: the little that depends on the
// type.
#pragma once

#include <utility>

#include "ductile/joint/axis_joint.hpp"
#include "ductile/joint/usual_joints.hpp"
#include "ductile/vocabulary/check.hpp"
#include "ductile/world/joint_checks.hpp"

namespace ductile {

/// The joint before the constraint that refers to it.
template <class Joint>
struct AxisJointOwner {
    explicit AxisJointOwner(Joint joint) : axis_joint(std::move(joint)) {}
    AxisJointOf<Joint> axis_joint;
};

/// `Constraint`: an engine's, made of an AxisJoint and more; derives from AxisQueries and has
/// `restored(position)`.
template <class Joint, class Constraint>
class AxisConstraint : private AxisJointOwner<Joint>, public Constraint {
  public:
    using State = typename Joint::State;

    [[nodiscard]] const Joint& joint() const {
        this->settle();
        return AxisJointOwner<Joint>::axis_joint.joint();
    }
    /// Goes on from `state` at `position` [m | rad], both as saved; the bodies have to be put back
    /// too, before or after.
    /// @throws std::invalid_argument where one is none that a joint can come to.
    void restore(const State& state, double position) {
        require_state(state);
        check::finite("restore.position", position, "m or rad");
        AxisJointOwner<Joint>::axis_joint.restore(state);
        this->restored(position);
    }

  protected:
    /// `more`: what the constraint takes after its joint.
    template <class... More>
    explicit AxisConstraint(Joint joint, More&&... more)
        : AxisJointOwner<Joint>(std::move(joint)),
          Constraint(AxisJointOwner<Joint>::axis_joint, std::forward<More>(more)...) {}
};

} // namespace ductile
