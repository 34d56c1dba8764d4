// SPDX-License-Identifier: MIT
//
// Angles without wrap. An engine reports a hinge angle in (-π, π]; a plastic hinge may turn many
// times. The branch is chosen by a prediction, so a step may turn the hinge by any angle as long as
// the prediction is within π of the truth.
#pragma once

#include <cmath>
#include <concepts>
#include <numbers>

namespace ductile {

/// The angle equal to `measured` modulo 2π that lies nearest to `predicted`. [rad]
template <std::floating_point Scalar>
[[nodiscard]] Scalar unwrap(Scalar measured, Scalar predicted) noexcept {
    constexpr Scalar turn = 2 * std::numbers::pi_v<Scalar>;
    return measured + turn * std::round((predicted - measured) / turn);
}

/// Turn of a step up to which no engine's rule for it differs much from another [rad].
template <std::floating_point Scalar>
inline constexpr Scalar small_turn = Scalar(0.5);

/// Share of a step's turn by which an engine's rule may miss it [-].
template <std::floating_point Scalar>
inline constexpr Scalar allowed_miss = Scalar(0.04);

/// True where a joint that turned on by `due` = velocity × step was seen to turn by `seen`: its
/// engine cuts fast turns, or it went round unseen. [rad]
template <std::floating_point Scalar>
[[nodiscard]] bool turned_otherwise(Scalar due, Scalar seen) noexcept {
    return std::abs(due) > small_turn<Scalar> &&
           std::abs(seen - due) > allowed_miss<Scalar> * std::abs(due);
}

} // namespace ductile
