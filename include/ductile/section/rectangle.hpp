// SPDX-License-Identifier: MIT
//
// Solid rectangle: b along x, h along y.
//
//   A = b h,  I_x = b h³/12,  W_el = b h²/6,  W_pl = b h²/4
//   W_T = s² (3 l - s)/6 for sides s <= l   (sand heap: a hip roof of slope 1)
//   J   = l s³/3 [1 - 192/π⁵ s/l Σ tanh(n π l/(2 s))/n⁵],  n = 1, 3, 5 ...
//
// Source: Timoshenko and Goodier (1970), Theory of Elasticity, section 109 (J); Nadai (1950), Theory
// of Flow and Fracture of Solids, ch. 35 (sand heap). Shape factor W_pl/W_el = 3/2.
// Limit cases: s = l: W_T = s³/3, J = 0.140577 s⁴; s/l → 0: W_T → l s²/2, J → l s³/3.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <limits>
#include <numbers>

#include "ductile/section/point.hpp"
#include "ductile/section/section.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile {

template <std::floating_point S>
struct RectangleParameters {
    S width = std::numeric_limits<S>::quiet_NaN();  ///< b, along x [m], > 0
    S height = std::numeric_limits<S>::quiet_NaN(); ///< h, along y [m], > 0
};

/// Immutable value; all members are noexcept after construction.
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
    [[nodiscard]] S second_moment(SectionAxis axis = SectionAxis::x) const noexcept {
        const S depth = this->depth(axis);
        return area() * depth * depth / 12;
    }
    [[nodiscard]] S product_of_inertia() const noexcept { return 0; }
    [[nodiscard]] S elastic_modulus(SectionAxis axis = SectionAxis::x) const noexcept {
        return area() * depth(axis) / 6;
    }
    [[nodiscard]] S plastic_modulus(SectionAxis axis = SectionAxis::x) const noexcept {
        return area() * depth(axis) / 4;
    }

    [[nodiscard]] S shear_area(SectionAxis) const noexcept { return area(); }
    [[nodiscard]] S elastic_shear_area(SectionAxis) const noexcept { return 5 * area() / 6; }

    /// J [m⁴], to round-off: the series is summed as Σ 1/n⁵ = 31/32 ζ(5) less terms that fall as e^-πn.
    [[nodiscard]] S torsion_constant() const noexcept {
        constexpr S sum_of_fifth_powers = S(1.0045237627951383);
        constexpr S pi = std::numbers::pi_v<S>;
        const S s = std::min(width_, height_);
        const S l = std::max(width_, height_);
        S sum = sum_of_fifth_powers;
        for (int n = 1; n <= 11; n += 2) {
            const S order = static_cast<S>(n);
            sum -= 2 / ((std::exp(order * pi * l / s) + 1) * order * order * order * order * order);
        }
        const S correction = 192 / (pi * pi * pi * pi * pi) * (s / l) * sum;
        return l * s * s * s / 3 * (1 - correction);
    }
    [[nodiscard]] S plastic_torsion_modulus() const noexcept {
        const S s = std::min(width_, height_);
        const S l = std::max(width_, height_);
        return s * s * (3 * l - s) / 6;
    }

    [[nodiscard]] S width_at(S height, SectionAxis axis = SectionAxis::x) const noexcept {
        if (!(height >= lowest(axis) && height <= highest(axis))) return 0;
        return axis == SectionAxis::x ? width_ : height_;
    }
    [[nodiscard]] S lowest(SectionAxis axis = SectionAxis::x) const noexcept { return -depth(axis) / 2; }
    [[nodiscard]] S highest(SectionAxis axis = SectionAxis::x) const noexcept { return depth(axis) / 2; }

    /// Corners, counterclockwise, the centroid at the origin [m].
    [[nodiscard]] std::array<Point<S>, 4> outline() const noexcept {
        const S x = width_ / 2;
        const S y = height_ / 2;
        return {{{-x, -y}, {x, -y}, {x, y}, {-x, y}}};
    }

  private:
    /// Extent across the axis bent about.
    [[nodiscard]] S depth(SectionAxis axis) const noexcept {
        return axis == SectionAxis::x ? height_ : width_;
    }

    S width_;
    S height_;
};

template <std::floating_point S>
Rectangle(const RectangleParameters<S>&) -> Rectangle<S>;

static_assert(FullSection<Rectangle<double>> && FullSection<Rectangle<float>>);

} // namespace ductile
