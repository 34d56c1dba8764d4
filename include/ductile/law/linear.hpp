// SPDX-License-Identifier: MIT
//
// Linear hardening: the strength grows in proportion to the plastic travel.
//
//   R(p) = R0 + H p,   ∫ R dp = (p1 - p0) (R(p0) + R(p1)) / 2
//
// With an elastic stiffness k in series the tangent after yield is α k with H = α k / (1 - α).
// Limit cases: H = 0 is perfect plasticity, H → ∞ an elastic spring with the offset R0.
//
// Source: any text on plasticity, e.g. Simo and Hughes (1998), Computational Inelasticity, section
// 1.2.3.
#pragma once

#include <concepts>
#include <limits>

#include "ductile/law/law.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile {

template <std::floating_point S>
struct LinearParameters {
    S strength = std::numeric_limits<S>::quiet_NaN();  ///< R0 [N | N m], > 0
    S hardening = std::numeric_limits<S>::quiet_NaN(); ///< H [N/m | N m/rad], >= 0
};

/// Immutable value.
template <std::floating_point S>
class Linear {
  public:
    using Scalar = S;

    /// @throws std::invalid_argument where a parameter is missing (NaN), infinite or out of range.
    explicit Linear(const LinearParameters<S>& parameters)
        : strength_(check::positive("Linear.strength", parameters.strength, "N or N m")),
          hardening_(
              check::non_negative("Linear.hardening", parameters.hardening, "N/m or N m/rad")) {}

    [[nodiscard]] S value(S travel) const noexcept { return strength_ + hardening_ * travel; }
    [[nodiscard]] S slope(S /*travel*/) const noexcept { return hardening_; }
    [[nodiscard]] S mean(S from, S to) const noexcept {
        return strength_ + hardening_ * (from + to) / 2;
    }
    [[nodiscard]] S work(S from, S to) const noexcept { return (to - from) * mean(from, to); }

  private:
    S strength_;
    S hardening_;
};

template <std::floating_point S>
Linear(const LinearParameters<S>&) -> Linear<S>;

static_assert(AveragedLaw<Linear<double>> && AveragedLaw<Linear<float>>);
static_assert(!ExhaustibleLaw<Linear<double>>);

} // namespace ductile
