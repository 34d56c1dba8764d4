// SPDX-License-Identifier: MIT
//
// What every strain-life curve offers: the number of reversals to failure at a constant strain
// amplitude, and its inverse.
#pragma once

#include <concepts>

namespace ductile {

/// `reversals(ε_a)` is 2N_f > 0 [-], decreasing in the amplitude ε_a >= 0 [-], infinity at 0;
/// `amplitude(2N)` is its inverse.
template <class T>
concept LifeCurve = std::floating_point<typename T::Scalar> &&
    requires(const T life, typename T::Scalar x) {
        { life.reversals(x) } noexcept -> std::same_as<typename T::Scalar>;
        { life.amplitude(x) } noexcept -> std::same_as<typename T::Scalar>;
    };

} // namespace ductile
