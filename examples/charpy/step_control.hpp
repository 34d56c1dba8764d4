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
// For the engines' own joints; a World with a tolerance needs none of this.
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
    [[nodiscard]] double next(const BlowMotion& motion) noexcept {
        constexpr double rotation = 0.005, closing = 0.005, gap = 0.5, growth = 1.5;
        const double way = std::max(closing * motion.height, gap * motion.gap);
        const double wish = std::min({limit(rotation, motion.rotation_rate),
                                      limit(way, motion.closing_speed), growth * step_});
        return step_ = std::clamp(wish, shortest, longest);
    }

  private:
    [[nodiscard]] static double limit(double amount, double rate) noexcept {
        return rate > 0 ? amount / rate : std::numeric_limits<double>::infinity();
    }

    static constexpr double shortest = 1e-6, longest = 1e-3; ///< [s]
    double step_ = longest;                                  ///< [s]
};

} // namespace charpy
