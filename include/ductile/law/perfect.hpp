// SPDX-License-Identifier: MIT
//
// Perfect plasticity: the strength does not change with plastic travel, R(p) = R.
//
//   ∫ R dp = R (p1 - p0)
//
// Limit cases: R → ∞ is a rigid joint, R → 0 a free one.
#pragma once

#include <concepts>
#include <limits>

#include "ductile/law/law.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile {

template <std::floating_point S>
struct PerfectParameters {
    S strength = std::numeric_limits<S>::quiet_NaN(); ///< R [N | N m], > 0
};

template <std::floating_point S>
class Perfect {
  public:
    using Scalar = S;

    /// @throws std::invalid_argument where the strength is missing (NaN), infinite or not positive.
    explicit Perfect(const PerfectParameters<S>& parameters)
        : strength_(check::positive("Perfect.strength", parameters.strength, "N or N m")) {}

    [[nodiscard]] S value(S /*travel*/) const noexcept { return strength_; }
    [[nodiscard]] S slope(S /*travel*/) const noexcept { return 0; }
    [[nodiscard]] S mean(S /*from*/, S /*to*/) const noexcept { return strength_; }
    [[nodiscard]] S work(S from, S to) const noexcept { return strength_ * (to - from); }

  private:
    S strength_;
};

template <std::floating_point S>
Perfect(const PerfectParameters<S>&) -> Perfect<S>;

static_assert(AveragedLaw<Perfect<double>> && AveragedLaw<Perfect<float>>);

} // namespace ductile
