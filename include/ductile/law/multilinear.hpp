// SPDX-License-Identifier: MIT
//
// A law of strength as pairs (plastic travel, strength), linear between them and constant after the
// last: what a test, a code's backbone or a fibre integration gives. It may harden, soften and end
// at zero.
//
//   R(p) = R_i + (R_{i+1} - R_i) (p - p_i) / (p_{i+1} - p_i)     p_i <= p < p_{i+1}
//   R(p) = R_n                                                  p >= p_n
//
// The work over a part of one piece is taken as a trapezoid, over whole pieces from sums made at
// construction, so that small steps late on the curve lose no digits.
//
// The pairs lie in the object: copying it allocates nothing. Lookup is linear in the number of
// pairs, which is faster than bisection for the few pairs such a curve has.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <initializer_list>
#include <limits>
#include <span>
#include <string>

#include "ductile/law/law.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile {

template <std::floating_point S>
struct StrengthPoint {
    S travel = std::numeric_limits<S>::quiet_NaN();   ///< p [m | rad]
    S strength = std::numeric_limits<S>::quiet_NaN(); ///< R [N | N m]
};

/// Immutable value for at most `Capacity` pairs.
template <std::floating_point S, std::size_t Capacity = 32>
class Multilinear {
  public:
    using Scalar = S;

    /// Pairs with the travel strictly increasing from 0 and the strength finite and > 0; the last
    /// strength may be 0.
    /// @throws std::invalid_argument where a pair is not so, or where there are none or too many.
    explicit Multilinear(std::span<const StrengthPoint<S>> points) : size_(checked_size(points)) {
        for (std::size_t i = 0; i < size_; ++i) {
            travel_[i] = checked_travel(points, i);
            strength_[i] = checked_strength(points, i);
            if (i > 0) area_[i] = area_[i - 1] + mean(i - 1, i) * (travel_[i] - travel_[i - 1]);
        }
    }
    /// @throws std::invalid_argument as above.
    explicit Multilinear(std::initializer_list<StrengthPoint<S>> points)
        : Multilinear(std::span<const StrengthPoint<S>>(points.begin(), points.size())) {}

    [[nodiscard]] std::size_t size() const noexcept { return size_; }
    /// Pair `i` < size().
    [[nodiscard]] StrengthPoint<S> point(std::size_t i) const noexcept {
        return {travel_[i], strength_[i]};
    }

    [[nodiscard]] S value(S travel) const noexcept { return value_on(piece(travel), travel); }
    [[nodiscard]] S slope(S travel) const noexcept { return slope_of(piece(travel)); }

    [[nodiscard]] S work(S from, S to) const noexcept {
        if (to < from) return -work(to, from);
        const std::size_t first = piece(from);
        const std::size_t last = piece(to);
        if (first == last) return (value_on(first, from) + value_on(last, to)) / 2 * (to - from);
        const S head =
            (value_on(first, from) + strength_[first + 1]) / 2 * (travel_[first + 1] - from);
        const S tail = (strength_[last] + value_on(last, to)) / 2 * (to - travel_[last]);
        return head + (area_[last] - area_[first + 1]) + tail;
    }

    [[nodiscard]] S exhaustion() const noexcept {
        return strength_[size_ - 1] > 0 ? std::numeric_limits<S>::infinity() : travel_[size_ - 1];
    }

  private:
    /// Index of the piece that holds `travel`: the last pair at or before it.
    std::size_t piece(S travel) const noexcept {
        std::size_t i = 0;
        while (i + 1 < size_ && travel >= travel_[i + 1]) ++i;
        return i;
    }
    S slope_of(std::size_t i) const noexcept {
        if (i + 1 == size_) return 0;
        return (strength_[i + 1] - strength_[i]) / (travel_[i + 1] - travel_[i]);
    }
    S value_on(std::size_t i, S travel) const noexcept {
        if (i + 1 == size_) return strength_[i];
        const S share = (travel - travel_[i]) / (travel_[i + 1] - travel_[i]);
        return (1 - share) * strength_[i] + share * strength_[i + 1];
    }
    S mean(std::size_t i, std::size_t j) const noexcept {
        return (strength_[i] + strength_[j]) / 2;
    }

    static std::size_t checked_size(std::span<const StrengthPoint<S>> points) {
        if (points.empty() || points.size() > Capacity) {
            check::fail("Multilinear.size", S(points.size()), "",
                        "in [1, " + std::to_string(Capacity) + "]");
        }
        return points.size();
    }
    static std::string field(std::size_t i, const char* name) {
        return "Multilinear.points[" + std::to_string(i) + "]." + name;
    }
    static S checked_travel(std::span<const StrengthPoint<S>> points, std::size_t i) {
        const S travel = points[i].travel;
        if (i == 0) {
            if (travel != S(0)) check::fail(field(i, "travel"), travel, "m or rad", "0");
            return travel;
        }
        return check::between(field(i, "travel"), travel, points[i - 1].travel,
                              std::numeric_limits<S>::infinity(), "m or rad");
    }
    static S checked_strength(std::span<const StrengthPoint<S>> points, std::size_t i) {
        const S strength = points[i].strength;
        if (i > 0 && i + 1 == points.size()) {
            return check::non_negative(field(i, "strength"), strength, "N or N m");
        }
        return check::positive(field(i, "strength"), strength, "N or N m");
    }

    std::size_t size_;
    std::array<S, Capacity> travel_{};
    std::array<S, Capacity> strength_{};
    std::array<S, Capacity> area_{}; ///< work from 0 to each pair [J]
};

static_assert(ExhaustibleLaw<Multilinear<double>> && ExhaustibleLaw<Multilinear<float>>);

} // namespace ductile
