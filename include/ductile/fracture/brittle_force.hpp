// SPDX-License-Identifier: MIT
//
// Break without plastic flow: a weld, a bond line or a brittle material snaps when its force or
// moment reaches a limit. The limit is a cap on the force, so the row is asked for no more than it,
// at any step; a joint whose strength lies below the cap flows first and never gets there.
//
// Limit cases: cap → ∞ never breaks; cap → 0 breaks at the first force of the right sign.
//
// The force of a rigid row under impact is impulse / dt, so where the load is a blow and not a
// force, the break of a rigid brittle joint depends on dt; a stiffness or an energy limit cures
// that.
#pragma once

#include <cmath>
#include <concepts>
#include <limits>

#include "ductile/fracture/fracture.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile {

/// Sign of the row's force that can break it. The force is that on the row: a bar in tension pulls
/// its ends together, which is a negative force where the row's velocity is positive for
/// separation.
enum class BreakingSign : signed char { negative = -1, either = 0, positive = 1 };

template <std::floating_point S>
struct BrittleForceParameters {
    S limit = std::numeric_limits<S>::quiet_NaN(); ///< [N | N m], > 0; infinity: never breaks
    BreakingSign sign = BreakingSign::either;
};

/// Immutable value; after construction all members are noexcept and O(1).
template <std::floating_point S>
class BrittleForce : public WithoutSoftening<S> {
  public:
    using Scalar = S;

    struct State {
        bool broken = false;

        bool operator==(const State&) const = default;
    };

    /// @throws std::invalid_argument where the limit is NaN or not positive.
    explicit BrittleForce(const BrittleForceParameters<S>& parameters)
        : limit_(check::positive_or_infinite("BrittleForce.limit", parameters.limit, "N or N m")),
          sign_(parameters.sign) {}

    [[nodiscard]] S limit() const noexcept { return limit_; } ///< [N | N m]
    [[nodiscard]] BreakingSign sign() const noexcept { return sign_; }

    [[nodiscard]] S force_cap(const State& state, S sign = 0) const noexcept {
        if (state.broken) return 0;
        return S(sign_) * sign < 0 ? std::numeric_limits<S>::infinity() : limit_;
    }
    /// Flow is not limited.
    [[nodiscard]] S remaining(const State& state, S /*strength*/,
                              S /*direction*/ = 0) const noexcept {
        return state.broken ? S(0) : std::numeric_limits<S>::infinity();
    }

    void update(State& state, const PlasticIncrement<S>& increment) const noexcept {
        const S cap = force_cap(state, increment.force);
        if (std::abs(increment.force) >= cap * (1 - reached)) state.broken = true;
    }
    [[nodiscard]] bool broken(const State& state) const noexcept { return state.broken; }
    /// 0 until the break: a load below the cap leaves no trace.
    [[nodiscard]] S damage(const State& state) const noexcept { return state.broken ? S(1) : S(0); }
    [[nodiscard]] CriterionKind governing(const State&) const noexcept {
        return CriterionKind::brittle_force;
    }

  private:
    /// A force this close to the cap is at it; wider than the round-off of λ/dt in float.
    static constexpr S reached = S(4e-6);

    S limit_;
    BreakingSign sign_;
};

template <std::floating_point S>
BrittleForce(const BrittleForceParameters<S>&) -> BrittleForce<S>;

static_assert(FractureCriterion<BrittleForce<double>> && FractureCriterion<BrittleForce<float>>);

} // namespace ductile
