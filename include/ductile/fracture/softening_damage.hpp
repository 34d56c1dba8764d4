// SPDX-License-Identifier: MIT
//
// Ductile damage: from an onset travel on, the strength is multiplied by 1 - D(p) and falls to
// nothing at the failure travel, linearly or along given pairs.
//
//   D(p) = 0                                p <= p_onset
//        = (p - p_onset)/(p_f - p_onset)    linear form
//        = straight between the pairs       general form
//        = 1                                p >= p_failure, broken
//
// With a strength R that is constant otherwise, the linear form absorbs R (p_onset + p_f)/2; the
// midpoint rule on whole steps is exact on each straight piece.
//
// Limit case: p_onset → p_f is the abrupt break of a travel limit.
//
// Symbols: p accumulated plastic travel [m | rad], D damage [-].
// Source: Lemaitre (1985), A continuous damage mechanics model for ductile fracture, J. Eng. Mater.
// Technol. 107, 83-89, doi:10.1115/1.3225775 (effective strength 1 - D, linear in plastic strain
// from a threshold).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <span>
#include <string>

#include "ductile/fracture/fracture.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile {

template <std::floating_point S>
struct SofteningDamageParameters {
    S onset = std::numeric_limits<S>::quiet_NaN();   ///< p_onset [m | rad], >= 0
    S failure = std::numeric_limits<S>::quiet_NaN(); ///< p_failure [m | rad], > p_onset
};

template <std::floating_point S>
struct DamagePoint {
    S travel = std::numeric_limits<S>::quiet_NaN(); ///< p [m | rad], >= 0
    S damage = std::numeric_limits<S>::quiet_NaN(); ///< D [-], in [0, 1]
};

/// Immutable value; after construction all members are noexcept, O(number of pairs), and allocate
/// nothing.
template <std::floating_point S, std::size_t Capacity = 8>
class SofteningDamage : public WithoutForceCap<S> {
    static_assert(Capacity >= 2);

  public:
    using Scalar = S;

    struct State {
        S travel = 0; ///< accumulated plastic travel p [m | rad]

        bool operator==(const State&) const = default;
    };

    /// @throws std::invalid_argument where a travel is missing (NaN), infinite or out of order.
    explicit SofteningDamage(const SofteningDamageParameters<S>& parameters) {
        const S onset = check::non_negative("SofteningDamage.onset", parameters.onset, unit);
        const S failure = check::positive("SofteningDamage.failure", parameters.failure, unit);
        if (!(failure > onset)) {
            check::fail("SofteningDamage.failure", failure, unit, "greater than onset");
        }
        points_[0] = {onset, 0};
        points_[1] = {failure, 1};
        size_ = 2;
    }

    /// Pairs from (p_onset, 0) to (p_failure, 1), copied.
    /// @throws std::invalid_argument where there are fewer than two or more than Capacity pairs, a
    /// travel does not increase, a damage decreases, or the damage does not run from 0 to 1.
    explicit SofteningDamage(std::span<const DamagePoint<S>> points) {
        if (points.size() < 2 || points.size() > Capacity) {
            check::fail("SofteningDamage.points", S(points.size()), "pairs",
                        "in [2, " + std::to_string(Capacity) + "] pairs");
        }
        for (std::size_t i = 0; i < points.size(); ++i) check_point(points, i);
        std::copy(points.begin(), points.end(), points_.begin());
        size_ = points.size();
    }

    [[nodiscard]] S onset() const noexcept { return points_[0].travel; }           ///< [m | rad]
    [[nodiscard]] S failure() const noexcept { return points_[size_ - 1].travel; } ///< [m | rad]

    /// D(p), in [0, 1].
    [[nodiscard]] S damage_at(S travel) const noexcept {
        if (!(travel > onset())) return 0;
        std::size_t i = 1;
        while (i < size_ && travel >= points_[i].travel) ++i;
        if (i == size_) return 1;
        const DamagePoint<S>& a = points_[i - 1];
        const DamagePoint<S>& b = points_[i];
        return a.damage + (b.damage - a.damage) * ((travel - a.travel) / (b.travel - a.travel));
    }

    [[nodiscard]] S strength_factor(const State& state, S ahead = 0) const noexcept {
        return broken(state) ? S(0) : 1 - damage_at(state.travel + ahead);
    }
    [[nodiscard]] S remaining(const State& state, S /*strength*/,
                              S /*direction*/ = 0) const noexcept {
        return broken(state) ? S(0) : failure() - state.travel;
    }

    void update(State& state, const PlasticIncrement<S>& increment) const noexcept {
        if (!(std::abs(increment.plastic) > 0)) return;
        state.travel = std::max(state.travel, increment.travel);
    }
    [[nodiscard]] bool broken(const State& state) const noexcept {
        return state.travel >= failure() * (1 - exhausted_share<S>);
    }
    [[nodiscard]] S damage(const State& state) const noexcept {
        if (broken(state)) return 1;
        return std::min(damage_at(state.travel), 1 - std::numeric_limits<S>::epsilon());
    }
    [[nodiscard]] CriterionKind governing(const State&) const noexcept {
        return CriterionKind::softening_damage;
    }

  private:
    static constexpr const char* unit = "m or rad";

    static void check_point(std::span<const DamagePoint<S>> points, std::size_t i) {
        const std::string field = "SofteningDamage.points[" + std::to_string(i) + "]";
        const auto [travel, damage] = points[i];
        check::non_negative(field + ".travel", travel, unit);
        if (i > 0 && !(travel > points[i - 1].travel)) {
            check::fail(field + ".travel", travel, unit, "greater than the travel before it");
        }
        if (i == 0 && damage != 0) check::fail(field + ".damage", damage, "", "0 at the onset");
        if (i + 1 == points.size()) {
            if (damage != 1) check::fail(field + ".damage", damage, "", "1 at the failure");
        } else if (i > 0 && !(damage >= points[i - 1].damage && damage < 1)) {
            check::fail(field + ".damage", damage, "", "at least the damage before it and < 1");
        }
    }

    std::array<DamagePoint<S>, Capacity> points_{};
    std::size_t size_ = 0;
};

template <std::floating_point S>
SofteningDamage(const SofteningDamageParameters<S>&) -> SofteningDamage<S>;

static_assert(FractureCriterion<SofteningDamage<double>> &&
              FractureCriterion<SofteningDamage<float>>);

} // namespace ductile
