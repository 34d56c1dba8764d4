// SPDX-License-Identifier: MIT
//
// Break when plastic flow has absorbed a given energy, as a Charpy test measures it.
//
//   remaining travel at strength R:  r = (E_max - D) / R,  so that R r brings the total to E_max
//
// Symbols
//   E_max  energy to break                 [J]
//   D      plastic work absorbed so far    [J]
#pragma once

#include <cmath>
#include <concepts>
#include <limits>

#include "ductile/fracture/compensated_sum.hpp"
#include "ductile/fracture/fracture.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile {

template <std::floating_point S>
struct EnergyLimitParameters {
    S limit = std::numeric_limits<S>::quiet_NaN(); ///< E_max [J], > 0; infinity: never breaks
};

/// Immutable value; after construction all members are noexcept and O(1).
template <std::floating_point S>
class EnergyLimit : public WithoutForceCap<S>, public WithoutSoftening<S> {
  public:
    using Scalar = S;

    struct State {
        CompensatedSum<S> work; ///< D [J]

        bool operator==(const State&) const = default;
    };

    /// @throws std::invalid_argument where the limit is NaN or not positive.
    explicit EnergyLimit(const EnergyLimitParameters<S>& parameters)
        : limit_(check::positive_or_infinite("EnergyLimit.limit", parameters.limit, "J")) {}

    [[nodiscard]] S limit() const noexcept { return limit_; } ///< E_max [J]

    /// Infinity where the strength is zero: flow without work absorbs nothing.
    [[nodiscard]] S remaining(const State& state, S strength, S /*direction*/ = 0) const noexcept {
        if (broken(state)) return 0;
        if (!(strength > 0)) return std::numeric_limits<S>::infinity();
        return (limit_ - state.work.value()) / strength;
    }

    void update(State& state, const PlasticIncrement<S>& increment) const noexcept {
        if (std::abs(increment.plastic) > 0 && increment.work > 0) state.work.add(increment.work);
    }
    [[nodiscard]] bool broken(const State& state) const noexcept {
        return state.work.value() >= limit_ * (1 - exhausted_share<S>);
    }
    /// D / E_max
    [[nodiscard]] S damage(const State& state) const noexcept {
        return broken(state) ? S(1) : state.work.value() / limit_;
    }
    [[nodiscard]] CriterionKind governing(const State&) const noexcept {
        return CriterionKind::absorbed_energy;
    }

  private:
    S limit_;
};

template <std::floating_point S>
EnergyLimit(const EnergyLimitParameters<S>&) -> EnergyLimit<S>;

static_assert(FractureCriterion<EnergyLimit<double>> && FractureCriterion<EnergyLimit<float>>);

} // namespace ductile
