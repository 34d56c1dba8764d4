// SPDX-License-Identifier: MIT
//
// Solid rectangle, bent about the axis parallel to its width.
//
//   A = b h,  I = b h³/12,  W_el = b h²/6,  W_pl = b h²/4
//
// Source: any text on strength of materials, e.g. Timoshenko (1940). Shape factor W_pl/W_el = 3/2.
#pragma once

#include <concepts>
#include <limits>

#include "ductile/section/section.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile {

template <std::floating_point S>
struct RectangleParameters {
    S width = std::numeric_limits<S>::quiet_NaN();  ///< b, along the bending axis [m], > 0
    S height = std::numeric_limits<S>::quiet_NaN(); ///< h, across the bending axis [m], > 0
};

template <std::floating_point S>
class Rectangle {
  public:
    using Scalar = S;

    /// @throws std::invalid_argument where a side is missing (NaN), infinite or not positive.
    explicit Rectangle(const RectangleParameters<S>& parameters)
        : width_(check::positive("Rectangle.width", parameters.width, "m")),
          height_(check::positive("Rectangle.height", parameters.height, "m")) {}

    [[nodiscard]] S width() const noexcept { return width_; }   ///< b [m]
    [[nodiscard]] S height() const noexcept { return height_; } ///< h [m]

    [[nodiscard]] S area() const noexcept { return width_ * height_; }
    [[nodiscard]] S second_moment() const noexcept { return width_ * height_ * height_ * height_ / 12; }
    [[nodiscard]] S elastic_modulus() const noexcept { return width_ * height_ * height_ / 6; }
    [[nodiscard]] S plastic_modulus() const noexcept { return width_ * height_ * height_ / 4; }

  private:
    S width_;
    S height_;
};

template <std::floating_point S>
Rectangle(const RectangleParameters<S>&) -> Rectangle<S>;

static_assert(Section<Rectangle<double>> && Section<Rectangle<float>>);

} // namespace ductile
