// SPDX-License-Identifier: MIT
//
// Rainflow counting as a stream: finds the closed hysteresis loops in a history of increments, with
// a stack of fixed size and no look at the past.
//
// A half cycle is the range between two neighbouring turning points. The history lies before us as
// settled cycles, a stack of open half cycles with strictly decreasing ranges, and the running one:
//
//   a ──z── b ──y── c ──r── x        z > y on the stack, r running from c to the present x
//
// When r reaches y,
//   - the loop b-c closes: y is settled as one cycle, and the running half cycle goes on from a,
//     its range being z - y + r, as if the small loop had never been (memory);
//   - with no z below, y holds the start of the history: it is settled as half a cycle, and the
//     stack is empty.
// The rest, half a cycle per open range and one for the running range, is the residue. Since it is
// carried along, any sum of an increasing function of range over all of them is continuous in the
// path and never decreases, and depends neither on how the increments are split nor on their sign
// as a whole.
//
// Only ranges are kept, not positions, so a ratcheting mean costs no digits.
//
// Full stack. A turn that finds no room first takes two neighbouring open ranges y > r that differ
// least, and counts as if the history had gone on from the end of r to the level where y began, and
// back, before the half cycle s that follows:
//
//   y, r, s  ->  one whole cycle of y is settled, and y - r + s stays open
//
// This is the exact count of a history with that excursion added, so for every function that
// increases with the range it never falls below the true count. Where that function is convex, the
// excess of one such turn is at most one cycle of y less one of r. 16 open ranges hold a random
// walk of 10⁵ turns; white noise of that length asks for about 2 ln 10⁵ = 23, and 16 count the sum
// of range^1.67 about 0.05 % too high.
//
// Source: ASTM E1049-85, section 5.4.4 (rainflow): same ranges and counts; as a stack after
// Downing & Socie (1982), Simple rainflow counting algorithms, Int. J. Fatigue 4, 31-40,
// doi:10.1016/0142-1123(82)90018-4. Full stack derived here.
//
// Symbols: range in the unit of the increments, cycles 1 or 1/2 [-].
#pragma once

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "ductile/fracture/compensated_sum.hpp"

namespace ductile {

/// Plain value. `Settle` is called as settle(range, cycles) for what will not change any more.
/// Amortised O(1) per
/// increment, O(Capacity) for a turn at a full stack; no allocation.
template <std::floating_point S, std::size_t Capacity = 16>
class Rainflow {
    static_assert(Capacity >= 2);

  public:
    using Scalar = S;

    /// Adds a signed increment; zero and NaN change nothing.
    template <class Settle>
    void add(S increment, Settle&& settle) noexcept {
        const S step = std::abs(increment);
        if (!(step > 0)) return;
        if (turns(increment)) turn(settle);
        direction_ = increment > 0 ? 1 : -1;
        running_.add(step);
        while (depth_ > 0 && running() >= top()) close(settle);
    }

    /// True where this increment runs against the present direction.
    [[nodiscard]] bool turns(S increment) const noexcept { return S(direction_) * increment < 0; }

    /// Ends the running half cycle; what follows runs the other way. Nothing before the first
    /// increment.
    template <class Settle>
    void turn(Settle&& settle) noexcept {
        if (direction_ == 0) return;
        direction_ = std::int8_t(-direction_);
        if (depth_ == Capacity && make_room(settle)) return;
        range_[depth_++] = running();
        running_ = {};
    }

    /// Increment in the present direction that closes the next loop; infinity where none is open.
    [[nodiscard]] S to_closure() const noexcept {
        return depth_ > 0 ? top() - running() : std::numeric_limits<S>::infinity();
    }
    /// Runs on to the next closure, exactly. Requires an open range.
    template <class Settle>
    void run_to_closure(Settle&& settle) noexcept {
        running_ = {.sum = top()};
        close(settle);
    }

    [[nodiscard]] S running() const noexcept { return running_.value(); } ///< range so far
    [[nodiscard]] std::size_t depth() const noexcept { return depth_; }   ///< open ranges stacked
    [[nodiscard]] S open_range(std::size_t i) const noexcept { return range_[i]; } ///< i < depth()
    [[nodiscard]] int direction() const noexcept { return direction_; } ///< -1, 0 (at rest yet), 1

    /// Calls visit(range, 1/2) for every open range and the running one.
    template <class Visit>
    void residue(Visit&& visit) const noexcept {
        for (std::size_t i = 0; i < depth_; ++i) visit(range_[i], S(0.5));
        if (running() > 0) visit(running(), S(0.5));
    }

    bool operator==(const Rainflow&) const = default;

  private:
    S top() const noexcept { return range_[depth_ - 1]; }

    template <class Settle>
    void close(Settle& settle) noexcept {
        if (depth_ > 1) {
            settle(top(), S(1));
            running_.add(-top());
            running_.add(range_[depth_ - 2]);
            clear(2);
        } else {
            settle(top(), S(0.5));
            clear(1);
        }
    }
    /// Merges three half cycles of a full stack into one. True where the last of the three is the
    /// one that now begins, so that the turn needs no room any more.
    template <class Settle>
    bool make_room(Settle& settle) noexcept {
        std::size_t k = 1;
        S least = std::numeric_limits<S>::infinity();
        for (std::size_t i = 1; i < depth_; ++i) {
            const S difference = range_[i] - half_cycle(i + 1);
            if (difference < least) {
                least = difference;
                k = i;
            }
        }
        settle(range_[k], S(1));
        if (k + 1 == depth_) {
            running_ = {.sum = least};
            clear(1);
            return true;
        }
        const S merged = range_[k] - (range_[k + 1] - half_cycle(k + 2));
        if (k + 2 == depth_) {
            running_ = {.sum = merged};
        } else {
            range_[k] = merged;
            for (std::size_t i = k + 3; i < depth_; ++i) range_[i - 2] = range_[i];
        }
        clear(2);
        return false;
    }
    /// The open ranges from the oldest, and the running one as the last.
    S half_cycle(std::size_t i) const noexcept { return i < depth_ ? range_[i] : running(); }

    /// Popped entries are zeroed so that equal histories are equal values.
    void clear(std::uint8_t count) noexcept {
        for (; count > 0; --count) range_[--depth_] = 0;
    }

    std::array<S, Capacity> range_{}; ///< strictly decreasing up to depth_
    CompensatedSum<S> running_;
    std::uint8_t depth_ = 0;
    std::int8_t direction_ = 0;

    static_assert(Capacity <= 255);
};

} // namespace ductile
