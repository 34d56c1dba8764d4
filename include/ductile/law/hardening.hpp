// SPDX-License-Identifier: MIT
//
// Hardening under reversal: a strength that follows the accumulated travel (isotropic: the elastic
// range grows) and a back force that follows the signed flow (kinematic: it moves), alone or mixed.
//
//   x - R(p) <= force <= x + R(p),    dp = |du_p|
//
//   IsotropicHardening<Law>   any StrengthLaw, x = 0
//   KinematicHardening<S>     constant R, Prager's x
//   Hardening<Law, Back>      mixed, any of the two together
//
// Symbols ("x | y": translational row | rotational row)
//   p    accumulated plastic travel     [m | rad]
//   x    back force, centre of the range [N | N m]
//   R    strength, half width            [N | N m]
//   u_p  signed plastic displacement     [m | rad]
//
// Work of an increment: ∫ R dp and what the back force loses are dissipated, the change of what the
// back force holds is stored. With x > R the range does not hold zero: a row left alone then flows
// back and returns part of what is stored, as a Bauschinger loop must.
//
// Limit cases: no back force, the joint's isotropic law; R constant and no back force, perfect
// plasticity; R → 0 with Prager, an elastic spring of stiffness H.
//
// Source: Simo and Hughes (1998), Computational Inelasticity, section 1.2; Prager (1956).
#pragma once

#include <cmath>
#include <concepts>
#include <utility>

#include "ductile/law/back_force.hpp"
#include "ductile/law/cyclic.hpp"
#include "ductile/law/law.hpp"
#include "ductile/law/perfect.hpp"

namespace ductile {

/// What hardening remembers. Plain value.
template <std::floating_point S>
struct HardeningState {
    S plastic_travel = 0; ///< p, never decreases [m | rad]
    S back_force = 0;     ///< x [N | N m]

    bool operator==(const HardeningState&) const = default;
};

/// Immutable value; O(1) and noexcept after construction.
template <StrengthLaw Law, BackForceLaw Back = NoBackForce<typename Law::Scalar>>
    requires std::same_as<typename Law::Scalar, typename Back::Scalar>
class Hardening {
  public:
    using Scalar = typename Law::Scalar;
    using State = HardeningState<Scalar>;

    explicit Hardening(Law law, Back back = {}) : law_(std::move(law)), back_(std::move(back)) {}

    [[nodiscard]] const Law& law() const noexcept { return law_; }
    [[nodiscard]] const Back& back() const noexcept { return back_; }

    /// Range for a step with the predicted signed increment [m | rad].
    [[nodiscard]] ForceRange<Scalar> prepare(const State& state, Scalar predicted) const noexcept {
        const Scalar along = strength_ahead(law_, state.plastic_travel, std::abs(predicted));
        const Scalar back = law_.value(state.plastic_travel); // against the flow: as it stands
        const Scalar moved = back_.shifted(state.back_force, predicted / 2);
        return {.lower = predicted < 0 ? moved - along : state.back_force - back,
                .upper = predicted > 0 ? moved + along : state.back_force + back};
    }

    /// Flows by the signed increment [m | rad].
    FlowWork<Scalar> commit(State& state, Scalar increment) const noexcept {
        const Scalar travel = state.plastic_travel + std::abs(increment);
        const Scalar before = stored(state);
        FlowWork<Scalar> work;
        // after much travel the difference of two travels has lost digits that the increment still has;
        // the mean has not
        work.dissipated = mean_strength(law_, state.plastic_travel, travel) * std::abs(increment) +
                          back_.dissipated(state.back_force, increment);
        state.plastic_travel = travel;
        state.back_force = back_.shifted(state.back_force, increment);
        work.stored = stored(state) - before;
        return work;
    }

    /// Signed force after flow by `travel` >= 0 in `direction` = ±1 [N | N m].
    [[nodiscard]] Scalar resistance(const State& state, Scalar travel,
                                    Scalar direction) const noexcept {
        return back_.shifted(state.back_force, direction * travel) +
               direction * law_.value(state.plastic_travel + travel);
    }
    /// Derivative of the resistance by signed flow [N/m | N m/rad].
    [[nodiscard]] Scalar tangent(const State& state, Scalar travel,
                                 Scalar direction) const noexcept {
        return back_.slope(back_.shifted(state.back_force, direction * travel), direction) +
               law_.slope(state.plastic_travel + travel);
    }

    /// Held by the back force [J].
    [[nodiscard]] Scalar stored(const State& state) const noexcept {
        return back_.stored(state.back_force);
    }

  private:
    Law law_;
    [[no_unique_address]] Back back_;
};

template <StrengthLaw Law>
using IsotropicHardening = Hardening<Law>;

/// As that of its strength: without a back force nothing is left beside it [m | rad].
template <StrengthLaw Law>
[[nodiscard]] typename Law::Scalar travel_to_nothing(const IsotropicHardening<Law>& law,
                                                     typename Law::Scalar travel) noexcept {
    return travel_to_nothing(law.law(), travel);
}

template <std::floating_point S>
using KinematicHardening = Hardening<Perfect<S>, Prager<S>>;

/// A law as a joint uses it: a strength that follows the accumulated travel becomes isotropic
/// hardening, a law with a memory of its own stays as it is.
template <class Law>
struct CyclicForm {
    using type = Law;
};
template <StrengthLaw Law>
struct CyclicForm<Law> {
    using type = IsotropicHardening<Law>;
};

static_assert(CyclicLaw<IsotropicHardening<Perfect<float>>>);
static_assert(CyclicLaw<KinematicHardening<double>>);
static_assert(CyclicLaw<Hardening<Perfect<double>, ArmstrongFrederick<double>>>);

} // namespace ductile
