// SPDX-License-Identifier: MIT
//
// Rectangle with a notch cut across its width from one side: the section of a Charpy specimen. Only
// the ligament h - d behind the notch carries moment, so every property is that of the rectangle
// b × (h - d). The notch's stress concentration is not part of a fully plastic section.
//
// Source: Nikula (2017), Handling of plasticity in physics engine, sections 2.2.3 and 2.5.
#pragma once

#include <concepts>
#include <limits>

#include "ductile/section/rectangle.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile {

template <std::floating_point S>
struct NotchedRectangleParameters {
    S width = std::numeric_limits<S>::quiet_NaN();  ///< b, along the bending axis [m], > 0
    S height = std::numeric_limits<S>::quiet_NaN(); ///< h, before the notch was cut [m], > 0
    S notch = std::numeric_limits<S>::quiet_NaN();  ///< depth d of the notch [m], in [0, height)
};

template <std::floating_point S>
class NotchedRectangle {
  public:
    using Scalar = S;

    /// @throws std::invalid_argument where a length is missing (NaN) or out of range, as where the
    /// notch is as deep as the section.
    explicit NotchedRectangle(const NotchedRectangleParameters<S>& parameters)
        : height_(check::positive("NotchedRectangle.height", parameters.height, "m")),
          ligament_({.width = check::positive("NotchedRectangle.width", parameters.width, "m"),
                     .height = height_ - checked_notch(parameters)}) {}

    [[nodiscard]] S width() const noexcept { return ligament_.width(); }                ///< b [m]
    [[nodiscard]] S height() const noexcept { return height_; }                         ///< h [m]
    [[nodiscard]] S notch() const noexcept { return height_ - ligament_.height(); }     ///< d [m]
    [[nodiscard]] const Rectangle<S>& ligament() const noexcept { return ligament_; }   ///< b × (h - d)

    [[nodiscard]] S area() const noexcept { return ligament_.area(); }
    [[nodiscard]] S second_moment() const noexcept { return ligament_.second_moment(); }
    [[nodiscard]] S elastic_modulus() const noexcept { return ligament_.elastic_modulus(); }
    [[nodiscard]] S plastic_modulus() const noexcept { return ligament_.plastic_modulus(); }

  private:
    static S checked_notch(const NotchedRectangleParameters<S>& parameters) {
        constexpr auto field = "NotchedRectangle.notch";
        check::non_negative(field, parameters.notch, "m");
        if (!(parameters.notch < parameters.height)) {
            check::between(field, parameters.notch, S(0), parameters.height, "m");
        }
        return parameters.notch;
    }

    S height_;
    Rectangle<S> ligament_;
};

template <std::floating_point S>
NotchedRectangle(const NotchedRectangleParameters<S>&) -> NotchedRectangle<S>;

static_assert(Section<NotchedRectangle<double>> && Section<NotchedRectangle<float>>);

} // namespace ductile
