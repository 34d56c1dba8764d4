// SPDX-License-Identifier: MIT
//
// What every fracture criterion offers: when a joint breaks. A criterion is an immutable value with
// the limits; what it remembers is its State, a plain value that the joint owns, so that it can be
// copied, compared, saved and restored. Criteria know nothing of joints.
//
// How a joint uses one, per step:
//
//   before   R = law(p + |u| dt/2) × strength_factor(state, |u| dt/2)
//            bounds: min(R, force_cap(state, ±1)) on the side of that sign
//            left = remaining(state, R, sign of u): where the step would flow further, only `left`
//            may do work, so the joint absorbs R × left and breaks inside the step
//   after    update(state, increment), the increment clipped to `left`; an increment that uses up
//            what `remaining` said breaks the criterion; then broken(state) and governing(state)
//
// Load below yield never consumes life: an increment without plastic flow leaves the state as it
// was, bit for bit, except that a brittle criterion breaks where the force reaches its cap.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <limits>
#include <string_view>
#include <type_traits>

namespace ductile {

/// Which criterion broke a joint, or is the nearest to do so.
enum class CriterionKind : unsigned char {
    none,
    plastic_travel,
    absorbed_energy,
    brittle_force,
    low_cycle_fatigue,
    softening_damage,
    exhausted_strength, ///< no criterion: the law itself softened to nothing
    count
};

[[nodiscard]] constexpr std::string_view to_string(CriterionKind kind) noexcept {
    constexpr std::array<std::string_view, std::size_t(CriterionKind::count)> names{
        "none",
        "plastic travel",
        "absorbed energy",
        "brittle force",
        "low-cycle fatigue",
        "softening damage",
        "exhausted strength"};
    return kind < CriterionKind::count ? names[std::size_t(kind)] : "unknown";
}

/// What one step did to a row, as a criterion is told. Without flow `plastic` is exactly zero.
template <std::floating_point S>
struct PlasticIncrement {
    S plastic = 0; ///< signed plastic increment, |plastic| = work-conjugate travel [m | rad]
    S travel = 0;  ///< accumulated plastic travel p after the step [m | rad]
    S force = 0;   ///< signed force of the row over the step [N | N m]
    S work = 0;    ///< plastic work of the step, >= 0 [J]
    S dt = 0;      ///< [s]
};

/// Says before a step what a row may still do. None of these change the state.
///   remaining        plastic travel that may still do work at this strength [N | N m], flowing
///                    towards the sign of `direction` (0: not known, the smaller answer); infinity:
///                    no limit in sight; 0 where broken, and only there [m | rad]
///   force_cap        largest magnitude of a force of this sign (0: the smaller); infinity: none
///   strength_factor  what the strength is multiplied by after `ahead` more travel, in [0, 1]
template <class T>
concept BoundsFlow = std::floating_point<typename T::Scalar> &&
    requires(const T criterion, const typename T::State& state, typename T::Scalar x) {
        { criterion.remaining(state, x, x) } noexcept -> std::same_as<typename T::Scalar>;
        { criterion.force_cap(state, x) } noexcept -> std::same_as<typename T::Scalar>;
        { criterion.strength_factor(state, x) } noexcept -> std::same_as<typename T::Scalar>;
    };

/// Books after a step what the row did. Nothing here ever un-breaks.
///   update     feeds one increment
///   broken     true once life is used up
///   damage     share of life used, in [0, 1], never decreases; 1 exactly where broken
///   governing  the criterion that broke the joint, or is the nearest to do so
template <class T>
concept CountsDamage =
    requires(const T criterion, typename T::State& state, const typename T::State& now,
             const PlasticIncrement<typename T::Scalar>& increment) {
        { criterion.update(state, increment) } noexcept -> std::same_as<void>;
        { criterion.broken(now) } noexcept -> std::same_as<bool>;
        { criterion.damage(now) } noexcept -> std::same_as<typename T::Scalar>;
        { criterion.governing(now) } noexcept -> std::same_as<CriterionKind>;
    };

template <class T>
concept FractureCriterion = BoundsFlow<T> && CountsDamage<T> && std::regular<typename T::State> &&
    std::is_trivially_copyable_v<typename T::State>;

/// For criteria that limit flow, not force.
template <std::floating_point S>
struct WithoutForceCap {
    template <class State>
    [[nodiscard]] S force_cap(const State&, S /*sign*/ = 0) const noexcept {
        return std::numeric_limits<S>::infinity();
    }
};

/// For criteria that leave the strength as it is until the break.
template <std::floating_point S>
struct WithoutSoftening {
    template <class State>
    [[nodiscard]] S strength_factor(const State&, S /*ahead*/ = 0) const noexcept {
        return 1;
    }
};

/// Less life than this share counts as used up; covers the round-off of a joint that turns
/// `remaining` into work and back.
template <std::floating_point S>
inline constexpr S exhausted_share = 16 * std::numeric_limits<S>::epsilon();

} // namespace ductile
