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

} // namespace ductile
