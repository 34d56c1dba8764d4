// SPDX-License-Identifier: MIT
//
// The account of rows that were solved together. Work of a row is impulse × mean velocity, and the
// sum over all rows is exactly what the bodies lost. A single row may give: where many stop within
// one step, each has the impulse that all of them need, and some of them it drives. What such rows
// gave the others took a second time, and flow that is booked row by row is more than was lost. Of
// it
//
//   s = 1 + unclaimed/claimed,   0 <= s <= 1
//
// is booked: plastic work, travel and life. The rest is other_work, and nothing is added or
// missing.
//
//   claimed    work of flow, in rows that were solved for, >= 0              [J]
//   unclaimed  work of such rows that did not flow, either sign              [J]
//
// Limit case: a joint of one axis alone has s = 1.
#pragma once

#include <algorithm>
#include <concepts>
#include <utility>

#include "ductile/joint/joint_totals.hpp"

namespace ductile {

/// Of the joints of an island in one step, each as it was booked first. Plain value.
template <std::floating_point S>
struct WorkShare {
    S claimed = 0;
    S unclaimed = 0;

    void add(const Step<S>& step) noexcept {
        claimed += step.claimed;
        unclaimed += step.unclaimed;
    }
    /// s; 1 where nothing but round-off was given.
    [[nodiscard]] S value() const noexcept {
        constexpr S round_off = S(1e-9);
        return unclaimed < -round_off * claimed && claimed > 0
                   ? std::max(1 + unclaimed / claimed, S(0))
                   : S(1);
    }
};

/// The step that a joint booked last, which can be booked again. Copyable.
template <class Joint>
class BookedStep {
  public:
    using S = typename Joint::Scalar;
    using JointStep = decltype(std::declval<Joint&>().commit({}, S(0)));

    [[nodiscard]] const JointStep& step() const noexcept { return step_; }
    void clear() noexcept { step_ = {}; }
    void leave_unbooked() noexcept { step_ = unbooked_step<JointStep>(); }

    /// Commits the step that the joint has open; its rows may have given to each other.
    const JointStep& commit(Joint& joint, const typename Joint::Reaction& reaction, S dt) noexcept {
        before_ = joint.state();
        reaction_ = reaction;
        dt_ = dt;
        step_ = joint.commit(reaction_, dt);
        WorkShare<S> alone;
        alone.add(step_);
        if (alone.value() < 1) grant(joint, alone.value());
        return step_;
    }
    /// Commits it again, for the share `granted` of its flow.
    void grant(Joint& joint, S granted) noexcept {
        const auto velocity = joint.state().velocity;
        joint.restore(before_);
        step_ = joint.commit(reaction_, dt_, granted);
        joint.carry(velocity);
    }

  private:
    typename Joint::State before_{};
    typename Joint::Reaction reaction_{};
    JointStep step_{};
    S dt_ = 0;
};

} // namespace ductile
