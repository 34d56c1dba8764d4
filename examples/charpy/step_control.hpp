// SPDX-License-Identifier: MIT
//
// Steps that follow the blow, for joints of any method alike: the seed's way (Nikula 2017, section
// 2.2.8) with the hammer's angle replaced by what moves. The next step is the longest that
//
//   turns no hinge by more than `rotation`
//   lets nose and bar close by no more than `closing` of the bar's height once they are near, and
//   by no more than `gap` of the way between them before
//   is no more than `growth` times the last one, and within [shortest, longest]
//
// A World with a tolerance needs none of this; the engines' own joints do.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace charpy {

/// What moves now; the defaults ask for nothing.
struct BlowMotion {
    double rotation_rate = 0; ///< fastest bend between two parts [rad/s]
    double closing_speed = 0; ///< of nose and bar, positive while they close [m/s]
    double gap = 0;           ///< between them, <= 0 where they touch [m]
    double height = std::numeric_limits<double>::infinity(); ///< of the bar, along the blow [m]
};

class StepControl {
  public:
    /// Starts from the longest step, > 0 [s].
    explicit StepControl(double longest)
        : shortest_(std::min(1e-6, longest)),
          longest_(longest),
          step_(longest) {}

    [[nodiscard]] double next(const BlowMotion& motion) noexcept {
        constexpr double rotation = 0.005, closing = 0.005, gap = 0.5, growth = 1.5;
        const double way = std::max(closing * motion.height, gap * motion.gap);
        const double wish = std::min({limit(rotation, motion.rotation_rate),
                                      limit(way, motion.closing_speed), growth * step_});
        return step_ = std::clamp(wish, shortest_, longest_);
    }

  private:
    [[nodiscard]] static double limit(double amount, double rate) noexcept {
        return rate > 0 ? amount / rate : std::numeric_limits<double>::infinity();
    }

    double shortest_, longest_, step_; ///< [s]
};

} // namespace charpy
