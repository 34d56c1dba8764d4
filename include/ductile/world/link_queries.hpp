// SPDX-License-Identifier: MIT
//
// The queries of a joint that is a link of six rows, in any engine.
#pragma once

#include <optional>
#include <span>

#include "ductile/joint/any_link.hpp"
#include "ductile/joint/joint_axis.hpp"
#include "ductile/world/joint_queries.hpp"

namespace ductile {

class LinkQueries : public PairQueries {
  public:
    /// The axes that have a strength, in the order of JointAxis; the others are rigid.
    [[nodiscard]] std::span<const JointAxis> plastic_axes() const { return link_.axes(); }
    /// Reaction on A along +axis of frame B in the last step, whether rigid or plastic; zero while
    /// the joint does not act, and once it is broken [N | N m].
    [[nodiscard]] double force(JointAxis axis) const {
        return totals().broken || is_silent() ? 0 : link_.force(axis);
    }
    /// Position of A in frame B; rotation angles go on over many turns; of a rigid axis what it is
    /// off by [m | rad].
    [[nodiscard]] double position(JointAxis axis) const {
        (void)totals();
        return link_.position(axis);
    }
    /// Geometric rest position q_p; zero for a rigid axis [m | rad].
    [[nodiscard]] double plastic_offset(JointAxis axis) const {
        (void)totals();
        return link_.plastic_offset(axis);
    }

  protected:
    /// `link` must outlive this.
    explicit LinkQueries(AnyLink<double>& link) : link_(link) {}
    ~LinkQueries() = default;

    AnyLink<double>& link_;

  private:
    /// True while there is no force, as the joint is left alone by its engine.
    [[nodiscard]] virtual bool is_silent() const { return false; }

    [[nodiscard]] const JointTotals<double>& state_totals() const final { return link_.totals(); }
    [[nodiscard]] const Step<double>& last_step() const final { return link_.last(); }
    [[nodiscard]] std::optional<FractureEvent<double>> fracture() const final {
        return link_.fracture();
    }
    [[nodiscard]] Outcome last_outcome() const final { return link_.outcome(); }
    [[nodiscard]] double last_rigid_residual() const final { return link_.rigid_residual(); }
    [[nodiscard]] double last_unseen_turn() const final { return link_.unseen_turn(); }
    [[nodiscard]] double last_island_unsolved() const final { return link_.island_unsolved(); }
    [[nodiscard]] double borne_blow() const final { return link_.borne_blow(); }
    [[nodiscard]] double borne_error() const final { return link_.borne_error(); }
    [[nodiscard]] double last_utilisation() const final {
        return is_silent() ? 0 : link_.utilisation();
    }
};

} // namespace ductile
