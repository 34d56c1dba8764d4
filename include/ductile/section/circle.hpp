// SPDX-License-Identifier: MIT
//
// Solid circle.
//
//   A = π r²,  I = π r⁴/4,  W_el = π r³/4,  W_pl = 4 r³/3
//
// Source: any text on strength of materials, e.g. Timoshenko (1940). Shape factor 16/(3π).
#pragma once

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

template <std::floating_point S>
class Circle {
  public:
    using Scalar = S;

    /// @throws std::invalid_argument where the radius is missing (NaN), infinite or not positive.
    explicit Circle(const CircleParameters<S>& parameters)
        : radius_(check::positive("Circle.radius", parameters.radius, "m")) {}

    [[nodiscard]] S radius() const noexcept { return radius_; } ///< r [m]

    [[nodiscard]] S area() const noexcept { return pi * radius_ * radius_; }
    [[nodiscard]] S second_moment() const noexcept { return elastic_modulus() * radius_; }
    [[nodiscard]] S elastic_modulus() const noexcept { return pi * radius_ * radius_ * radius_ / 4; }
    [[nodiscard]] S plastic_modulus() const noexcept { return 4 * radius_ * radius_ * radius_ / 3; }

  private:
    static constexpr S pi = std::numbers::pi_v<S>;

    S radius_;
};

template <std::floating_point S>
Circle(const CircleParameters<S>&) -> Circle<S>;

static_assert(Section<Circle<double>> && Section<Circle<float>>);

} // namespace ductile
