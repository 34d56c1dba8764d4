// SPDX-License-Identifier: MIT
//
// The rule of one rigid-plastic row without a branch: every case is computed and the right one
// selected, so that a compiler can run it on as many joints at once as a register holds. The rule
// is that of OneAxisJoint, where the derivation is; with floating-point contraction off
// (-ffp-contract=off) results do not depend on the compiler.
//
// A number that is not finite leaves the row without strength, and its step unbooked, as a row that
// prepare left so.
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
#include "ductile/fracture/fracture.hpp"
#include "ductile/joint/step_end.hpp"
#include "ductile/vocabulary/leftover.hpp"

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
/// Set where x is finite.
template <std::floating_point S>
constexpr Mask<S> finite(S x) noexcept {
    return mask<S>(x * 0 == 0);
}
/// std::max(a, b).
template <std::floating_point S>
constexpr S larger(S a, S b) noexcept {
    return select(mask<S>(a < b), b, a);
}

template <std::floating_point S>
constexpr Mask<S> broken(Mask<S> status) noexcept {
    return mask<S>((status & outcome_bits) == Mask<S>(Outcome::broken));
}
/// The bit above the outcome's, spread.
template <std::floating_point S>
constexpr Mask<S> flowing(Mask<S> status) noexcept {
    return Mask<S>(0) - (status / Mask<S>(flowing_bit) & Mask<S>(1));
}

/// Numbers that all joints share in a step.
template <std::floating_point S>
struct StepNumbers {
    S dt;
    S half_dt;
    S drift_rate; ///< 1/drift_time, which is not shorter than five steps [1/s]
    S absolute_residual;
    S relative_residual;
    S least_travel;
};

/// Strength of one joint.
template <std::floating_point S>
struct RowLaw {
    S strength;
    S hardening;
    S limit;

    constexpr S value(S travel) const noexcept { return strength + hardening * travel; }
    /// R half a step ahead, or of the way that is left.
    constexpr S midpoint(S travel, S speed, S half_dt) const noexcept {
        const S half = speed * half_dt, left = remaining(travel) / 2;
        return value(travel + select(mask<S>(left < half), left, half));
    }
    constexpr S remaining(S travel) const noexcept {
        return only(mask<S>(travel < limit), limit - travel);
    }
};

/// A force this close to its bound, as a share of the larger one, is at it.
template <std::floating_point S>
inline constexpr S bound_tolerance = S(4e-6);
/// This share of what a step may use up counts as all of it, and of a limit as the limit.
template <std::floating_point S>
inline constexpr S used_up_share = 1 - leftover_share<S>;
template <std::floating_point S>
inline constexpr S exhausted = 1 - exhausted_share<S>;

template <std::floating_point S>
struct Prepared {
    S lower, upper, bias, start_velocity;
};

template <std::floating_point S>
[[gnu::always_inline]] inline Prepared<S> prepare_row(const RowLaw<S>& law,
                                                      const StepNumbers<S>& step, S position,
                                                      S velocity, S offset, S travel, S start,
                                                      S last_velocity, Mask<S> status) noexcept {
    const Mask<S> intact = ~broken<S>(status) & finite(velocity) & finite(position);
    const S speed = std::abs(velocity);
    const S lost = larger(std::abs(start) - std::abs(last_velocity), S(0));
    const S slowed = only(flowing<S>(status), larger(speed - lost, S(0)));
    const S ahead = (speed + slowed) * step.half_dt;
    const S left = law.remaining(travel);
    const Mask<S> ends = mask<S>(left < ahead);
    const S share = select(ends, left, S(1)) / select(ends, ahead, S(1));
    // half a step ahead on the side of the flow, as it stands on the other
    const S along = law.midpoint(travel, speed, step.half_dt) * share;
    const S against = law.value(travel) * share;
    const Mask<S> back = mask<S>(velocity < 0);
    const S bias = (offset - position) * step.drift_rate;
    return {only(intact, -select(back, against, along)), only(intact, select(back, along, against)),
            only(intact, bias), select(intact, velocity, start)};
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
[[gnu::always_inline]] inline Committed<S> commit_row(const RowLaw<S>& law,
                                                      const StepNumbers<S>& step, S force,
                                                      S velocity, S position, S lower, S upper,
                                                      S bias, S start,
                                                      const RowState<S>& old) noexcept {
    const Mask<S> whole = ~broken<S>(old.status);
    const S start_speed = std::abs(start);
    const S tolerated = step.absolute_residual + step.relative_residual * start_speed;
    const Mask<S> kicked = mask<S>(std::abs(start - old.velocity) > tolerated);
    const S ahead = law.midpoint(old.travel, start_speed, step.half_dt);
    const S behind = law.value(old.travel);
    const S near = bound_tolerance<S> * larger(upper, -lower);
    const Mask<S> at_upper = mask<S>(force >= upper - near);
    const Mask<S> at_lower = mask<S>(force <= lower + near);
    const Mask<S> at_bound = at_upper | at_lower;

    const S moved = (start + velocity) * step.half_dt;
    const S work = -(force * moved);
    const Mask<S> sound = finite(work) & finite(position) & mask<S>(lower < upper);
    const Mask<S> intact = whole & sound;
    const S excess = velocity - bias;
    const S too_fast = only(at_upper | ~at_lower, excess); // at the lower bound it may be
    const S too_slow = only(~at_upper, -excess);
    const S residual =
        only(whole, select(sound, larger(too_fast, too_slow), std::numeric_limits<S>::infinity()));
    const S speed = larger(start_speed, std::abs(velocity));
    // what the solver left undone is nobody's flow: no travel, no life, no break
    const S allowed = step.absolute_residual + step.relative_residual * speed;
    const Mask<S> unsolved = ~sound | ~mask<S>(residual <= allowed);

    // a row at its bound flows where it moves the way the bound resists, and so does one brought to
    // rest: both take work
    const Mask<S> settles = at_bound | flowing<S>(old.status) | kicked;
    const Mask<S> flows = intact & settles & ~unsolved & mask<S>(work > 0);
    const S strength =
        select(mask<S>(moved * start < 0), behind, ahead); // turned round: as it stood
    const S left = law.remaining(old.travel);
    // what the work amounts to; a force beyond its bound flows no further than the bound
    const S bounded = select(at_upper, upper, select(at_lower, lower, force));
    const S wanted = only(flows, std::abs(bounded * moved) / strength);
    const Mask<S> used_up = mask<S>(wanted >= left * used_up_share<S>);
    const S travel = select(flows & used_up, left, wanted);
    const Mask<S> breaks = flows & mask<S>(old.travel + travel >= law.limit * exhausted<S>);
    const S plastic = (behind + law.hardening / 2 * travel) * travel;
    const S rest = work - plastic; // without flow no travel, and all work is other work
    const S release = only(breaks, larger(rest, S(0)));
    const S other = rest - release;

    const S other_work = old.other_work + only(intact, other);
    const S taken = old.plastic_work + plastic + strength * step.least_travel;
    const S owed = allowed_gain<S> * taken + owed_steps<S> * (strength * speed * step.dt);
    const Mask<S> gains = mask<S>(-other > noticed_gain<S> * -other_work) &
                          mask<S>(other_work < 0) & mask<S>(-other_work > owed);
    const Mask<S> unreliable = gains | unsolved;
    const Mask<S> yields = flows & (at_bound | mask<S>(start_speed > step.absolute_residual));

    // elastic 0, yielding 1, broken 2, unreliable 3
    const Mask<S> outcome =
        ((unreliable | yields) & ~breaks & Mask<S>(1)) | ((unreliable | breaks) & Mask<S>(2));
    const Mask<S> begins = mask<S>(plastic > 0) & mask<S>(!(old.plastic_work > 0));
    const Mask<S> ended = (sound & at_bound) | (~sound & flowing<S>(old.status));
    const Mask<S> status =
        outcome | (ended & flowing_bit) | (begins & first_yield_bit) | (breaks & fracture_bit);

    return {
        .state = {.offset = select(intact & ~unsolved & (at_bound | flows), position, old.offset),
                  .travel = old.travel + travel,
                  .plastic_work = old.plastic_work + plastic,
                  .other_work = other_work,
                  .velocity = select(intact, velocity, old.velocity),
                  .residual_max = larger(old.residual_max, only(sound, residual)),
                  .status = (whole & status) |
                            (~whole & old.status & ~Mask<S>(first_yield_bit | fracture_bit))},
        .release = release,
        .residual = residual};
}

// as commit_row puts outcomes together bit by bit
static_assert(unsigned(Outcome::elastic) == 0 && unsigned(Outcome::yielding) == 1 &&
              unsigned(Outcome::broken) == 2 && unsigned(Outcome::unreliable) == 3);

} // namespace ductile::batch_detail
