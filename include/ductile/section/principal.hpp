// SPDX-License-Identifier: MIT
//
// Principal axes of a section: those about which elastic bending does not bend it sideways.
//
//   I_u = I_x cos² θ + I_y sin² θ - 2 I_xy sin θ cos θ   about an axis at θ from x
//   tan 2θ = -2 I_xy/(I_x - I_y)
//
// Source: Mohr (1887); any text on strength of materials.
#pragma once

#include <cmath>
#include <concepts>

#include "ductile/section/section.hpp"

namespace ductile {

template <std::floating_point S>
struct PrincipalAxes {
    S major = 0; ///< largest second moment [m⁴]
    S minor = 0; ///< smallest second moment [m⁴]
    S angle = 0; ///< from x to the axis of `major`, counterclockwise [rad], in (-π/2, π/2]
};

/// Where all axes are alike the angle is 0.
template <BiaxialSection T>
[[nodiscard]] PrincipalAxes<typename T::Scalar> principal_axes(const T& section) noexcept {
    using S = typename T::Scalar;
    const S mean = (section.second_moment(SectionAxis::x) + section.second_moment(SectionAxis::y)) / 2;
    const S half = (section.second_moment(SectionAxis::x) - section.second_moment(SectionAxis::y)) / 2;
    const S product = section.product_of_inertia();
    const S radius = std::hypot(half, product);
    // 0 - product: where there is none the angle is 0 or π/2, not -π/2
    return {.major = mean + radius,
            .minor = mean - radius,
            .angle = std::atan2(0 - product, half) / 2};
}

} // namespace ductile
