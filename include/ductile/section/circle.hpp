// SPDX-License-Identifier: MIT
//
// Solid circle.
//
//   A = π r²,  I = π r⁴/4,  W_el = π r³/4,  W_pl = 4 r³/3,  J = π r⁴/2,  W_T = 2 π r³/3
//
// Source: any text on strength of materials, e.g. Timoshenko (1940). Shape factor 16/(3π); the sand
// heap is a cone of slope 1.
#pragma once

#include <cmath>
#include <concepts>
#include <limits>
#include <numbers>

#include "ductile/section/section.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile {

template <std::floating_point S>
struct CircleParameters {
    S radius = std::numeric_limits<S>::quiet_NaN(); ///< r [m], > 0
};

/// Immutable value; all members are noexcept after construction. All axes are alike.
template <std::floating_point S>
class Circle {
  public:
    using Scalar = S;

    /// @throws std::invalid_argument where the radius is missing (NaN), infinite or not positive.
    explicit Circle(const CircleParameters<S>& parameters)
        : radius_(check::positive("Circle.radius", parameters.radius, "m")) {}

    [[nodiscard]] S radius() const noexcept { return radius_; } ///< r [m]

    [[nodiscard]] S area() const noexcept { return pi * radius_ * radius_; }
    [[nodiscard]] S second_moment(SectionAxis = SectionAxis::x) const noexcept {
        return area() * radius_ * radius_ / 4;
    }
    [[nodiscard]] S product_of_inertia() const noexcept { return 0; }
    [[nodiscard]] S elastic_modulus(SectionAxis = SectionAxis::x) const noexcept {
        return area() * radius_ / 4;
    }
    [[nodiscard]] S plastic_modulus(SectionAxis = SectionAxis::x) const noexcept {
        return 4 * radius_ * radius_ * radius_ / 3;
    }
    [[nodiscard]] S shear_area(SectionAxis) const noexcept { return area(); }
    [[nodiscard]] S elastic_shear_area(SectionAxis) const noexcept { return 6 * area() / 7; }
    [[nodiscard]] S torsion_constant() const noexcept { return 2 * second_moment(); }
    [[nodiscard]] S plastic_torsion_modulus() const noexcept { return 2 * area() * radius_ / 3; }

    [[nodiscard]] S width_at(S height, SectionAxis = SectionAxis::x) const noexcept {
        const S square = (radius_ - height) * (radius_ + height);
        return square > 0 ? 2 * std::sqrt(square) : S(0);
    }
    [[nodiscard]] S lowest(SectionAxis = SectionAxis::x) const noexcept { return -radius_; }
    [[nodiscard]] S highest(SectionAxis = SectionAxis::x) const noexcept { return radius_; }

  private:
    static constexpr S pi = std::numbers::pi_v<S>;

    S radius_;
};

template <std::floating_point S>
Circle(const CircleParameters<S>&) -> Circle<S>;

static_assert(FullSection<Circle<double>> && FullSection<Circle<float>>);

} // namespace ductile
