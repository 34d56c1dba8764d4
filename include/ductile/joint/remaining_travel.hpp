// SPDX-License-Identifier: MIT
//
// The travel that a joint has left before it breaks: by how much the bounds are lowered so that a
// step uses up no more, and when within the step it was used up.
//
// Time of a break. The row starts the step at speed u and would lose speed at the rate d under its
// full strength; its bounds were lowered to the share s of that, and it ended at u', so d = (u -
// u')/(s dt). What the step had left, the distance x, is run through after
//
//   u τ - d τ²/2 = x   <=>   τ = 2 x/(u + √(u² - 2 d x)),
//
// where the root is the speed at the break. Exact for a row of constant strength that moves alone;
// where a load acts as well its share of d is a little wrong, which moves τ by O(dt²).
//
// Symbols as in one_axis_joint.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>

namespace ductile {

/// Share of the full strength that uses up the travel `left` in a step that starts at `speed`, in
/// (0, 1]. The travel of the step is predicted from below, so that a step that can break does
/// break: with the deceleration since the start of the last step, at `before`, where the joint
/// flowed in it, else with a stop inside this one. All along the motion [m | rad, m/s | rad/s].
template <std::floating_point S>
[[nodiscard]] S unspent_share(S left, S speed, S before, bool flowing, S dt) noexcept {
    const S lost = std::max(before - speed, S(0));
    const S slowed = flowing ? std::max(speed - lost, S(0)) : S(0);
    const S travel = (speed + slowed) / 2 * dt;
    return left < travel ? left / travel : S(1);
}

/// Time from the start of the step until `distance` x is run through, in [0, dt] [s]; u, u' along
/// the motion [m/s | rad/s], s in (0, 1].
template <std::floating_point S>
[[nodiscard]] S time_to_run(S distance, S start, S end, S share, S dt) noexcept {
    if (!(distance > 0)) return 0;
    const S loss = (start - end) / (share * dt);
    const S sum = start + std::sqrt(std::max(start * start - 2 * loss * distance, S(0)));
    return 2 * distance < sum * dt ? 2 * distance / sum : dt;
}

} // namespace ductile
