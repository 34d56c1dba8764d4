// SPDX-License-Identifier: MIT
//
// Stress-strain curves of a fibre under monotonic load, the same in tension and compression.
//
//   elastic-perfectly plastic   σ = clamp(E ε, ±f_y)
//   bilinear                    σ = E ε up to f_y, then slope a E
//   Ramberg-Osgood              ε = σ/E + (σ/K)^(1/n)
//
// Symbols
//   ε, σ  strain, stress, odd functions of each other            [-], [Pa]
//   E     Young's modulus                                        [Pa]
//   f_y   yield stress                                           [Pa]
//   a     slope after yield over E                               [-]
//   K, n  strength coefficient, strain-hardening exponent        [Pa], [-]
//   w     plastic work of a Masing loop, per volume              [J/m³]
//
// Ramberg-Osgood has no closed inverse. The function to be zeroed is convex and grows with σ, so
// Newton from above, min(E ε, K ε^n), comes down to the root without overshoot.
//
// Source: Ramberg and Osgood (1943), NACA TN 902, in the form of Dowling (2013), Mechanical
// Behavior of Materials, section 12.2; loop energy w = 4 σ_a ε_pa (1 - n)/(1 + n) for a loop that
// follows Masing's rule, Halford (1966), J. Materials 1, 3-18.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>

#include "ductile/vocabulary/check.hpp"

namespace ductile {

/// `stress(strain)` [Pa], odd in the strain [-] and finite. Where the curve also has
/// `youngs_modulus()` [Pa], that is its slope at zero.
template <class T>
concept UniaxialCurve = requires(const T curve, typename T::Scalar strain) {
    requires std::floating_point<typename T::Scalar>;
    { curve.stress(strain) } -> std::same_as<typename T::Scalar>;
};

/// Slope at zero strain [Pa]: what the curve says, else its secant at a strain of 1e-6, where any
/// curve that starts elastic still is.
template <UniaxialCurve Curve>
[[nodiscard]] typename Curve::Scalar initial_modulus(const Curve& curve) noexcept {
    using S = typename Curve::Scalar;
    if constexpr (requires {
                      { curve.youngs_modulus() } -> std::convertible_to<S>;
                  }) {
        return curve.youngs_modulus();
    } else {
        constexpr S small = S(1e-6);
        return curve.stress(small) / small;
    }
}

template <std::floating_point S>
struct BilinearCurveParameters {
    S youngs_modulus = std::numeric_limits<S>::quiet_NaN(); ///< E [Pa], > 0
    S yield_stress = std::numeric_limits<S>::quiet_NaN();   ///< f_y [Pa], > 0
    S slope_ratio = 0;                                      ///< a [-], in [0, 1]
};

/// Bilinear; elastic-perfectly plastic where the slope ratio is left at zero. Immutable value.
template <std::floating_point S>
class BilinearCurve {
  public:
    using Scalar = S;

    /// @throws std::invalid_argument where a parameter is missing (NaN), infinite or out of range.
    explicit BilinearCurve(const BilinearCurveParameters<S>& parameters)
        : youngs_modulus_(
              check::positive("BilinearCurve.youngs_modulus", parameters.youngs_modulus, "Pa")),
          yield_stress_(
              check::positive("BilinearCurve.yield_stress", parameters.yield_stress, "Pa")),
          slope_ratio_(check::between("BilinearCurve.slope_ratio", parameters.slope_ratio, S(0),
                                      S(1), "", true)) {}

    [[nodiscard]] S youngs_modulus() const noexcept { return youngs_modulus_; } ///< E [Pa]
    [[nodiscard]] S yield_stress() const noexcept { return yield_stress_; }     ///< f_y [Pa]

    [[nodiscard]] S stress(S strain) const noexcept {
        const S elastic = youngs_modulus_ * strain;
        const S yielded = std::clamp(elastic, -yield_stress_, yield_stress_);
        return yielded + slope_ratio_ * (elastic - yielded);
    }

  private:
    S youngs_modulus_;
    S yield_stress_;
    S slope_ratio_;
};

template <std::floating_point S>
BilinearCurve(const BilinearCurveParameters<S>&) -> BilinearCurve<S>;

template <std::floating_point S>
struct RambergOsgoodParameters {
    S youngs_modulus = std::numeric_limits<S>::quiet_NaN(); ///< E [Pa], > 0
    S coefficient = std::numeric_limits<S>::quiet_NaN();    ///< K [Pa], > 0
    S exponent = std::numeric_limits<S>::quiet_NaN();       ///< n [-], in (0, 1)
};

/// Immutable value.
template <std::floating_point S>
class RambergOsgood {
  public:
    using Scalar = S;

    /// @throws std::invalid_argument where a parameter is missing (NaN), infinite or out of range.
    explicit RambergOsgood(const RambergOsgoodParameters<S>& parameters)
        : youngs_modulus_(
              check::positive("RambergOsgood.youngs_modulus", parameters.youngs_modulus, "Pa")),
          coefficient_(check::positive("RambergOsgood.coefficient", parameters.coefficient, "Pa")),
          exponent_(check::between("RambergOsgood.exponent", parameters.exponent, S(0), S(1), "")) {
    }

    [[nodiscard]] S youngs_modulus() const noexcept { return youngs_modulus_; } ///< E [Pa]

    [[nodiscard]] S stress(S strain) const noexcept {
        const S target = std::abs(strain);
        S stress = std::min(youngs_modulus_ * target, coefficient_ * std::pow(target, exponent_));
        constexpr int most = 60;
        for (int i = 0; i < most && stress > 0; ++i) {
            const S plastic = plastic_of(stress);
            const S excess = stress / youngs_modulus_ + plastic - target;
            const S slope = 1 / youngs_modulus_ + plastic / (exponent_ * stress);
            const S next = stress - excess / slope;
            if (!(next < stress)) break;
            stress = next;
        }
        return std::copysign(stress, strain);
    }

    /// ε of a stress, elastic and plastic [-].
    [[nodiscard]] S strain(S stress) const noexcept {
        return stress / youngs_modulus_ + plastic_strain(stress);
    }
    /// (σ/K)^(1/n), with the sign of the stress [-].
    [[nodiscard]] S plastic_strain(S stress) const noexcept {
        return std::copysign(plastic_of(std::abs(stress)), stress);
    }
    /// w of a Masing loop between ±`amplitude` [Pa], in [J/m³].
    [[nodiscard]] S loop_energy(S amplitude) const noexcept {
        const S stress = std::abs(amplitude);
        return 4 * stress * plastic_of(stress) * (1 - exponent_) / (1 + exponent_);
    }

  private:
    S plastic_of(S stress) const noexcept { return std::pow(stress / coefficient_, 1 / exponent_); }

    S youngs_modulus_;
    S coefficient_;
    S exponent_;
};

template <std::floating_point S>
RambergOsgood(const RambergOsgoodParameters<S>&) -> RambergOsgood<S>;

static_assert(UniaxialCurve<BilinearCurve<double>> && UniaxialCurve<RambergOsgood<float>>);

} // namespace ductile
