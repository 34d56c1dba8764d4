// SPDX-License-Identifier: MIT
//
// What every law of strength offers: the force (or moment) at which a row flows, as a function of
// the accumulated plastic travel p >= 0. Laws know nothing of joints.
#pragma once

#include <concepts>

namespace ductile {

/// `value(p)` is the strength R(p) > 0 [N | N m], `slope(p)` its derivative [N/m | N m/rad].
template <class T>
concept StrengthLaw = requires(const T law, typename T::Scalar travel) {
    requires std::floating_point<typename T::Scalar>;
    { law.value(travel) } noexcept -> std::same_as<typename T::Scalar>;
    { law.slope(travel) } noexcept -> std::same_as<typename T::Scalar>;
};

} // namespace ductile
