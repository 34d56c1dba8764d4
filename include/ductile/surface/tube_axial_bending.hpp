// SPDX-License-Identifier: MIT
//
// Circular sections under axial force and bending: solid circle, tube of any thickness, thin tube.
//
// With ρ = inner/outer radius and the solid circle's
//   n₀(y) = (2/π)(asin y + y √(1-y²)),   m₀(y) = (1-y²)^{3/2}     (n₀ = 1, m₀ = 0 for y > 1)
// a tube is the outer circle less the inner one,
//   n = (n₀(y) - ρ² n₀(y/ρ))/(1-ρ²),   m = (m₀(y) - ρ³ m₀(y/ρ))/(1-ρ³),   a = (3π/4)(1-ρ²)/(1-ρ³)
// and a thin one, ρ → 1, n = (2/π) asin y, m = √(1-y²), that is m = cos(πn/2), a = π/2.
//
// With y = cos t the circle is n = 1 - (2t - sin 2t)/π, m = sin³ t. A tube loses digits of n by
// 1/(1-ρ²); use the thin one where ρ > 0.999 (the curves differ there by less than 1e-3).
//
// Source: closed forms as in Neal (1977), The Plastic Methods of Structural Analysis, chapter 6.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <numbers>

#include "ductile/surface/axial_bending.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile {

template <std::floating_point S>
struct CircleProfile {
    using Scalar = S;

    [[nodiscard]] S axial(S y) const noexcept {
        if (!(y < 1)) return 1;
        return 2 * std::numbers::inv_pi_v<S> * (std::asin(y) + y * root(y));
    }
    [[nodiscard]] S bending(S y) const noexcept { return root(y) * root(y) * root(y); }
    [[nodiscard]] S density(S y) const noexcept { return 4 * std::numbers::inv_pi_v<S> * root(y); }
    [[nodiscard]] S lever() const noexcept { return S(0.75) * std::numbers::pi_v<S>; }

  private:
    static S root(S y) noexcept { return std::sqrt(std::max((1 - y) * (1 + y), S(0))); }
};

template <std::floating_point S>
struct ThinTubeProfile {
    using Scalar = S;

    [[nodiscard]] S axial(S y) const noexcept {
        return 2 * std::numbers::inv_pi_v<S> * std::asin(std::min(y, S(1)));
    }
    [[nodiscard]] S bending(S y) const noexcept {
        return std::sqrt(std::max((1 - y) * (1 + y), S(0)));
    }
    /// Infinite at y = 1, kept finite there.
    [[nodiscard]] S density(S y) const noexcept {
        const S square = std::max((1 - y) * (1 + y), std::numeric_limits<S>::epsilon());
        return 2 * std::numbers::inv_pi_v<S> / std::sqrt(square);
    }
    [[nodiscard]] S lever() const noexcept { return std::numbers::pi_v<S> / 2; }
};

template <std::floating_point S>
struct TubeAxialBendingParameters {
    S outer_radius = std::numeric_limits<S>::quiet_NaN(); ///< [m], > 0
    S inner_radius = std::numeric_limits<S>::quiet_NaN(); ///< [m], in (0, outer radius)
};

template <std::floating_point S>
class TubeProfile {
  public:
    using Scalar = S;

    /// @throws std::invalid_argument where a radius is missing (NaN) or out of range.
    explicit TubeProfile(const TubeAxialBendingParameters<S>& parameters)
        : ratio_(check::between(
                     "TubeAxialBending.inner_radius", parameters.inner_radius, S(0),
                     check::positive("TubeAxialBending.outer_radius", parameters.outer_radius, "m"),
                     "m") /
                 parameters.outer_radius),
          area_((1 - ratio_) * (1 + ratio_)),
          modulus_(1 - ratio_ * ratio_ * ratio_) {
        if (!(ratio_ < 1)) {
            check::fail("TubeAxialBending.inner_radius", parameters.inner_radius, "m",
                        "less than outer_radius by more than round-off");
        }
    }

    [[nodiscard]] S radius_ratio() const noexcept { return ratio_; } ///< ρ [-]

    [[nodiscard]] S axial(S y) const noexcept {
        if (!(y < 1)) return 1;
        return (circle_.axial(y) - ratio_ * ratio_ * circle_.axial(y / ratio_)) / area_;
    }
    [[nodiscard]] S bending(S y) const noexcept {
        const S inner = ratio_ * ratio_ * ratio_ * circle_.bending(y / ratio_);
        return (circle_.bending(y) - inner) / modulus_;
    }
    [[nodiscard]] S density(S y) const noexcept {
        return (circle_.density(y) - ratio_ * circle_.density(y / ratio_)) / area_;
    }
    [[nodiscard]] S lever() const noexcept { return circle_.lever() * area_ / modulus_; }

  private:
    CircleProfile<S> circle_;
    S ratio_;
    S area_;    ///< 1 - ρ²
    S modulus_; ///< 1 - ρ³
};

/// Solid circle; normalised surface in (n, m), the same for every radius.
template <std::floating_point S>
class CircleAxialBending : public AxialBending<CircleProfile<S>> {
  public:
    CircleAxialBending() noexcept : AxialBending<CircleProfile<S>>({}) {}
};

/// Thin tube; normalised surface in (n, m), the same for every radius and thickness.
template <std::floating_point S>
class ThinTubeAxialBending : public AxialBending<ThinTubeProfile<S>> {
  public:
    ThinTubeAxialBending() noexcept : AxialBending<ThinTubeProfile<S>>({}) {}
};

/// Tube of any thickness; normalised surface in (n, m).
template <std::floating_point S>
class TubeAxialBending : public AxialBending<TubeProfile<S>> {
  public:
    /// @throws std::invalid_argument where a radius is missing (NaN) or out of range.
    explicit TubeAxialBending(const TubeAxialBendingParameters<S>& parameters)
        : AxialBending<TubeProfile<S>>(TubeProfile<S>(parameters)) {}
};

template <std::floating_point S>
TubeAxialBending(const TubeAxialBendingParameters<S>&) -> TubeAxialBending<S>;

static_assert(YieldSurface<CircleAxialBending<double>> &&
              YieldSurface<ThinTubeAxialBending<float>> && YieldSurface<TubeAxialBending<double>> &&
              YieldSurface<TubeAxialBending<float>>);

} // namespace ductile
