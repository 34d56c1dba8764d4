// SPDX-License-Identifier: MIT
//
// The elastic-plastic form of any CyclicLaw: a spring of stiffness k in series with the flow.
// Driven by the position, it returns the force to the admissible range by the exact flow along the
// way.
//
//   F = k (q - q_p);   if F leaves [x - R, x + R]:  find δ with  s F_trial - k δ = s resistance(δ)
//
// Symbols ("x | y": translational row | rotational row)
//   q, q_p   position and plastic rest position  [m | rad]
//   k        elastic stiffness                   [N/m | N m/rad]
//   δ, s     travel and direction of the flow    [m | rad], ±1
//
// The equation has one unknown and a known bracket; Newton inside it is exact in one step for
// linear hardening and ends always. A path without reversals may be cut into any moves with the
// same result.
//
// Softening steeper than k has several roots (snap-back): one is taken and the force never leaves
// the admissible range. What the spring then sets free, work done - dissipated - change of held, is
// lost to the law; a joint hands it to the bodies.
//
// Limit cases: k → ∞ the rigid-plastic law; R → ∞ an elastic spring.
//
// Source: Simo and Hughes (1998), Computational Inelasticity, section 1.4 (return mapping in one
// dimension); bracket derived here from the back force never moving against the flow.
#pragma once

#include <algorithm>
#include <concepts>
#include <utility>

#include "ductile/law/cyclic.hpp"
#include "ductile/law/hardening.hpp"
#include "ductile/law/root.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile {

/// What an elastic-plastic row remembers. Plain value.
template <class FlowState, std::floating_point S>
struct UniaxialReturnState {
    S plastic_offset = 0; ///< q_p [m | rad]
    FlowState flow{};     ///< of the cyclic law

    bool operator==(const UniaxialReturnState&) const = default;
};

/// Immutable value; noexcept after construction.
template <CyclicLaw Law>
class UniaxialReturn {
  public:
    using Scalar = typename Law::Scalar;
    using State = UniaxialReturnState<typename Law::State, Scalar>;

    /// `stiffness` k [N/m | N m/rad].
    /// @throws std::invalid_argument where the stiffness is NaN, infinite or not positive.
    UniaxialReturn(Scalar stiffness, Law law)
        : stiffness_(check::positive("UniaxialReturn.stiffness", stiffness, "N/m or N m/rad")),
          law_(std::move(law)) {}

    [[nodiscard]] const Law& law() const noexcept { return law_; }
    [[nodiscard]] Scalar stiffness() const noexcept { return stiffness_; }

    HysteresisStep<Scalar> project(State& state, Scalar position) const noexcept {
        const Scalar trial = force(state, position);
        const Scalar upper = law_.resistance(state.flow, Scalar(0), Scalar(1));
        const Scalar lower = law_.resistance(state.flow, Scalar(0), Scalar(-1));
        if (trial <= upper && trial >= lower) return {.force = trial};

        const Scalar direction = trial > upper ? Scalar(1) : Scalar(-1);
        const Scalar increment = direction * travel(state, trial, (upper + lower) / 2, direction);
        state.plastic_offset += increment;
        const FlowWork<Scalar> work = law_.commit(state.flow, increment);
        return {.force = force(state, position),
                .plastic_increment = increment,
                .dissipated = work.dissipated};
    }

    [[nodiscard]] Scalar force(const State& state, Scalar position) const noexcept {
        return stiffness_ * (position - state.plastic_offset);
    }
    /// Elastic energy of the spring [J].
    [[nodiscard]] Scalar elastic(const State& state, Scalar position) const noexcept {
        return force(state, position) * (position - state.plastic_offset) / 2;
    }
    [[nodiscard]] Scalar held(const State& state, Scalar position) const noexcept {
        return elastic(state, position) + law_.stored(state.flow);
    }

  private:
    /// δ: the excess over the resistance is positive at 0 and not positive at the end of the
    /// bracket, where the spring alone would have come down to the centre of the range.
    Scalar travel(const State& state, Scalar trial, Scalar centre,
                  Scalar direction) const noexcept {
        const auto excess = [&](Scalar distance) noexcept {
            const Scalar held_by_law = law_.resistance(state.flow, distance, direction);
            return ValueAndSlope<Scalar>{
                direction * (trial - held_by_law) - stiffness_ * distance,
                -law_.tangent(state.flow, distance, direction) - stiffness_};
        };
        const Scalar most = direction * (trial - centre) / stiffness_;
        const ValueAndSlope<Scalar> now = excess(Scalar(0));
        return newton_root(Scalar(0), most, std::clamp(-now.value / now.slope, Scalar(0), most),
                           excess);
    }

    Scalar stiffness_;
    Law law_;
};

static_assert(HysteresisLaw<UniaxialReturn<IsotropicHardening<Perfect<float>>>>);
static_assert(HysteresisLaw<UniaxialReturn<KinematicHardening<double>>>);

} // namespace ductile
