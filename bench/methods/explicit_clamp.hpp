// SPDX-License-Identifier: MIT
//
// The explicit elastic-plastic spring that most tutorials teach, engine-free: a force from the last
// position, clamped at the strength; where it was clamped, the rest position moves along.
//
//   F = clamp(-k (q - q₀), ±R);   clamped:  q₀ += the part of q - q₀ beyond R/k
//
// The stiffness is the joint's own, or else, where the joint is rigid-plastic, the one that a
// careful user would take: stiff, with a margin to what the step carries (ω dt = 1/2 with both
// bodies free; the limit is 2, and coupling within a chain raises ω by at most 2).
#pragma once

#include <algorithm>
#include <cmath>

#include "scenes/scene.hpp"

namespace bench {

class ExplicitClamp {
  public:
    ExplicitClamp(const JointSpec& joint, double effective_mass)
        : joint_(joint), mass_(effective_mass) {}

    /// Force on body a along the axis at position q, for a step of dt [N m | N].
    double force(double q, double dt) {
        const double k = std::isfinite(joint_.stiffness) ? joint_.stiffness : mass_ / (4 * dt * dt);
        const double elastic = q - rest_;
        const double yield = joint_.strength / k;
        const double beyond = elastic - std::clamp(elastic, -yield, yield);
        rest_ += beyond;
        travel_ += std::abs(beyond);
        return broken() ? 0 : -k * (elastic - beyond);
    }
    [[nodiscard]] double absorbed() const {
        return joint_.strength * std::min(travel_, joint_.limit);
    }
    [[nodiscard]] bool broken() const { return travel_ > joint_.limit; }

  private:
    JointSpec joint_;
    double mass_;
    double rest_ = 0;   ///< q₀
    double travel_ = 0; ///< accumulated plastic travel
};

} // namespace bench
