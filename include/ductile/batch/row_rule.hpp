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

#include <bit>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "ductile/batch/status.hpp"

namespace ductile::batch_detail {

/// A flag as wide as the scalar, all bits set or none: mixed widths in a loop cost shuffles.
template <std::floating_point S>
using Mask = std::conditional_t<sizeof(S) == 4, std::uint32_t, std::uint64_t>;

template <std::floating_point S>
constexpr Mask<S> mask(bool flag) noexcept {
    return Mask<S>(0) - Mask<S>(flag);
}

/// a where `choice` is set, else b. On the bits, because a conditional would let g++ thread the
/// cases into branches again.
template <std::floating_point S>
constexpr S select(Mask<S> choice, S a, S b) noexcept {
    return std::bit_cast<S>((choice & std::bit_cast<Mask<S>>(a)) |
                            (~choice & std::bit_cast<Mask<S>>(b)));
}
/// a where `choice` is set, else +0.
template <std::floating_point S>
constexpr S only(Mask<S> choice, S a) noexcept {
    return std::bit_cast<S>(choice & std::bit_cast<Mask<S>>(a));
}
/// std::max(a, b).
template <std::floating_point S>
constexpr S larger(S a, S b) noexcept {
    return select(mask<S>(a < b), b, a);
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
        return only(mask<S>(travel < limit), limit - travel);
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
                               S velocity, S offset, S travel, S start, Mask<S> status) noexcept {
    const Mask<S> intact = mask<S>((status & outcome_bits) != Mask<S>(Outcome::broken));
    const Mask<S> flowing = mask<S>((status & flowing_bit) != 0);
    const S speed = std::abs(velocity);
    const S lost = larger(std::abs(start) - speed, S(0));
    const S slowed = only(flowing, larger(speed - lost, S(0)));
    const S ahead = (speed + slowed) / 2 * step.dt;
    const S left = law.remaining(travel);
    const Mask<S> ends = mask<S>(left < ahead);
    const S share = select(ends, left, S(1)) / select(ends, ahead, S(1));
    const S bound = law.midpoint(travel, speed, step.dt) * share;
    const S bias = (offset - position) / step.drift_time;
    return {only(intact, -bound), only(intact, bound), only(intact, bias),
            select(intact, velocity, start)};
}

/// What commit reads and writes of one joint's state.
template <std::floating_point S>
struct RowState {
    S offset, travel, plastic_work, other_work, velocity, residual_max;
    Mask<S> status;
};

template <std::floating_point S>
struct Committed {
    RowState<S> state;
    S release, residual;
};

template <std::floating_point S>
inline Committed<S> commit_row(const RowLaw<S>& law, const StepNumbers<S>& step, S force,
                               S velocity, S position, S bound, S bias, S start,
                               const RowState<S>& old) noexcept {
    const Mask<S> intact = mask<S>((old.status & outcome_bits) != Mask<S>(Outcome::broken));
    const Mask<S> was_flowing = mask<S>((old.status & flowing_bit) != 0);
    const S start_speed = std::abs(start);
    const S tolerated = step.absolute_residual + step.relative_residual * start_speed;
    const Mask<S> kicked = mask<S>(std::abs(start - old.velocity) > tolerated);
    const Mask<S> at_bound = mask<S>(std::abs(force) >= bound * at_bound_share<S>);

    const S work = -force * step.dt * (start + velocity) / 2;
    const Mask<S> flows = intact & (at_bound | was_flowing | kicked) & mask<S>(work > 0);
    const S taken = only(flows, work);
    const S strength = law.midpoint(old.travel, start_speed, step.dt);
    const S left = law.remaining(old.travel);
    const S travel = taken / strength;
    const Mask<S> breaks = flows & mask<S>(travel >= left * used_up_share<S>);
    const S release = only(breaks, larger(taken - strength * left, S(0)));
    const S plastic = taken - release;

    const S excess = velocity - bias;
    const S against = larger(select(mask<S>(force > 0), excess, -excess), S(0));
    const S residual = only(intact, select(at_bound, against, std::abs(excess)));
    const S speed = larger(start_speed, std::abs(velocity));
    const Mask<S> unreliable =
        mask<S>(residual > step.absolute_residual + step.relative_residual * speed);
    const Mask<S> yields =
        mask<S>(plastic > 0) & (at_bound | mask<S>(start_speed > step.absolute_residual));

    constexpr auto code = [](Outcome outcome) { return Mask<S>(outcome); };
    const Mask<S> whole =
        (unreliable & code(Outcome::unreliable)) | (~unreliable & yields & code(Outcome::yielding));
    const Mask<S> outcome = (breaks & code(Outcome::broken)) | (~breaks & whole);
    const Mask<S> status = outcome | (at_bound & flowing_bit);

    return {.state = {.offset = select(flows, position, old.offset),
                      .travel = select(breaks, law.limit, old.travel + travel),
                      .plastic_work = old.plastic_work + plastic,
                      .other_work = old.other_work + only(intact & ~flows, work),
                      .velocity = select(intact, velocity, old.velocity),
                      .residual_max = larger(old.residual_max, residual),
                      .status = (intact & status) | (~intact & old.status)},
            .release = release,
            .residual = residual};
}

static_assert(unsigned(Outcome::elastic) == 0); // the code left where no mask is set

} // namespace ductile::batch_detail
