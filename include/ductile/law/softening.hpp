// SPDX-License-Identifier: MIT
//
// Linear softening to zero after a plateau: a joint that holds, tears and lets go without a jump.
//
//   R(p) = R0                              p <= p_s
//   R(p) = R0 (p_f - p) / (p_f - p_s)      p_s < p < p_f
//   R(p) = 0                               p >= p_f
//
//   ∫_0^{p_f} R dp = R0 (p_s + p_f) / 2, the energy of the break
//
// Symbols
//   p_s  travel at which softening starts [m | rad]
//   p_f  exhaustion, where R is zero      [m | rad]
//
// An abrupt break is p_f just beyond p_s. Softening by any other curve: Multilinear
// pairs that end at zero. How a break follows from p_f: law.hpp.
//
// Limit of use: a softening slope steeper than the stiffness of what loads it, R0/(p_f - p_s) > k,
// snaps back: it is real and dynamic, the excess becomes motion.
//
// Source: linear softening of the fictitious crack, Hillerborg, Modéer and Petersson (1976), Cement
// and Concrete Research 6, 773-781, here for a force over its plastic travel, with a plateau added.
#pragma once

#include <algorithm>
#include <concepts>
#include <limits>

#include "ductile/law/law.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile {

template <std::floating_point S>
struct SofteningParameters {
    S strength = std::numeric_limits<S>::quiet_NaN();   ///< R0 [N | N m], > 0
    S plateau = 0;                                      ///< p_s [m | rad], >= 0
    S exhaustion = std::numeric_limits<S>::quiet_NaN(); ///< p_f [m | rad], > p_s
};

/// Immutable value.
template <std::floating_point S>
class Softening {
  public:
    using Scalar = S;

    /// @throws std::invalid_argument where a parameter is missing (NaN), infinite or out of range.
    explicit Softening(const SofteningParameters<S>& parameters)
        : strength_(check::positive("Softening.strength", parameters.strength, "N or N m")),
          plateau_(check::non_negative("Softening.plateau", parameters.plateau, "m or rad")),
          exhaustion_(check::between("Softening.exhaustion", parameters.exhaustion, plateau_,
                                     std::numeric_limits<S>::infinity(), "m or rad")) {}

    [[nodiscard]] S value(S travel) const noexcept {
        return strength_ * std::clamp(left(travel) / (exhaustion_ - plateau_), S(0), S(1));
    }
    [[nodiscard]] S slope(S travel) const noexcept {
        const bool falling = travel >= plateau_ && travel < exhaustion_;
        return falling ? -strength_ / (exhaustion_ - plateau_) : S(0);
    }
    [[nodiscard]] S work(S from, S to) const noexcept {
        const S held = std::min(to, plateau_) - std::min(from, plateau_);
        const S a = falling_left(from);
        const S b = falling_left(to);
        return strength_ * (held + (a - b) * (a + b) / (2 * (exhaustion_ - plateau_)));
    }
    [[nodiscard]] S exhaustion() const noexcept { return exhaustion_; }

  private:
    S left(S travel) const noexcept { return exhaustion_ - travel; }
    S falling_left(S travel) const noexcept {
        return std::clamp(left(travel), S(0), exhaustion_ - plateau_);
    }

    S strength_;
    S plateau_;
    S exhaustion_;
};

template <std::floating_point S>
Softening(const SofteningParameters<S>&) -> Softening<S>;

static_assert(ExhaustibleLaw<Softening<double>> && ExhaustibleLaw<Softening<float>>);

} // namespace ductile
