// SPDX-License-Identifier: MIT
//
// Rectangle with a notch cut across its width from one side: the section of a Charpy specimen. Only
// the ligament h - d behind the notch carries anything, so every property is that of the rectangle
// b × (h - d), about the ligament's own centroid. The notch's stress concentration is not part of a
// fully plastic section.
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
    S width = std::numeric_limits<S>::quiet_NaN();  ///< b, along x [m], > 0
    S height = std::numeric_limits<S>::quiet_NaN(); ///< h, along y, before the notch was cut [m], > 0
    S notch = std::numeric_limits<S>::quiet_NaN();  ///< depth d of the notch [m], in [0, height)
};

/// Immutable value; all members are noexcept after construction: of the ligament but for height().
template <std::floating_point S>
class NotchedRectangle : public Rectangle<S> {
  public:
    /// @throws std::invalid_argument where a length is missing (NaN) or out of range, as where the
    /// notch is as deep as the section.
    explicit NotchedRectangle(const NotchedRectangleParameters<S>& parameters)
        : Rectangle<S>({.width = check::positive("NotchedRectangle.width", parameters.width, "m"),
                        .height = ligament_height(parameters)}),
          height_(parameters.height) {}

    [[nodiscard]] S height() const noexcept { return height_; }                       ///< h [m]
    [[nodiscard]] S notch() const noexcept { return height_ - ligament().height(); }  ///< d [m]
    [[nodiscard]] const Rectangle<S>& ligament() const noexcept { return *this; } ///< b × (h - d)

  private:
    static S ligament_height(const NotchedRectangleParameters<S>& parameters) {
        constexpr auto field = "NotchedRectangle.notch";
        const S height = check::positive("NotchedRectangle.height", parameters.height, "m");
        check::non_negative(field, parameters.notch, "m");
        if (!(parameters.notch < height)) {
            check::between(field, parameters.notch, S(0), height, "m");
        }
        return height - parameters.notch;
    }

    S height_;
};

template <std::floating_point S>
NotchedRectangle(const NotchedRectangleParameters<S>&) -> NotchedRectangle<S>;

static_assert(FullSection<NotchedRectangle<double>> && FullSection<NotchedRectangle<float>>);

} // namespace ductile
