// SPDX-License-Identifier: MIT
//
// A plastic joint of six axes between two bodies of an ODE world: any mix of rigid, plastic and
// elastic-plastic axes, also with a shared yield surface.
//
//   ductile::ode::PlasticJoint root(world_id, beam, nullptr, {.origin = {0, 0, 0}, .axes = axes},
//                                   joint);
//   root.add_to(stepper);
//
// See joint_constraint.hpp for who solves, life in a world and ODE's traps.
#pragma once

#include <ode/ode.h>

#include <array>
#include <utility>

#include "ductile/joint/joint_axis.hpp"
#include "ductile/ode/joint_constraint.hpp"

namespace ductile::ode {

/// Joint: OneAxisJoint, or CoupledJoint of up to six axes.
template <class Joint>
class PlasticJoint final : public LinkJoint<Joint, JointConstraint> {
    using Base = LinkJoint<Joint, JointConstraint>;

  public:
    using Axes = typename Base::Axes;
    using Frame = JointFrame<double>;

    /// The axes of a joint that rules them all.
    [[nodiscard]] static constexpr Axes every_axis() {
        static_assert(ruled_axes<Joint> == 6,
                      "PlasticJoint: say which axes are plastic; the others are rigid");
        return all_joint_axes;
    }

    /// The plastic axes start unstrained where the bodies are now. `in_a`, `in_b`: the joint's
    /// frame in body A and in body B (null: the static world), z along the member; `axes`: which
    /// axis each row of `joint` is.
    /// @throws std::invalid_argument where A is null, both bodies are one or not of this world, a
    /// frame is not finite or not orthonormal and right-handed, rigid axes of the two bodies are
    /// apart (joint_checks.hpp), or an axis is given twice.
    PlasticJoint(dWorldID world, dBodyID a, dBodyID b, const Frame& in_a, const Frame& in_b,
                 Joint joint, const std::array<JointAxis, ruled_axes<Joint>>& axes = every_axis())
        : Base(Link<Joint>(std::move(joint), axes, Base::require_frame("in_a", in_a),
                           Base::require_frame("in_b", in_b)),
               world, Base::require_bodies("PlasticJoint", world, a, b), b) {}

    /// As above with one frame, in the world, where the bodies are now.
    PlasticJoint(dWorldID world, dBodyID a, dBodyID b, const Frame& in_world, Joint joint,
                 const std::array<JointAxis, ruled_axes<Joint>>& axes = every_axis())
        : PlasticJoint(world, Base::require_bodies("PlasticJoint", world, a, b), b,
                       Base::frame_in(a, Base::require_frame("in_world", in_world)),
                       Base::frame_in(b, in_world), std::move(joint), axes) {}
};

#ifdef DUCTILE_COMPILED
extern template class PlasticJoint<UsualSixAxisJoint>;
#endif

} // namespace ductile::ode
