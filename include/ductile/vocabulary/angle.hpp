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

} // namespace ductile
