// SPDX-License-Identifier: MIT
//
// Life under plastic strain: Coffin-Manson.
//
//   ε_pa = ε_f' (2N_f)^c      2N_f = (ε_pa / ε_f')^(1/c)
//
// Symbols
//   ε_pa  plastic strain amplitude, half the range       [-]
//   ε_f'  fatigue ductility coefficient                  [-]
//   c     fatigue ductility exponent, about -0.5 … -0.7  [-]
//   2N_f  reversals to failure, two per cycle            [-]
//
// Source: Coffin (1954), A study of the effects of cyclic thermal stresses on a ductile metal,
// Trans. ASME 76, 931-950; Manson (1953), Behavior of materials under conditions of thermal stress,
// NACA TN 2933.
#pragma once

#include <cmath>
#include <concepts>
#include <limits>

#include "ductile/fracture/life_curve.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile {

template <std::floating_point S>
struct CoffinMansonParameters {
    S ductility_coefficient = std::numeric_limits<S>::quiet_NaN(); ///< ε_f' [-], > 0
    S ductility_exponent = std::numeric_limits<S>::quiet_NaN();    ///< c [-], in (-2, 0)
};

/// Immutable value; all members are noexcept and closed form after construction.
template <std::floating_point S>
class CoffinManson {
  public:
    using Scalar = S;

    /// @throws std::invalid_argument where a constant is missing (NaN) or out of range.
    explicit CoffinManson(const CoffinMansonParameters<S>& parameters)
        : coefficient_(check::positive("CoffinManson.ductility_coefficient",
                                       parameters.ductility_coefficient, "")),
          exponent_(check::between("CoffinManson.ductility_exponent", parameters.ductility_exponent,
                                   S(-2), S(0), "")) {}

    [[nodiscard]] S ductility_coefficient() const noexcept { return coefficient_; } ///< ε_f' [-]
    [[nodiscard]] S ductility_exponent() const noexcept { return exponent_; }       ///< c [-]

    /// 2N_f at a plastic strain amplitude >= 0 [-]; infinity at 0.
    [[nodiscard]] S reversals(S amplitude) const noexcept {
        if (!(amplitude > 0)) return std::numeric_limits<S>::infinity();
        return std::pow(amplitude / coefficient_, 1 / exponent_);
    }
    /// ε_pa with a life of 2N reversals > 0 [-].
    [[nodiscard]] S amplitude(S reversals) const noexcept {
        return coefficient_ * std::pow(reversals, exponent_);
    }

  private:
    S coefficient_;
    S exponent_;
};

template <std::floating_point S>
CoffinManson(const CoffinMansonParameters<S>&) -> CoffinManson<S>;

static_assert(LifeCurve<CoffinManson<double>> && LifeCurve<CoffinManson<float>>);

} // namespace ductile
