// SPDX-License-Identifier: MIT
//
// Voce hardening: the strength saturates exponentially, on top of a linear part.
//
//   R(p) = R0 + Q (1 - exp(-b p)) + H p
//   ∫ R dp = (p1 - p0) (R0 + Q + H (p0 + p1)/2) - Q exp(-b p0) (1 - exp(-b (p1 - p0))) / b
//
// Symbols
//   R0  strength before any flow                         [N | N m]
//   Q   what saturation adds; negative: cyclic softening [N | N m]
//   b   rate of saturation                               [1/m | 1/rad]
//   H   linear hardening that remains                    [N/m | N m/rad]
//
// Limit cases: Q = 0 is linear hardening; b → ∞ is linear hardening from R0 + Q.
// With Q < 0 the strength falls first and never below R0 + Q > 0.
//
// Source: Voce (1948), The relationship between stress and strain for homogeneous deformation,
// J. Inst. Metals 74, 537-562; linear part as in common finite element practice.
#pragma once

#include <cmath>
#include <concepts>
#include <limits>

#include "ductile/law/law.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile {

template <std::floating_point S>
struct VoceParameters {
    S strength = std::numeric_limits<S>::quiet_NaN();   ///< R0 [N | N m], > 0
    S saturation = std::numeric_limits<S>::quiet_NaN(); ///< Q [N | N m], > -R0
    S rate = std::numeric_limits<S>::quiet_NaN();       ///< b [1/m | 1/rad], > 0
    S hardening = 0;                                    ///< H [N/m | N m/rad], >= 0
};

/// Immutable value.
template <std::floating_point S>
class Voce {
  public:
    using Scalar = S;

    /// @throws std::invalid_argument where a parameter is missing (NaN), infinite or out of range.
    explicit Voce(const VoceParameters<S>& parameters)
        : strength_(check::positive("Voce.strength", parameters.strength, "N or N m")),
          saturation_(check::between("Voce.saturation", parameters.saturation, -strength_,
                                     std::numeric_limits<S>::infinity(), "N or N m")),
          rate_(check::positive("Voce.rate", parameters.rate, "1/m or 1/rad")),
          hardening_(
              check::non_negative("Voce.hardening", parameters.hardening, "N/m or N m/rad")) {}

    [[nodiscard]] S value(S travel) const noexcept {
        return strength_ - saturation_ * std::expm1(-rate_ * travel) + hardening_ * travel;
    }
    [[nodiscard]] S slope(S travel) const noexcept {
        return saturation_ * rate_ * std::exp(-rate_ * travel) + hardening_;
    }
    [[nodiscard]] S work(S from, S to) const noexcept {
        const S distance = to - from;
        const S unsaturated = std::exp(-rate_ * from) * std::expm1(-rate_ * distance) / rate_;
        return distance * (strength_ + saturation_ + hardening_ * (from + to) / 2) +
               saturation_ * unsaturated;
    }

  private:
    S strength_;
    S saturation_;
    S rate_;
    S hardening_;
};

template <std::floating_point S>
Voce(const VoceParameters<S>&) -> Voce<S>;

static_assert(StrengthLaw<Voce<double>> && StrengthLaw<Voce<float>>);
static_assert(!ExhaustibleLaw<Voce<double>>);

} // namespace ductile
