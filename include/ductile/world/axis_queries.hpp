// SPDX-License-Identifier: MIT
//
// The queries of a joint that rules one row of an engine's own joint, in any engine.
#pragma once

#include <cmath>
#include <optional>

#include "ductile/joint/axis_joint.hpp"
#include "ductile/vocabulary/angle.hpp"
#include "ductile/world/joint_queries.hpp"

namespace ductile {

class AxisQueries : public PairQueries {
  public:
    /// Geometric rest position q_p [m | rad].
    [[nodiscard]] double plastic_offset() const {
        (void)totals();
        return joint_.plastic_offset();
    }
    /// Position of A relative to B, not wrapped [m | rad].
    [[nodiscard]] double position() const {
        (void)totals();
        return position_;
    }
    /// Velocity of that after the last step's solve [m/s | rad/s].
    [[nodiscard]] double velocity() const {
        (void)totals();
        return joint_.velocity();
    }
    /// Force of the row in the last step, positive where it pushes A along +axis, or turns it about
    /// it; zero while the joint does not act, and once it is broken [N | N m].
    [[nodiscard]] double reaction() const { return totals().broken ? 0 : force_; }

  protected:
    /// `joint` must outlive this.
    explicit AxisQueries(AxisJoint& joint) : joint_(joint) {}
    ~AxisQueries() = default;

    /// What the engine showed of the step [m | rad, N | N m]; what is not finite is not kept.
    void keep(double position, double force) {
        if (std::isfinite(position)) position_ = position;
        if (std::isfinite(force)) force_ = force;
    }

    AxisJoint& joint_;
    double position_ = 0; ///< q
    double force_ = 0;
    double unseen_turn_ = 0;     ///< of the last step, where the position does not tell it [rad]
    double island_unsolved_ = 0; ///< of it, as JointReport's

    /// Of a turning row whose step ended at `velocity` and moved it to `position` [rad/s, rad].
    void see_turn(double velocity, double time, double position) noexcept {
        const double due = velocity * time;
        unseen_turn_ = turned_otherwise(due, position - position_) ? std::abs(due) : 0;
    }

    [[nodiscard]] Outcome last_outcome() const override {
        const Outcome outcome = joint_.last().outcome;
        const bool believed = !(unseen_turn_ > 0) && !(island_unsolved_ > 0);
        return believed || outcome == Outcome::broken ? outcome : Outcome::unreliable;
    }

  private:
    [[nodiscard]] double last_unseen_turn() const final { return unseen_turn_; }
    [[nodiscard]] double last_island_unsolved() const final { return island_unsolved_; }
    [[nodiscard]] const JointTotals<double>& state_totals() const final { return joint_.totals(); }
    [[nodiscard]] const Step<double>& last_step() const final { return joint_.last(); }
    [[nodiscard]] std::optional<FractureEvent<double>> fracture() const final {
        return joint_.fracture();
    }
    [[nodiscard]] double last_utilisation() const final { return joint_.utilisation(force_); }
};

} // namespace ductile
