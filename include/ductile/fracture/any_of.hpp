// SPDX-License-Identifier: MIT
//
// Several criteria at once: the joint breaks at the first of them and remembers which it was.
//
//   remaining        the smallest of the members'
//   force_cap        the smallest
//   strength_factor  the smallest: the weakest governs, damages do not multiply
//   damage           the largest
//
// A step that overshoots several limits at once is the fault of the member with the least travel
// left before it; among equals, of the one named first. A member that limits no flow broke by its
// force, and comes before those.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <tuple>
#include <utility>

#include "ductile/fracture/fracture.hpp"

namespace ductile {

namespace detail {

/// States side by side. Unlike std::tuple it is trivially copyable.
template <class First, class... Rest>
struct StatePack {
    First first{};
    StatePack<Rest...> rest{};

    bool operator==(const StatePack&) const = default;
};
template <class First>
struct StatePack<First> {
    First first{};

    bool operator==(const StatePack&) const = default;
};

template <std::size_t I, class Pack>
[[nodiscard]] constexpr auto& state_of(Pack& pack) noexcept {
    if constexpr (I == 0) {
        return pack.first;
    } else {
        return state_of<I - 1>(pack.rest);
    }
}

} // namespace detail

/// Immutable value; after construction all members are noexcept and allocate nothing. Itself a
/// criterion, so it nests.
template <FractureCriterion First, FractureCriterion... Rest>
    requires(std::same_as<typename First::Scalar, typename Rest::Scalar> && ...)
class AnyOf {
  public:
    using Scalar = typename First::Scalar;
    using S = Scalar;

    struct State {
        detail::StatePack<typename First::State, typename Rest::State...> members;
        int broken_by = -1; ///< index of the member that broke, -1 while intact

        bool operator==(const State&) const = default;
    };

    explicit AnyOf(First first, Rest... rest)
        : criteria_(std::move(first), std::move(rest)...) {}

    /// Member I, and its part of the state.
    template <std::size_t I>
    [[nodiscard]] const auto& criterion() const noexcept {
        return std::get<I>(criteria_);
    }
    template <std::size_t I>
    [[nodiscard]] static const auto& member_state(const State& state) noexcept {
        return detail::state_of<I>(state.members);
    }

    [[nodiscard]] S remaining(const State& state, S strength, S direction = 0) const noexcept {
        S least = broken(state) ? S(0) : std::numeric_limits<S>::infinity();
        each(state, [&](const auto& criterion, const auto& member, int) {
            least = std::min(least, criterion.remaining(member, strength, direction));
        });
        return least;
    }
    [[nodiscard]] S force_cap(const State& state, S sign = 0) const noexcept {
        S least = std::numeric_limits<S>::infinity();
        each(state, [&](const auto& criterion, const auto& member, int) {
            least = std::min(least, criterion.force_cap(member, sign));
        });
        return least;
    }
    [[nodiscard]] S strength_factor(const State& state, S ahead = 0) const noexcept {
        S least = 1;
        each(state, [&](const auto& criterion, const auto& member, int) {
            least = std::min(least, criterion.strength_factor(member, ahead));
        });
        return least;
    }

    /// A broken joint stays as it broke.
    void update(State& state, const PlasticIncrement<S>& increment) const noexcept {
        if (broken(state)) return;
        const State before = state;
        bool any = false;
        each(state, [&](const auto& criterion, auto& member, int) {
            criterion.update(member, increment);
            any = any || criterion.broken(member);
        });
        if (any) state.broken_by = first_to_break(before, state, increment);
    }
    [[nodiscard]] bool broken(const State& state) const noexcept { return state.broken_by >= 0; }
    [[nodiscard]] S damage(const State& state) const noexcept {
        S most = 0;
        each(state, [&](const auto& criterion, const auto& member, int) {
            most = std::max(most, criterion.damage(member));
        });
        return most;
    }

    /// Index of the member that broke the joint; before the break, of the one with most damage.
    [[nodiscard]] std::size_t governing_index(const State& state) const noexcept {
        if (broken(state)) return std::size_t(state.broken_by);
        std::size_t index = 0;
        S most = -1;
        each(state, [&](const auto& criterion, const auto& member, int i) {
            const S damage = criterion.damage(member);
            if (damage > most) {
                most = damage;
                index = std::size_t(i);
            }
        });
        return index;
    }
    /// Its kind.
    [[nodiscard]] CriterionKind governing(const State& state) const noexcept {
        const int governing = int(governing_index(state));
        CriterionKind kind = CriterionKind::none;
        each(state, [&](const auto& criterion, const auto& member, int i) {
            if (i == governing) kind = criterion.governing(member);
        });
        return kind;
    }

  private:
    static constexpr std::size_t count = 1 + sizeof...(Rest);

    template <class AnyState, class Visit>
    void each(AnyState& state, Visit&& visit) const noexcept {
        [&]<std::size_t... I>(std::index_sequence<I...>) {
            (visit(std::get<I>(criteria_), detail::state_of<I>(state.members), int(I)), ...);
        }(std::make_index_sequence<count>{});
    }

    /// Among the members broken `after`, the one that had the least travel left `before`.
    int first_to_break(const State& before, const State& after,
                       const PlasticIncrement<S>& increment) const noexcept {
        const S step = std::abs(increment.plastic);
        const S strength = step > 0 ? increment.work / step : S(0);
        std::array<S, count> left{};
        each(before, [&](const auto& criterion, const auto& member, int i) {
            const S travel = criterion.remaining(member, strength, increment.plastic);
            left[std::size_t(i)] = std::isinf(travel) ? S(-1) : travel;
        });
        int first = -1;
        each(after, [&](const auto& criterion, const auto& member, int i) {
            if (!criterion.broken(member)) return;
            if (first < 0 || left[std::size_t(i)] < left[std::size_t(first)]) first = i;
        });
        return first;
    }

    std::tuple<First, Rest...> criteria_;
};

} // namespace ductile
