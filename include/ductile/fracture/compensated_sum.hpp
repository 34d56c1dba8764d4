// SPDX-License-Identifier: MIT
//
// A sum that keeps what round-off drops. A joint adds very small increments to a large total for a
// long time: in float, 10⁶ cycles of damage 10⁻⁶ each would otherwise be a few percent off, and
// increments below half a unit in the last place would vanish, so that a part would never break.
//
// Source: Kahan (1965), Further remarks on reducing truncation errors, Commun. ACM 8, 40,
// doi:10.1145/363707.363723, with Knuth's two-sum, so that an increment may exceed the sum.
// Relative error of a sum of positive terms: about 2ε, whatever their number (naively: that number
// × ε).
#pragma once

#include <cmath>
#include <concepts>

#include "ductile/vocabulary/check.hpp" // refuses -ffast-math, which would drop the carry

namespace ductile {

template <std::floating_point S>
struct CompensatedSum {
    S sum = 0;
    S carry = 0; ///< what round-off dropped from `sum`, below half a unit in its last place

    void add(S x) noexcept {
        const S step = x + carry;
        const S total = sum + step;
        const S taken = total - sum;
        carry = std::isfinite(total) ? (sum - (total - taken)) + (step - taken) : S(0);
        sum = total;
    }
    [[nodiscard]] S value() const noexcept { return sum; }

    bool operator==(const CompensatedSum&) const = default;
};

} // namespace ductile
