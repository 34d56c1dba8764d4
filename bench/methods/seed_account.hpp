// SPDX-License-Identifier: MIT
//
// The account of Nikula (2017) over an engine's motor: every change of position is plastic, work is
// strength × |change|, and the joint breaks at the end of the step in which the sum passes its
// limit.
#pragma once

#include <cmath>

#include "scenes/scene.hpp"

namespace bench {

class SeedAccount {
  public:
    explicit SeedAccount(const JointSpec& joint) : strength_(joint.strength), limit_(joint.limit) {}

    /// Books a step that ended at position q.
    void book(double q) {
        if (broken()) return;
        travel_ += std::abs(q - last_);
        last_ = q;
    }
    [[nodiscard]] double absorbed() const { return strength_ * travel_; }
    [[nodiscard]] bool broken() const { return travel_ > limit_; }

  private:
    double strength_, limit_;
    double last_ = 0;
    double travel_ = 0;
};

} // namespace bench
