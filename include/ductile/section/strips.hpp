// SPDX-License-Identifier: MIT
//
// Sections made of rectangles, I, T, L, channel and box: seen along either axis they are a few strips
// of constant width on top of each other, and all of bending follows from the strips in closed form.
//
//   A = Σ b h,  I = Σ (b h³/12 + b h c²),  W_pl = Σ ∫ b |y - y_p| dy
//
// Symbols
//   b, h  width and height of a strip                         [m]
//   c     height of its middle, from the centroid             [m]
//   y_p   height that halves the area, from the centroid      [m]
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <initializer_list>
#include <span>
#include <string>

#include "ductile/section/point.hpp"
#include "ductile/section/sand_heap.hpp"
#include "ductile/section/section.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile {

/// A strip across the bending axis.
template <std::floating_point S>
struct Strip {
    S width = 0;  ///< b, along the axis [m], > 0
    S height = 0; ///< h, across the axis [m], > 0
};

/// At most three strips, from the lowest up. The caller answers for positive sizes.
template <std::floating_point S>
class Strips {
  public:
    Strips(std::initializer_list<Strip<S>> strips) noexcept {
        S total = 0;
        S moment = 0;
        for (const Strip<S>& strip : strips) {
            width_[count_] = strip.width;
            edge_[count_ + 1] = edge_[count_] + strip.height;
            ++count_;
            total += strip.width * strip.height;
            moment += strip.width * strip.height * (edge_[count_] - strip.height / 2);
        }
        area_ = total;
        from_base_ = moment / total;
        for (std::size_t i = 0; i <= count_; ++i) edge_[i] -= from_base_;
    }

    [[nodiscard]] S area() const noexcept { return area_; }
    [[nodiscard]] S lowest() const noexcept { return edge_[0]; }
    [[nodiscard]] S highest() const noexcept { return edge_[count_]; }
    [[nodiscard]] S centroid() const noexcept { return from_base_; } ///< above the lowest fibre [m]

    [[nodiscard]] S second_moment() const noexcept {
        S sum = 0;
        for (std::size_t i = 0; i < count_; ++i) {
            const S height = edge_[i + 1] - edge_[i];
            const S middle = (edge_[i + 1] + edge_[i]) / 2;
            sum += width_[i] * height * (height * height / 12 + middle * middle);
        }
        return sum;
    }

    [[nodiscard]] S elastic_modulus() const noexcept {
        return second_moment() / std::max(-lowest(), highest());
    }

    /// y_p [m].
    [[nodiscard]] S equal_area_height() const noexcept {
        S missing = area_ / 2;
        for (std::size_t i = 0; i < count_; ++i) {
            const S area = width_[i] * (edge_[i + 1] - edge_[i]);
            if (area >= missing) return edge_[i] + missing / width_[i];
            missing -= area;
        }
        return highest(); // only by round-off
    }

    [[nodiscard]] S plastic_modulus() const noexcept {
        const S axis = equal_area_height();
        S sum = 0;
        for (std::size_t i = 0; i < count_; ++i) {
            const S below = edge_[i] - axis;
            const S above = edge_[i + 1] - axis;
            sum += width_[i] * (above * std::abs(above) - below * std::abs(below)) / 2;
        }
        return sum;
    }

    [[nodiscard]] S width_at(S height) const noexcept {
        if (!(height >= lowest() && height <= highest())) return 0;
        std::size_t i = 0;
        while (i + 1 < count_ && height >= edge_[i + 1]) ++i;
        return width_[i];
    }

  private:
    std::size_t count_ = 0;
    std::array<S, 3> width_{};
    std::array<S, 4> edge_{};
    S area_ = 0;
    S from_base_ = 0;
};

/// What bending does not tell; see section.hpp for the symbols.
template <std::floating_point S>
struct StripConstants {
    S product_of_inertia = 0;
    S shear_area_x = 0;
    S shear_area_y = 0;
    S elastic_shear_area_x = 0;
    S elastic_shear_area_y = 0;
    S torsion_constant = 0;
    S plastic_torsion_modulus = 0;
};

/// What all sections made of rectangles have. Immutable value; all members are noexcept.
template <std::floating_point S>
class StripSection {
  public:
    using Scalar = S;

    [[nodiscard]] S area() const noexcept { return about_x_.area(); }
    [[nodiscard]] S second_moment(SectionAxis axis = SectionAxis::x) const noexcept {
        return about(axis).second_moment();
    }
    [[nodiscard]] S product_of_inertia() const noexcept { return constants_.product_of_inertia; }
    [[nodiscard]] S elastic_modulus(SectionAxis axis = SectionAxis::x) const noexcept {
        return about(axis).elastic_modulus();
    }
    [[nodiscard]] S plastic_modulus(SectionAxis axis = SectionAxis::x) const noexcept {
        return about(axis).plastic_modulus();
    }
    /// Height of the plastic neutral axis parallel to `axis` from the centroid [m].
    [[nodiscard]] S equal_area_height(SectionAxis axis = SectionAxis::x) const noexcept {
        return about(axis).equal_area_height();
    }
    [[nodiscard]] S shear_area(SectionAxis axis) const noexcept {
        return axis == SectionAxis::x ? constants_.shear_area_x : constants_.shear_area_y;
    }
    [[nodiscard]] S elastic_shear_area(SectionAxis axis) const noexcept {
        return axis == SectionAxis::x ? constants_.elastic_shear_area_x
                                      : constants_.elastic_shear_area_y;
    }
    [[nodiscard]] S torsion_constant() const noexcept { return constants_.torsion_constant; }
    [[nodiscard]] S plastic_torsion_modulus() const noexcept {
        return constants_.plastic_torsion_modulus;
    }
    [[nodiscard]] S width_at(S height, SectionAxis axis = SectionAxis::x) const noexcept {
        return about(axis).width_at(height);
    }
    [[nodiscard]] S lowest(SectionAxis axis = SectionAxis::x) const noexcept {
        return about(axis).lowest();
    }
    [[nodiscard]] S highest(SectionAxis axis = SectionAxis::x) const noexcept {
        return about(axis).highest();
    }

  protected:
    StripSection(const Strips<S>& about_x, const Strips<S>& about_y,
                 const StripConstants<S>& constants) noexcept
        : about_x_(about_x), about_y_(about_y), constants_(constants) {}
    StripSection(const StripSection&) = default;
    StripSection& operator=(const StripSection&) = default;
    ~StripSection() = default;

  private:
    [[nodiscard]] const Strips<S>& about(SectionAxis axis) const noexcept {
        return axis == SectionAxis::x ? about_x_ : about_y_;
    }

    Strips<S> about_x_;
    Strips<S> about_y_;
    StripConstants<S> constants_;
};

/// Throws of the lengths that most of them have: the walls must be thinner than `web`, `flange`.
template <class Parameters, std::floating_point S>
void check_walls(const std::string& kind, const Parameters& p, S web, S flange) {
    check::positive(kind + ".width", p.width, "m");
    check::positive(kind + ".height", p.height, "m");
    check::between(kind + ".web_thickness", p.web_thickness, S(0), web, "m");
    check::between(kind + ".flange_thickness", p.flange_thickness, S(0), flange, "m");
}

/// A section by its shape, which says of its `Parameters` what is wrong with them (`require`), what
/// the strips about x and y are and the constants; where it has `corners`, counterclockwise from the
/// lower left corner of the bounding box, W_T follows from these.
template <class Shape>
class ShapedSection : public StripSection<typename Shape::Scalar> {
    using S = typename Shape::Scalar;

  public:
    using Parameters = typename Shape::Parameters;

    /// @throws std::invalid_argument where a length is missing (NaN) or out of range.
    explicit ShapedSection(const Parameters& parameters)
        : ShapedSection((Shape::require(parameters), parameters), Checked{}) {}

    [[nodiscard]] const Parameters& parameters() const noexcept { return parameters_; }

    /// Corners, counterclockwise, the centroid at the origin [m].
    [[nodiscard]] auto outline() const noexcept requires
        requires(const Parameters& p) { Shape::corners(p); } {
        auto corners = Shape::corners(parameters_);
        for (Point<S>& corner : corners) {
            corner = corner + Point<S>{this->lowest(SectionAxis::y), this->lowest(SectionAxis::x)};
        }
        return corners;
    }

  private:
    struct Checked {};
    ShapedSection(const Parameters& p, Checked) noexcept
        : StripSection<S>(Shape::about_x(p), Shape::about_y(p), constants(p)), parameters_(p) {}
    static StripConstants<S> constants(const Parameters& p) noexcept {
        StripConstants<S> result = Shape::constants(p);
        if constexpr (requires { Shape::corners(p); }) {
            const auto corners = Shape::corners(p);
            result.plastic_torsion_modulus =
                2 * sand_heap_volume(std::span<const Point<S>>(corners));
        }
        return result;
    }

    Parameters parameters_;
};

} // namespace ductile
