// SPDX-License-Identifier: MIT
//
// What a law offers whose flow may reverse, in the two forms a joint needs:
//
//   CyclicLaw      rigid-plastic. The engine's row solves for the force inside bounds that the law
//                  gives before the step; the law is told afterwards how far the row flowed.
//   HysteresisLaw  elastic-plastic and driven by the position. It answers with the force.
//
// Laws are immutable; everything that changes is a State that its owner keeps: a plain value that
// can be copied, compared, saved and restored. No call allocates or throws.
//
// Sign. A law's force is the one that drives the flow: positive force, positive flow. The force a
// row exerts on the bodies is its opposite, so the row's limits are { -range.upper, -range.lower }.
//
// Work. Over a plastic increment Δ the bodies lose
//
//   ∫ force dΔ = dissipated + stored          dissipated >= 0, stored of either sign
//
// where `stored` is held by the law (locked in by kinematic hardening) and may come back. Δ is the
// work-conjugate increment, (u + u')/2 dt while the force is at a bound. The work W = force × Δ
// that the row really did differs from dissipated + stored by the error of the predicted midpoint,
// third order per step; it belongs in the ledger as an entry of its own. W must not be divided by
// the force to find Δ: under kinematic hardening the force at a bound can be zero.
#pragma once

#include <concepts>
#include <limits>

namespace ductile {

/// Forces between which a row does not flow [N | N m].
template <std::floating_point S>
struct ForceRange {
    S lower = 0;
    S upper = 0;

    bool operator==(const ForceRange&) const = default;
};

/// Where the work of a plastic increment went.
template <std::floating_point S>
struct FlowWork {
    S dissipated = 0; ///< >= 0 [J]
    S stored = 0;     ///< change of what the law holds, either sign [J]
};

/// - `prepare(state, predicted)`: range for a step with this predicted signed increment [m | rad],
/// at
///   the midpoint of the flow on its side, as it stands on the other
/// - `commit(state, increment)`: flows by the signed increment [m | rad]
/// - `resistance(state, travel, direction)`: signed force after flow by `travel` >= 0 in
/// `direction`
///   = ±1 [N | N m]
/// - `tangent(state, travel, direction)`: its derivative by signed flow [N/m | N m/rad]
/// - `stored(state)`: what the law holds [J]
template <class T>
concept CyclicLaw = std::regular<typename T::State> &&
    requires(const T law, typename T::State state, typename T::Scalar x) {
    requires std::floating_point<typename T::Scalar>;
    { law.prepare(state, x) } noexcept -> std::same_as<ForceRange<typename T::Scalar>>;
    { law.commit(state, x) } noexcept -> std::same_as<FlowWork<typename T::Scalar>>;
    { law.resistance(state, x, x) } noexcept -> std::same_as<typename T::Scalar>;
    { law.tangent(state, x, x) } noexcept -> std::same_as<typename T::Scalar>;
    { law.stored(state) } noexcept -> std::same_as<typename T::Scalar>;
};

/// Travel until the law has faded to nothing: infinity, but for those of hardening.hpp [m | rad].
template <CyclicLaw Law>
[[nodiscard]] constexpr typename Law::Scalar travel_to_nothing(
    const Law& /*law*/, typename Law::Scalar /*travel*/) noexcept {
    return std::numeric_limits<typename Law::Scalar>::infinity();
}

/// A CyclicLaw whose state says where the row rests, so that its flow must be that of the position.
/// - `plastic_position(state)`: position at which the force would vanish [m | rad]
template <class T>
concept RestsByItself = CyclicLaw<T> && requires(const T law, const typename T::State state) {
    { law.plastic_position(state) }
    noexcept->std::same_as<typename T::Scalar>;
};

/// What one move of a HysteresisLaw did. The work done on it is dissipated + the change of `held`.
template <std::floating_point S>
struct HysteresisStep {
    S force = 0;             ///< at the end of the move [N | N m]
    S plastic_increment = 0; ///< change of the position at which the force would vanish [m | rad]
    S dissipated = 0;        ///< >= 0 [J]
};

/// - `project(state, position)`: moves to `position` [m | rad] along a straight path and returns
/// the
///   force to the admissible set; a path without reversals may be cut into any number of moves
/// - `force(state, position)`: force of a state that was projected to `position` [N | N m]
/// - `held(state, position)`: what the law holds there, elastic and stored [J]
/// - `stiffness()`: elastic, the steepest the law can be [N/m | N m/rad]
template <class T>
concept HysteresisLaw = std::regular<typename T::State> &&
    requires(const T law, typename T::State state, typename T::Scalar position) {
    requires std::floating_point<typename T::Scalar>;
    { law.project(state, position) } noexcept -> std::same_as<HysteresisStep<typename T::Scalar>>;
    { law.force(state, position) } noexcept -> std::same_as<typename T::Scalar>;
    { law.held(state, position) } noexcept -> std::same_as<typename T::Scalar>;
    { law.stiffness() } noexcept -> std::same_as<typename T::Scalar>;
};

} // namespace ductile
