// SPDX-License-Identifier: MIT
//
// A sum that keeps what round-off drops. A joint adds very small increments to a large total for a
// long time: in float, 10⁶ cycles of damage 10⁻⁶ each would otherwise be a few percent off, and
// increments below half a unit in the last place would vanish, so that a part would never break.
//
// Source: Neumaier (1974), Rundungsfehleranalyse einiger Verfahren zur Summation endlicher Summen,
// ZAMM 54, 39-51, doi:10.1002/zamm.19740540106. Error ~2ε|Σx| instead of nε Σ|x|.
#pragma once

#include <cmath>
#include <concepts>

#include "ductile/vocabulary/check.hpp" // refuses -ffast-math, which would drop the carry

namespace ductile {

template <std::floating_point S>
struct CompensatedSum {
    S sum = 0;
    S carry = 0; ///< what round-off dropped from `sum`

    void add(S x) noexcept {
        const S total = sum + x;
        if (!std::isfinite(total)) {
            carry = 0;
        } else if (std::abs(sum) >= std::abs(x)) {
            carry += (sum - total) + x;
        } else {
            carry += (x - total) + sum;
        }
        sum = total;
    }
    [[nodiscard]] S value() const noexcept { return sum + carry; }

    bool operator==(const CompensatedSum&) const = default;
};

} // namespace ductile
