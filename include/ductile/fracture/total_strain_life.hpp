// SPDX-License-Identifier: MIT
//
// Life under total strain: Basquin's elastic and Coffin-Manson's plastic part added.
//
//   ε_a = (σ_f'/E) (2N_f)^b + ε_f' (2N_f)^c
//   transition life, where both parts are equal: 2N_t = (ε_f' E/σ_f')^(1/(b-c))
//
// No closed inverse. With x = ln 2N_f, x_e and x_p the lives by either part alone,
//
//   g(x) = ln(exp(b (x - x_e)) + exp(c (x - x_p))) = 0
//
// g decreases and is convex (log-sum-exp), and at max(x_e, x_p) it lies in [0, ln 2], left of the
// root: Newton's iteration from there rises to the root monotonically and quadratically, and
// needs no safeguard.
//
// Use it where the amplitude is that of the *total* strain, as for a rigid-plastic row whose travel
// stands for all the deformation of the part. Where the amplitude is plastic, take CoffinManson.
//
// Symbols
//   ε_a   total strain amplitude, half the range          [-]
//   σ_f'  fatigue strength coefficient                    [Pa]
//   b     fatigue strength exponent, about -0.05 … -0.12  [-]
//   E     Young's modulus                                 [Pa]
//   ε_f', c, 2N_f  as in coffin_manson.hpp
//
// Limit cases: large ε_a → CoffinManson, small ε_a → Basquin. Source: Morrow (1965), Cyclic plastic
// strain energy and fatigue of metals, ASTM STP 378, 45-87.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>

#include "ductile/fracture/life_curve.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile {

template <std::floating_point S>
struct TotalStrainLifeParameters {
    S ductility_coefficient = std::numeric_limits<S>::quiet_NaN(); ///< ε_f' [-], > 0
    S ductility_exponent = std::numeric_limits<S>::quiet_NaN();    ///< c [-], in (-2, 0)
    S strength_coefficient = std::numeric_limits<S>::quiet_NaN();  ///< σ_f' [Pa], > 0
    S strength_exponent = std::numeric_limits<S>::quiet_NaN();     ///< b [-], in (c, 0)
    S youngs_modulus = std::numeric_limits<S>::quiet_NaN();        ///< E [Pa], > 0
};

/// Immutable value; all members are noexcept after construction. `reversals` takes a handful of
/// Newton steps, the rest is closed form.
template <std::floating_point S>
class TotalStrainLife {
  public:
    using Scalar = S;

    /// @throws std::invalid_argument where a constant is missing (NaN) or out of range.
    explicit TotalStrainLife(const TotalStrainLifeParameters<S>& p)
        : plastic_(check::positive("TotalStrainLife.ductility_coefficient", p.ductility_coefficient,
                                   "")),
          c_(check::between("TotalStrainLife.ductility_exponent", p.ductility_exponent, S(-2), S(0),
                            "")),
          elastic_(check::positive("TotalStrainLife.strength_coefficient", p.strength_coefficient,
                                   "Pa") /
                   check::positive("TotalStrainLife.youngs_modulus", p.youngs_modulus, "Pa")),
          b_(check::between("TotalStrainLife.strength_exponent", p.strength_exponent, c_, S(0),
                            "")) {}

    /// ε_a with a life of 2N reversals > 0 [-].
    [[nodiscard]] S amplitude(S reversals) const noexcept {
        return elastic_amplitude(reversals) + plastic_amplitude(reversals);
    }
    [[nodiscard]] S elastic_amplitude(S reversals) const noexcept {
        return elastic_ * std::pow(reversals, b_);
    }
    [[nodiscard]] S plastic_amplitude(S reversals) const noexcept {
        return plastic_ * std::pow(reversals, c_);
    }
    /// 2N at which the elastic and the plastic part are equal [-].
    [[nodiscard]] S transition_reversals() const noexcept {
        return std::pow(plastic_ / elastic_, 1 / (b_ - c_));
    }

    /// 2N_f at a total strain amplitude >= 0 [-]; infinity at 0.
    [[nodiscard]] S reversals(S amplitude) const noexcept {
        if (!(amplitude > 0)) return std::numeric_limits<S>::infinity();
        if (!std::isfinite(amplitude)) return 0;
        const S elastic_life = std::log(amplitude / elastic_) / b_;
        const S plastic_life = std::log(amplitude / plastic_) / c_;
        S x = std::max(elastic_life, plastic_life);
        for (int i = 0; i < max_steps; ++i) {
            const S elastic = std::exp(b_ * (x - elastic_life));
            const S plastic = std::exp(c_ * (x - plastic_life));
            const S total = elastic + plastic;
            const S rise = -std::log(total) * total / (b_ * elastic + c_ * plastic);
            if (!(rise > std::numeric_limits<S>::epsilon() * std::abs(x))) break;
            x += rise;
        }
        return std::exp(x);
    }

  private:
    /// Quadratic from a start at most ln 2 off in g; of 3·10⁶ random curves none took more than
    /// 10 steps in double.
    static constexpr int max_steps = 24;

    S plastic_; ///< ε_f' [-]
    S c_;
    S elastic_; ///< σ_f'/E [-]
    S b_;
};

template <std::floating_point S>
TotalStrainLife(const TotalStrainLifeParameters<S>&) -> TotalStrainLife<S>;

static_assert(LifeCurve<TotalStrainLife<double>> && LifeCurve<TotalStrainLife<float>>);

} // namespace ductile
