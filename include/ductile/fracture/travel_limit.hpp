// SPDX-License-Identifier: MIT
//
// Break at a largest accumulated plastic travel: plastic rotation for a hinge, elongation for a
// bar.
//
// Source: Nikula (2017), Handling of plasticity in physics engine, section 2.8.1 (maximum plastic
// rotation: 1-6 rad for a ductile part, 0.01-0.1 rad for a brittle one). We count the travel that
// does work at yield, not every change of angle, so load below yield never consumes life.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>

#include "ductile/fracture/fracture.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile {

template <std::floating_point S>
struct TravelLimitParameters {
    S limit = std::numeric_limits<S>::quiet_NaN(); ///< p_max [m | rad], > 0; infinity: never breaks
};

template <std::floating_point S>
class TravelLimit : public WithoutForceCap<S>, public WithoutSoftening<S> {
  public:
    using Scalar = S;

    struct State {
        S travel = 0; ///< accumulated plastic travel p [m | rad]

        bool operator==(const State&) const = default;
    };

    /// A limit that is never reached.
    TravelLimit() noexcept : limit_(std::numeric_limits<S>::infinity()) {}

    /// @throws std::invalid_argument where the limit is NaN or not positive.
    explicit TravelLimit(const TravelLimitParameters<S>& parameters)
        : limit_(check::positive_or_infinite("TravelLimit.limit", parameters.limit, "m or rad")) {}

    [[nodiscard]] S limit() const noexcept { return limit_; } ///< p_max [m | rad]

    /// Plastic travel left before the break, never negative. [m | rad]
    [[nodiscard]] S remaining(S travel) const noexcept {
        return travel < limit_ ? limit_ - travel : S(0);
    }
    [[nodiscard]] S remaining(const State& state, S /*strength*/,
                              S /*direction*/ = 0) const noexcept {
        return broken(state) ? S(0) : remaining(state.travel);
    }

    void update(State& state, const PlasticIncrement<S>& increment) const noexcept {
        if (!(std::abs(increment.plastic) > 0)) return;
        state.travel = std::max(state.travel, increment.travel);
    }
    [[nodiscard]] bool broken(const State& state) const noexcept {
        return state.travel >= limit_ * (1 - exhausted_share<S>);
    }
    /// p / p_max
    [[nodiscard]] S damage(const State& state) const noexcept {
        return broken(state) ? S(1) : state.travel / limit_;
    }
    [[nodiscard]] CriterionKind governing(const State&) const noexcept {
        return CriterionKind::plastic_travel;
    }

  private:
    S limit_;
};

template <std::floating_point S>
TravelLimit(const TravelLimitParameters<S>&) -> TravelLimit<S>;

static_assert(FractureCriterion<TravelLimit<double>> && FractureCriterion<TravelLimit<float>>);

} // namespace ductile
