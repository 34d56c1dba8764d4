// SPDX-License-Identifier: MIT
//
// Back forces: how the centre x of the elastic range follows the flow (kinematic hardening, the
// Bauschinger effect). They depend on the signed flow, while a StrengthLaw depends on its total.
//
//   none                 x = 0
//   Prager               dx = H du_p                       stores x²/(2H)
//   Armstrong-Frederick  dx = C du_p - γ x |du_p|          stores x²/(2C), loses γ x²/C per travel
//
// Symbols ("x | y": translational row | rotational row)
//   x    back force                         [N | N m]
//   u_p  signed plastic displacement        [m | rad]
//   H,C  kinematic modulus                  [N/m | N m/rad]
//   γ    recall: x saturates at ±C/γ        [1/m | 1/rad]
//
// Along flow in one direction s = ±1 Armstrong-Frederick has the closed form used here, so that
// cutting a step changes nothing: with y = s x and a = C/γ,  y(δ) = a + (y0 - a) exp(-γ δ).
//
// Limit cases: γ → 0 is Prager; C = γ a with γ → ∞ is a jump of the range by a.
//
// Source: Prager (1956), J. Appl. Mech. 23, 493-496; Frederick and Armstrong (2007), Materials at
// High Temperatures 24, 1-26 (reprint of the CEGB report of 1966); free energy after Lemaitre and
// Chaboche (1990), Mechanics of Solid Materials, section 5.4.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>

#include "ductile/vocabulary/check.hpp"

namespace ductile {

/// - `shifted(x, increment)`: back force after a signed increment of flow [N | N m]
/// - `slope(x, direction)`: dx/du_p for flow in `direction` = ±1, never negative [N/m | N m/rad]
/// - `stored(x)`: what it holds [J]
/// - `dissipated(x, increment)`: what it loses on the way from x, >= 0 [J]
template <class T>
concept BackForceLaw = requires(const T law, typename T::Scalar x) {
    { law.shifted(x, x) } noexcept -> std::same_as<typename T::Scalar>;
    { law.slope(x, x) } noexcept -> std::same_as<typename T::Scalar>;
    { law.stored(x) } noexcept -> std::same_as<typename T::Scalar>;
    { law.dissipated(x, x) } noexcept -> std::same_as<typename T::Scalar>;
};

/// The elastic range stays centred on zero.
template <std::floating_point S>
class NoBackForce {
  public:
    using Scalar = S;

    [[nodiscard]] S shifted(S x, S /*increment*/) const noexcept { return x; }
    [[nodiscard]] S slope(S /*x*/, S /*direction*/) const noexcept { return 0; }
    [[nodiscard]] S stored(S /*x*/) const noexcept { return 0; }
    [[nodiscard]] S dissipated(S /*x*/, S /*increment*/) const noexcept { return 0; }
};

template <std::floating_point S>
struct PragerParameters {
    S modulus = std::numeric_limits<S>::quiet_NaN(); ///< H [N/m | N m/rad], > 0
};

template <std::floating_point S>
class Prager {
  public:
    using Scalar = S;

    /// @throws std::invalid_argument where the modulus is missing (NaN), infinite or not positive.
    explicit Prager(const PragerParameters<S>& parameters)
        : modulus_(check::positive("Prager.modulus", parameters.modulus, "N/m or N m/rad")) {}

    [[nodiscard]] S shifted(S x, S increment) const noexcept { return x + modulus_ * increment; }
    [[nodiscard]] S slope(S /*x*/, S /*direction*/) const noexcept { return modulus_; }
    [[nodiscard]] S stored(S x) const noexcept { return x * x / (2 * modulus_); }
    [[nodiscard]] S dissipated(S /*x*/, S /*increment*/) const noexcept { return 0; }

  private:
    S modulus_;
};

template <std::floating_point S>
Prager(const PragerParameters<S>&) -> Prager<S>;

template <std::floating_point S>
struct ArmstrongFrederickParameters {
    S modulus = std::numeric_limits<S>::quiet_NaN(); ///< C [N/m | N m/rad], > 0
    S recall = std::numeric_limits<S>::quiet_NaN();  ///< γ [1/m | 1/rad], > 0
};

template <std::floating_point S>
class ArmstrongFrederick {
  public:
    using Scalar = S;

    /// @throws std::invalid_argument where a parameter is missing (NaN), infinite or not positive.
    explicit ArmstrongFrederick(const ArmstrongFrederickParameters<S>& parameters)
        : modulus_(
              check::positive("ArmstrongFrederick.modulus", parameters.modulus, "N/m or N m/rad")),
          recall_(check::positive("ArmstrongFrederick.recall", parameters.recall, "1/m or 1/rad")) {
    }

    [[nodiscard]] S shifted(S x, S increment) const noexcept {
        const S end = std::copysign(modulus_ / recall_, increment);
        return x - (end - x) * std::expm1(-recall_ * std::abs(increment));
    }
    [[nodiscard]] S slope(S x, S direction) const noexcept {
        return modulus_ - recall_ * x * direction;
    }
    [[nodiscard]] S stored(S x) const noexcept { return x * x / (2 * modulus_); }
    /// ∫ γ x²/C over the travel.
    [[nodiscard]] S dissipated(S x, S increment) const noexcept {
        const S end = std::copysign(modulus_ / recall_, increment);
        const S travel = std::abs(increment);
        const S once = -std::expm1(-recall_ * travel) / recall_;
        const S twice = -std::expm1(-2 * recall_ * travel) / (2 * recall_);
        const S off = x - end;
        const S square = end * end * travel + off * (2 * end * once + off * twice);
        return std::max(square, S(0)) * recall_ / modulus_;
    }

  private:
    S modulus_;
    S recall_;
};

template <std::floating_point S>
ArmstrongFrederick(const ArmstrongFrederickParameters<S>&) -> ArmstrongFrederick<S>;

static_assert(BackForceLaw<NoBackForce<double>> && BackForceLaw<Prager<float>> &&
              BackForceLaw<ArmstrongFrederick<double>>);

} // namespace ductile
