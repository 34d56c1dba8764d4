// SPDX-License-Identifier: MIT
//
// The rule of one rigid-plastic row without a branch: every case is computed and the right one
// selected, so that a compiler can run it on as many joints at once as a register holds. Same
// operations in the same order as OneAxisJoint, where the derivation is; with floating-point
// contraction off (-ffp-contract=off) the results are the same bit for bit.
//
// A quotient whose case is not selected is taken with the divisor 1, so that no division by zero
// raises a floating-point exception.
#pragma once

#include <concepts>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "ductile/batch/status.hpp"

namespace ductile::batch_detail {

/// Flags as wide as the scalar: mixed widths in a loop cost shuffles.
template <std::floating_point S>
using Flags = std::conditional_t<sizeof(S) == 4, std::uint32_t, std::uint64_t>;

/// a where `choice`, else b; both are computed.
template <class T>
constexpr T select(bool choice, T a, T b) noexcept {
    return choice ? a : b;
}
template <class T>
constexpr T larger(T a, T b) noexcept {
    return select(a < b, b, a);
}

/// Numbers that all joints share in a step.
template <std::floating_point S>
struct StepNumbers {
    S dt;
    S drift_time; ///< not shorter than five steps [s]
    S absolute_residual;
    S relative_residual;
};

/// Strength of one joint.
template <std::floating_point S>
struct RowLaw {
    S strength;
    S hardening;
    S limit;

    /// R half a step ahead.
    constexpr S midpoint(S travel, S speed, S dt) const noexcept {
        return strength + hardening * (travel + speed * dt / 2);
    }
    constexpr S remaining(S travel) const noexcept {
        return select(travel < limit, limit - travel, S(0));
    }
};

/// A force this close to its bound is at it.
template <std::floating_point S>
inline constexpr S at_bound_share = 1 - S(4e-6);
/// Less travel than this share of what is left counts as all of it.
template <std::floating_point S>
inline constexpr S used_up_share = 1 - 16 * std::numeric_limits<S>::epsilon();

template <std::floating_point S>
struct Prepared {
    S lower, upper, bias, start_velocity;
};

template <std::floating_point S>
inline Prepared<S> prepare_row(const RowLaw<S>& law, const StepNumbers<S>& step, S position,
                               S velocity, S offset, S travel, S start, Flags<S> status) noexcept {
    const bool broken = (status & outcome_bits) == Flags<S>(Outcome::broken);
    const S speed = std::abs(velocity);
    const S lost = larger(std::abs(start) - speed, S(0));
    const S slowed = select((status & flowing_bit) != 0, larger(speed - lost, S(0)), S(0));
    const S ahead = (speed + slowed) / 2 * step.dt;
    const S left = law.remaining(travel);
    const bool ends = left < ahead;
    const S share = select(ends, left, S(1)) / select(ends, ahead, S(1));
    const S bound = select(broken, S(0), law.midpoint(travel, speed, step.dt) * share);
    const S bias = (offset - position) / step.drift_time;
    return {-bound, bound, select(broken, S(0), bias), select(broken, start, velocity)};
}

/// What commit reads and writes of one joint's state.
template <std::floating_point S>
struct RowState {
    S offset, travel, plastic_work, other_work, velocity, residual_max;
    Flags<S> status;
};

template <std::floating_point S>
struct Committed {
    RowState<S> state;
    S release, residual;
};

template <std::floating_point S>
inline Committed<S> commit_row(const RowLaw<S>& law, const StepNumbers<S>& step, S force, S velocity,
                               S position, S bound, S bias, S start,
                               const RowState<S>& old) noexcept {
    const bool was_broken = (old.status & outcome_bits) == Flags<S>(Outcome::broken);
    const S start_speed = std::abs(start);
    const S work = -force * step.dt * (start + velocity) / 2;
    const bool at_bound = std::abs(force) >= bound * at_bound_share<S>;
    const bool was_flowing = (old.status & flowing_bit) != 0;
    const bool kicked = std::abs(start - old.velocity) >
                        step.absolute_residual + step.relative_residual * start_speed;
    const bool flows = (at_bound | was_flowing | kicked) & (work > 0);

    const S taken = select(flows, work, S(0));
    const S strength = law.midpoint(old.travel, start_speed, step.dt);
    const S left = law.remaining(old.travel);
    const S travel = taken / strength;
    const bool breaks = flows & (travel >= left * used_up_share<S>);
    const S release = select(breaks, larger(taken - strength * left, S(0)), S(0));
    const S plastic = taken - release;

    const S excess = velocity - bias;
    const S ahead = larger(select(force > 0, excess, -excess), S(0));
    const S residual = select(at_bound, ahead, std::abs(excess));
    const S speed = larger(start_speed, std::abs(velocity));
    const bool unreliable =
        residual > step.absolute_residual + step.relative_residual * speed;
    const bool yields = (plastic > 0) & (at_bound | (start_speed > step.absolute_residual));

    const Flags<S> outcome =
        select(breaks, Flags<S>(Outcome::broken),
               select(unreliable, Flags<S>(Outcome::unreliable),
                      select(yields, Flags<S>(Outcome::yielding), Flags<S>(Outcome::elastic))));
    const Flags<S> flag = select(at_bound, Flags<S>(flowing_bit), Flags<S>(0));

    Committed<S> now;
    now.state.offset = select(was_broken | !flows, old.offset, position);
    const S after = select(breaks, law.limit, old.travel + travel);
    now.state.travel = select(was_broken | !flows, old.travel, after);
    now.state.plastic_work = select(was_broken, old.plastic_work, old.plastic_work + plastic);
    now.state.other_work =
        select(was_broken, old.other_work, old.other_work + select(flows, S(0), work));
    now.state.velocity = select(was_broken, old.velocity, velocity);
    now.state.residual_max =
        select(was_broken, old.residual_max, larger(old.residual_max, residual));
    now.state.status = select(was_broken, old.status, Flags<S>(outcome | flag));
    now.release = select(was_broken, S(0), release);
    now.residual = select(was_broken, S(0), residual);
    return now;
}

} // namespace ductile::batch_detail
