// SPDX-License-Identifier: MIT
//
// Round tube, outer radius R, inner radius r.
//
//   A = π (R² - r²),  I = π (R⁴ - r⁴)/4,  W_el = I/R,  W_pl = 4 (R³ - r³)/3
//   J = π (R⁴ - r⁴)/2,  W_T = 2 π (R³ - r³)/3   (sand heap with a flat top over the hole)
//   A_v = 2 A/π,  A_s = 6 (1 + m²)² A / (7 (1 + m²)² + 20 m²) with m = r/R
//
// Source: Timoshenko (1940); A_v EN 1993-1-1, 6.2.6(3)g; A_s Cowper (1966) at nu = 0.
// Limit cases: r → R: A_s → A/2 and W_pl → 4 R² t; r → 0: the solid circle, but for A_v, which holds
// for walls along which the stress runs and is on the safe side for thick ones.
#pragma once

#include <cmath>
#include <concepts>
#include <limits>
#include <numbers>

#include "ductile/section/section.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile {

template <std::floating_point S>
struct TubeParameters {
    S outer_radius = std::numeric_limits<S>::quiet_NaN(); ///< R [m], > 0
    S inner_radius = std::numeric_limits<S>::quiet_NaN(); ///< r [m], in (0, outer_radius)
};

/// Immutable value; all members are noexcept after construction. All axes are alike.
template <std::floating_point S>
class Tube {
  public:
    using Scalar = S;

    /// @throws std::invalid_argument where a radius is missing (NaN) or out of range.
    explicit Tube(const TubeParameters<S>& parameters)
        : outer_(check::positive("Tube.outer_radius", parameters.outer_radius, "m")),
          inner_(check::between("Tube.inner_radius", parameters.inner_radius, S(0),
                                parameters.outer_radius, "m")) {}

    [[nodiscard]] S outer_radius() const noexcept { return outer_; } ///< R [m]
    [[nodiscard]] S inner_radius() const noexcept { return inner_; } ///< r [m]

    [[nodiscard]] S area() const noexcept { return pi * (outer_ - inner_) * (outer_ + inner_); }
    [[nodiscard]] S second_moment(SectionAxis = SectionAxis::x) const noexcept {
        return area() * (outer_ * outer_ + inner_ * inner_) / 4;
    }
    [[nodiscard]] S product_of_inertia() const noexcept { return 0; }
    [[nodiscard]] S elastic_modulus(SectionAxis = SectionAxis::x) const noexcept {
        return second_moment() / outer_;
    }
    [[nodiscard]] S plastic_modulus(SectionAxis = SectionAxis::x) const noexcept {
        return 4 * difference_of_cubes() / 3;
    }
    [[nodiscard]] S shear_area(SectionAxis) const noexcept { return 2 * area() / pi; }
    [[nodiscard]] S elastic_shear_area(SectionAxis) const noexcept {
        const S ratio = inner_ / outer_;
        const S sum = (1 + ratio * ratio) * (1 + ratio * ratio);
        return 6 * sum / (7 * sum + 20 * ratio * ratio) * area();
    }
    [[nodiscard]] S torsion_constant() const noexcept { return 2 * second_moment(); }
    [[nodiscard]] S plastic_torsion_modulus() const noexcept {
        return 2 * pi * difference_of_cubes() / 3;
    }

    [[nodiscard]] S width_at(S height, SectionAxis = SectionAxis::x) const noexcept {
        return chord(outer_, height) - chord(inner_, height);
    }
    [[nodiscard]] S lowest(SectionAxis = SectionAxis::x) const noexcept { return -outer_; }
    [[nodiscard]] S highest(SectionAxis = SectionAxis::x) const noexcept { return outer_; }

  private:
    static constexpr S pi = std::numbers::pi_v<S>;

    static S chord(S radius, S height) noexcept {
        const S square = (radius - height) * (radius + height);
        return square > 0 ? 2 * std::sqrt(square) : S(0);
    }
    /// R³ - r³ without cancellation in a thin wall.
    [[nodiscard]] S difference_of_cubes() const noexcept {
        return (outer_ - inner_) * (outer_ * outer_ + outer_ * inner_ + inner_ * inner_);
    }

    S outer_;
    S inner_;
};

template <std::floating_point S>
Tube(const TubeParameters<S>&) -> Tube<S>;

static_assert(FullSection<Tube<double>> && FullSection<Tube<float>>);

} // namespace ductile
