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
#include <limits>
#include <utility>

#include "ductile/fracture/fracture.hpp"
#include "ductile/law/law.hpp"
#include "ductile/law/root.hpp"
#include "ductile/vocabulary/leftover.hpp"

namespace ductile {

/// Mean over the coming `travel` >= 0 [m | rad] of what a criterion leaves of the strength,
/// weighted by that strength: `at(way)` [N | N m] is what it would be after the first `way` [-].
template <FractureCriterion Criterion, class Strength>
[[nodiscard]] typename Criterion::Scalar mean_factor(const Criterion& criterion,
                                                     const typename Criterion::State& state,
                                                     typename Criterion::Scalar travel,
                                                     Strength&& at) noexcept {
    using S = typename Criterion::Scalar;
    const S now = criterion.strength_factor(state, S(0));
    if (criterion.strength_factor(state, travel) == now) return now; // it never grows
    constexpr int pieces = 24; // of two points of Gauss: exact but for the piece of a kink
    constexpr S beside = S(0.28867513459481287); // of the middle, 1/√12
    S softened = 0, whole = 0;
    for (int i = 0; i < 2 * pieces; ++i) {
        const S way = travel * (S(i / 2) + S(0.5) + (i % 2 ? beside : -beside)) / pieces;
        const S strength = at(way);
        softened += strength * criterion.strength_factor(state, way);
        whole += strength;
    }
    return whole > 0 ? softened / whole : S(0);
}

/// Plastic travel that a criterion leaves; where that ends within the way `ahead` >= 0, at the
/// strength of the way to there alone: `mean(way)` is that of the first `way` [m | rad].
template <FractureCriterion Criterion, class Mean>
[[nodiscard]] typename Criterion::Scalar travel_to_break(const Criterion& criterion,
                                                         const typename Criterion::State& state,
                                                         typename Criterion::Scalar ahead,
                                                         typename Criterion::Scalar direction,
                                                         Mean&& mean) noexcept {
    using S = typename Criterion::Scalar;
    S before = ahead, way = criterion.remaining(state, mean(before), direction);
    if (!(way > 0 && way < ahead)) return way;
    S off_before = way - before;
    constexpr int enough = 12;
    for (int i = 0; i < enough; ++i) { // secants
        const S left = criterion.remaining(state, mean(way), direction), off = left - way;
        if (std::abs(off) <= leftover_share<S> * way) break;
        const S slope = (off - off_before) / (way - before);
        before = std::exchange(way, std::min(slope < 0 ? way - off / slope : left, ahead));
        off_before = off;
        if (!(way > 0) || way == before) return left;
    }
    return way;
}

/// Travel that takes `work` > 0 [J]: `took(way)` [J] is what the first `way` takes, `at(way)` the
/// strength after it. From `first` > 0 on; no more than `left`, and twice `first` where nothing
/// ends it [m | rad].
template <std::floating_point S, class Took, class At>
[[nodiscard]] S travel_of_work(S work, S first, S left, Took&& took, At&& at) noexcept {
    S most = first;
    if (took(first) < work) {
        most = left < std::numeric_limits<S>::infinity() ? left : 2 * first;
        if (!(took(most) > work)) return most;
    }
    const S enough = leftover_share<S> * work;
    return newton_root(S(0), most, std::min(first, most), [&](S way) noexcept {
        const S lacking = work - took(way);
        return ValueAndSlope<S>{std::abs(lacking) <= enough ? S(0) : lacking, -at(way)};
    });
}

/// Travel of a step that starts at `speed`, predicted from below, so that a step that can break
/// does break: with the speed that the last step took, `before` less `after`, where the joint
/// flowed in it, else with a stop inside this one. What somebody gave back between the steps, a
/// driver or a kick, is not in it. All along the motion [m | rad, m/s | rad/s].
template <std::floating_point S>
[[nodiscard]] S travel_ahead(S speed, S before, S after, bool flowing, S dt) noexcept {
    const S lost = std::max(before - after, S(0));
    const S slowed = flowing ? std::max(speed - lost, S(0)) : S(0);
    return (speed + slowed) / 2 * dt;
}

/// Share of the full strength that uses up the travel `left` in a step of the travel `ahead`, in
/// (0, 1].
template <std::floating_point S>
[[nodiscard]] S unspent_share(S left, S ahead) noexcept {
    return left < ahead ? left / ahead : S(1);
}

/// True where a law has faded to nothing after `travel`, but for the round-off of sums.
template <class Law>
[[nodiscard]] bool faded(const Law& law, typename Law::Scalar travel) noexcept {
    return travel_to_nothing(law, travel) <= leftover_share<typename Law::Scalar> * travel;
}

/// True where `travel` uses up what is `left` of a life, but for the round-off of sums.
template <std::floating_point S>
[[nodiscard]] bool uses_up(S travel, S left) noexcept {
    return travel >= left * (1 - leftover_share<S>);
}

/// Below this share of its strength a joint carries nothing; what it would have flowed in a step
/// ends it then, whatever part of that is booked (world/share_work.hpp): a part of what is left,
/// step after step, has no end [-].
template <std::floating_point S>
inline constexpr S carries_nothing = S(0.01);

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
