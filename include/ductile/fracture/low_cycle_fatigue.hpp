// SPDX-License-Identifier: MIT
//
// Break by low-cycle fatigue: every plastic half cycle of amplitude ε_a uses up 1/2N_f(ε_a) of life
// (Miner's rule), half cycles being found by rainflow counting while they run.
//
//   D = Σ settled + Σ open + running,   each half cycle adding h(range) = 1 / 2N_f(k range / 2)
//
// The half cycle that is running counts with the range it has so far, so D is a continuous function
// of the path, a monotonic overload consumes life too (from rest it breaks at the range 2ε_f'/k,
// that is amplitude ε_f' with a life of one reversal), and the break falls inside a step: the range
// at which D reaches 1 is h⁻¹(1 - Σ settled - Σ open), closed form, and one such equation per loop
// that closes on the way there.
//
// Load below yield gives no plastic increment and consumes nothing. Constant amplitude: breaks in
// reversal ⌈2N_f⌉.
//
// Symbols
//   k       strain per travel: hinge_strain, bar_strain      [1/rad | 1/m]
//   h       damage of one half cycle, at most 1              [-]
//   range   between two turning points                       [rad | m]
//   D       damage, 1 at the break                           [-]
//
// Source: Miner (1945), Cumulative damage in fatigue, J. Appl. Mech. 12, A159-A164; counting:
// rainflow.hpp; the running half cycle and its `remaining` derived here.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <utility>

#include "ductile/fracture/coffin_manson.hpp"
#include "ductile/fracture/compensated_sum.hpp"
#include "ductile/fracture/fracture.hpp"
#include "ductile/fracture/life_curve.hpp"
#include "ductile/fracture/rainflow.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile {

template <std::floating_point S>
struct LowCycleFatigueParameters {
    S strain_per_travel = std::numeric_limits<S>::quiet_NaN(); ///< k [1/rad | 1/m], > 0
};

/// Immutable value; after construction all members are noexcept and allocate nothing. An increment
/// costs a few additions; a turn or a closing loop one evaluation of the life curve per open range.
template <LifeCurve Life, std::size_t Capacity = 16>
class LowCycleFatigue : public WithoutForceCap<typename Life::Scalar>,
                        public WithoutSoftening<typename Life::Scalar> {
  public:
    using Scalar = typename Life::Scalar;
    using S = Scalar;

    struct State {
        Rainflow<S, Capacity> rainflow; ///< ranges of travel [m | rad]
        CompensatedSum<S> settled;      ///< damage of settled half cycles [-]
        S base = 0;                     ///< damage of settled and open half cycles [-]
        S reach = 1;                    ///< running range at D = 1, per that of a first loading [-]
        S floor = 0;                    ///< damage reached before the last turn or closure [-]
        bool broken = false;

        bool operator==(const State&) const = default;
    };

    /// @throws std::invalid_argument where the strain per travel is missing (NaN) or not positive.
    LowCycleFatigue(Life life, const LowCycleFatigueParameters<S>& parameters)
        : life_(std::move(life)),
          strain_per_travel_(check::positive("LowCycleFatigue.strain_per_travel",
                                             parameters.strain_per_travel, "1/rad or 1/m")),
          first_range_(2 * life_.amplitude(S(1)) / strain_per_travel_) {}

    [[nodiscard]] const Life& life() const noexcept { return life_; }
    /// k [1/rad | 1/m]
    [[nodiscard]] S strain_per_travel() const noexcept { return strain_per_travel_; }
    /// Range of travel that breaks a new part in one half cycle [m | rad].
    [[nodiscard]] S first_range() const noexcept { return first_range_; }

    /// Damage of one half cycle between turning points `range` apart, in [0, 1].
    [[nodiscard]] S half_cycle_damage(S range) const noexcept {
        return std::min(1 / life_.reversals(strain_per_travel_ * range / 2), S(1));
    }

    [[nodiscard]] S remaining(const State& state, S /*strength*/, S direction = 0) const noexcept {
        if (state.broken) return 0;
        const bool at_rest = state.rainflow.direction() == 0;
        const bool turns = state.rainflow.turns(direction);
        if (at_rest || (direction != 0 && !turns)) return onward(state);
        State turned = state;
        turn(turned);
        return turns ? onward(turned) : std::min(onward(state), onward(turned));
    }

    void update(State& state, const PlasticIncrement<S>& increment) const noexcept {
        const S step = std::abs(increment.plastic);
        if (state.broken || !(step > 0)) return;
        if (state.rainflow.turns(increment.plastic)) turn(state);
        state.broken = step >= onward(state) - exhausted_share<S> * first_range_;
        if (state.broken) return;
        const std::size_t depth = state.rainflow.depth();
        const S range = state.rainflow.running();
        state.rainflow.add(increment.plastic, settle_into(state));
        if (state.rainflow.depth() == depth) return;
        state.floor = damage_at(state, range);
        refresh(state);
    }

    [[nodiscard]] bool broken(const State& state) const noexcept { return state.broken; }
    /// D, below 1 until the break.
    [[nodiscard]] S damage(const State& state) const noexcept {
        return state.broken ? S(1) : damage_at(state, state.rainflow.running());
    }
    [[nodiscard]] CriterionKind governing(const State&) const noexcept {
        return CriterionKind::low_cycle_fatigue;
    }

  private:
    S damage_at(const State& state, S running) const noexcept {
        const S damage = std::max(state.base + half_cycle_damage(running), state.floor);
        return std::min(damage, 1 - std::numeric_limits<S>::epsilon());
    }

    auto settle_into(State& state) const noexcept {
        return [this, &state](S range, S cycles) noexcept {
            state.settled.add(2 * cycles * half_cycle_damage(range));
        };
    }

    void turn(State& state) const noexcept {
        state.floor = damage(state);
        state.rainflow.turn(settle_into(state));
        refresh(state);
    }

    /// Sums up the half cycles that no longer run.
    void refresh(State& state) const noexcept {
        state.base = state.settled.value();
        for (std::size_t i = 0; i < state.rainflow.depth(); ++i) {
            state.base += half_cycle_damage(state.rainflow.open_range(i));
        }
        const S left = std::max(1 - state.base, S(0));
        state.reach = 2 * life_.amplitude(1 / left) / strain_per_travel_ / first_range_;
    }

    /// Travel left before D = 1 within the running half cycle, were no loop to close. Never quite
    /// zero: a turn at a full stack may use up what was left, and a row must flow to break.
    S within(const State& state) const noexcept {
        return std::max(state.reach * first_range_ - state.rainflow.running(),
                        exhausted_share<S> * first_range_);
    }

    /// Travel left before D = 1 in the present direction.
    S onward(const State& state) const noexcept {
        S left = within(state);
        S gap = state.rainflow.to_closure();
        if (left <= gap) return left;
        State ahead = state;
        S travelled = 0;
        for (; left > gap; left = within(ahead), gap = ahead.rainflow.to_closure()) {
            travelled += gap;
            ahead.rainflow.run_to_closure(settle_into(ahead));
            refresh(ahead);
        }
        return travelled + left;
    }

    Life life_;
    S strain_per_travel_;
    S first_range_;
};

static_assert(FractureCriterion<LowCycleFatigue<CoffinManson<double>>> &&
              FractureCriterion<LowCycleFatigue<CoffinManson<float>>>);

} // namespace ductile
