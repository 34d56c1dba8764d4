// SPDX-License-Identifier: MIT
//
// A joint of a given type in an engine's constraint of six rows: the little that depends on the
// type.
#pragma once

#include <utility>

#include "ductile/joint/link.hpp"
#include "ductile/joint/usual_joints.hpp"
#include "ductile/world/joint_checks.hpp"

namespace ductile {

/// The link before the constraint that refers to it.
template <class Joint>
struct LinkOwner {
    Link<Joint> link;
};

/// `Constraint`: an engine's, made of an AnyLink and more; derives from LinkQueries and has
/// `restored(was_broken)`.
template <class Joint, class Constraint>
class LinkJoint : private LinkOwner<Joint>, public Constraint {
  public:
    using Axes = typename Link<Joint>::Axes;
    /// All that the joint remembers; a plain value, which state_bytes.hpp turns into bytes.
    using State = typename Link<Joint>::State;

    [[nodiscard]] const Joint& joint() const {
        this->settle();
        return LinkOwner<Joint>::link.joint();
    }
    [[nodiscard]] const Link<Joint>& link() const {
        this->settle();
        return LinkOwner<Joint>::link;
    }
    /// With the bodies' places and velocities a run goes on from it bit for bit.
    [[nodiscard]] State state() const { return link().state(); }
    /// To be called when the bodies are back where they were. Also mends a broken joint where
    /// `state` is from before the break, and breaks it where it is from after. Forces, outcome and
    /// residuals of the last step are not restored.
    /// @throws std::invalid_argument where it is none that a joint can come to.
    void restore(const State& state) {
        require_state(state.joint);
        const bool was_broken = LinkOwner<Joint>::link.broken();
        LinkOwner<Joint>::link.restore(state);
        this->restored(was_broken);
    }

  protected:
    /// `more`: what the constraint takes after its link.
    template <class... More>
    explicit LinkJoint(Link<Joint> link, More&&... more)
        : LinkOwner<Joint>{std::move(link)},
          Constraint(LinkOwner<Joint>::link, std::forward<More>(more)...) {}
};

/// One that turns about z of its frames, as `Base` with one plastic axis.
template <class Base>
class HingeJoint : public Base {
  public:
    static constexpr JointAxis axis = JointAxis::torsion; ///< z of the frames

    /// Angle of A relative to B about the axis, not wrapped [rad].
    [[nodiscard]] double rotation() const { return Base::position(axis); }
    /// Velocity of that after the last step's solve [rad/s].
    [[nodiscard]] double velocity() const { return Base::joint().state().velocity; }
    /// Geometric rest angle q_p [rad].
    [[nodiscard]] double plastic_offset() const { return Base::joint().state().plastic_offset; }
    /// Accumulated plastic rotation p, work-conjugate [rad].
    [[nodiscard]] double plastic_rotation() const { return Base::plastic_travel(); }
    /// Moment about the axis in the last step, positive where it turns A about +axis [N m].
    [[nodiscard]] double moment() const { return Base::force(axis); }

  protected:
    using Base::Base;
};

/// One that slides along z of its frames.
template <class Base>
class SliderJoint : public Base {
  public:
    static constexpr JointAxis axis = JointAxis::axial; ///< z of the frames

    /// Change of length: A's displacement along the axis relative to B [m].
    [[nodiscard]] double elongation() const { return Base::position(axis); }
    /// Velocity of that after the last step's solve [m/s].
    [[nodiscard]] double velocity() const { return Base::joint().state().velocity; }
    /// Geometric rest elongation q_p [m].
    [[nodiscard]] double plastic_offset() const { return Base::joint().state().plastic_offset; }
    /// Accumulated plastic elongation p, work-conjugate [m].
    [[nodiscard]] double plastic_elongation() const { return Base::plastic_travel(); }
    /// Force along the axis in the last step, positive where it pushes A along +axis [N].
    [[nodiscard]] double force() const { return Base::force(axis); }

  protected:
    using Base::Base;
};

} // namespace ductile
