// SPDX-License-Identifier: MIT
//
// What every law of strength offers: the force (or moment) at which a row flows, as a function of
// the accumulated plastic travel p >= 0. Laws know nothing of joints.
//
// Symbols ("x | y": translational row | rotational row)
//   p    accumulated plastic travel                [m | rad]
//   R    strength R(p) >= 0                        [N | N m]
//   p_f  exhaustion: the travel at which R is zero [m | rad]
//
// A law may soften to zero at a finite p_f and stay there. It then offers `exhaustion()`, and the
// break follows from it: the joint breaks where p reaches p_f, having dissipated exactly
// work(0, p_f), the area under the law; no force jumps, because R has faded to zero. A step that
// takes the work W from the bodies leaves p at p' with work(p, p') = W; what W holds beyond
// work(p, p_f) was taken in excess and is handed back. Counting p as W / R instead divides by zero
// there. Laws that never reach zero have p_f = ∞ and break by a criterion of their own.
#pragma once

#include <concepts>
#include <limits>

namespace ductile {

/// `value(p)` is the strength R(p) >= 0 [N | N m], `slope(p)` its derivative [N/m | N m/rad] (the
/// right-hand one at a kink), `work(p0, p1)` the exact integral of R from p0 to p1 [J], negative
/// where p1 < p0. All for p >= 0.
template <class T>
concept StrengthLaw = requires(const T law, typename T::Scalar travel) {
    requires std::floating_point<typename T::Scalar>;
    { law.value(travel) } noexcept -> std::same_as<typename T::Scalar>;
    { law.slope(travel) } noexcept -> std::same_as<typename T::Scalar>;
    { law.work(travel, travel) } noexcept -> std::same_as<typename T::Scalar>;
};

/// A law that can fade to nothing: `exhaustion()` is the smallest p with R(p) = 0 [m | rad],
/// infinity where there is none.
template <class T>
concept ExhaustibleLaw = StrengthLaw<T> && requires(const T law) {
    { law.exhaustion() } noexcept -> std::same_as<typename T::Scalar>;
};

/// A law that knows its mean: `mean(p0, p1)` is the mean of R from p0 to p1 [N | N m].
template <class T>
concept AveragedLaw = StrengthLaw<T> && requires(const T law, typename T::Scalar travel) {
    { law.mean(travel, travel) } noexcept -> std::same_as<typename T::Scalar>;
};

/// Mean strength from p0 to p1 >= p0 of any law [N | N m]; by a division where the law does not know it.
template <StrengthLaw Law>
[[nodiscard]] typename Law::Scalar mean_strength(const Law& law, typename Law::Scalar from,
                                                 typename Law::Scalar to) noexcept {
    if constexpr (AveragedLaw<Law>) {
        return law.mean(from, to);
    } else {
        return to > from ? law.work(from, to) / (to - from) : law.value(from);
    }
}

/// p_f of any law [m | rad]; infinity for one that cannot fade.
template <StrengthLaw Law>
[[nodiscard]] typename Law::Scalar exhaustion(const Law& law) noexcept {
    if constexpr (ExhaustibleLaw<Law>) {
        return law.exhaustion();
    } else {
        return std::numeric_limits<typename Law::Scalar>::infinity();
    }
}

/// Strength to act with over the coming `travel` >= 0: the mean for a law that fades, exact over its
/// kinks and at its end, else that of the midpoint, of second order [N | N m].
template <StrengthLaw Law>
[[nodiscard]] typename Law::Scalar strength_ahead(const Law& law, typename Law::Scalar from,
                                                  typename Law::Scalar travel) noexcept {
    if constexpr (ExhaustibleLaw<Law>) {
        return mean_strength(law, from, from + travel);
    } else {
        return law.value(from + travel / 2);
    }
}

/// Travel until a law has faded to nothing, never negative; infinity for one that cannot [m | rad].
template <StrengthLaw Law>
[[nodiscard]] typename Law::Scalar travel_to_nothing(const Law& law,
                                                     typename Law::Scalar travel) noexcept {
    const typename Law::Scalar left = exhaustion(law) - travel;
    return left > 0 ? left : 0;
}

} // namespace ductile
