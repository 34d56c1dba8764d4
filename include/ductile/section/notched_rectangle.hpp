// SPDX-License-Identifier: MIT
//
// Rectangle with a notch cut across its width from one side: the section of a Charpy specimen. Only
// the ligament h - d behind the notch carries anything, so every property is that of the rectangle
// b × (h - d), about the ligament's own centroid. The notch's stress concentration is not part of a
// fully plastic section.
//
// Source: Nikula (2017), Handling of plasticity in physics engine, sections 2.2.3 and 2.5.
#pragma once

#include <array>
#include <concepts>
#include <limits>

#include "ductile/section/rectangle.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile {

template <std::floating_point S>
struct NotchedRectangleParameters {
    S width = std::numeric_limits<S>::quiet_NaN();  ///< b, along x [m], > 0
    S height = std::numeric_limits<S>::quiet_NaN(); ///< h, along y, before the notch was cut [m], > 0
    S notch = std::numeric_limits<S>::quiet_NaN();  ///< depth d of the notch [m], in [0, height)
};

/// Immutable value; all members are noexcept after construction.
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

    [[nodiscard]] S width() const noexcept { return ligament_.width(); }              ///< b [m]
    [[nodiscard]] S height() const noexcept { return height_; }                       ///< h [m]
    [[nodiscard]] S notch() const noexcept { return height_ - ligament_.height(); }   ///< d [m]
    [[nodiscard]] const Rectangle<S>& ligament() const noexcept { return ligament_; } ///< b × (h - d)

    [[nodiscard]] S area() const noexcept { return ligament_.area(); }
    [[nodiscard]] S second_moment(SectionAxis axis = SectionAxis::x) const noexcept {
        return ligament_.second_moment(axis);
    }
    [[nodiscard]] S product_of_inertia() const noexcept { return 0; }
    [[nodiscard]] S elastic_modulus(SectionAxis axis = SectionAxis::x) const noexcept {
        return ligament_.elastic_modulus(axis);
    }
    [[nodiscard]] S plastic_modulus(SectionAxis axis = SectionAxis::x) const noexcept {
        return ligament_.plastic_modulus(axis);
    }
    [[nodiscard]] S shear_area(SectionAxis axis) const noexcept { return ligament_.shear_area(axis); }
    [[nodiscard]] S elastic_shear_area(SectionAxis axis) const noexcept {
        return ligament_.elastic_shear_area(axis);
    }
    [[nodiscard]] S torsion_constant() const noexcept { return ligament_.torsion_constant(); }
    [[nodiscard]] S plastic_torsion_modulus() const noexcept {
        return ligament_.plastic_torsion_modulus();
    }
    [[nodiscard]] S width_at(S height, SectionAxis axis = SectionAxis::x) const noexcept {
        return ligament_.width_at(height, axis);
    }
    [[nodiscard]] S lowest(SectionAxis axis = SectionAxis::x) const noexcept {
        return ligament_.lowest(axis);
    }
    [[nodiscard]] S highest(SectionAxis axis = SectionAxis::x) const noexcept {
        return ligament_.highest(axis);
    }
    /// Corners of the ligament, counterclockwise, its centroid at the origin [m].
    [[nodiscard]] std::array<Point<S>, 4> outline() const noexcept { return ligament_.outline(); }

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

static_assert(FullSection<NotchedRectangle<double>> && FullSection<NotchedRectangle<float>>);

} // namespace ductile
