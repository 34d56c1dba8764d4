// SPDX-License-Identifier: MIT
//
// The forces between which a row does not flow, seen along a flow. A back force moves them, until
// the range does not hold zero any more and the row flows back by itself: what resists the flow is
// then negative, and the flow gives work.
//
// Symbols: forces along the flow as in law/cyclic.hpp; direction s = ±1.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>

#include "ductile/law/cyclic.hpp"

namespace ductile {

template <std::floating_point S>
struct FlowRange : ForceRange<S> {
    /// Force against flow towards `direction`; negative where a back force drives it [N | N m].
    [[nodiscard]] S against(S direction) const noexcept {
        return direction < 0 ? -this->lower : this->upper;
    }
    /// Its magnitude [N | N m].
    [[nodiscard]] S resistance(S direction) const noexcept { return std::abs(against(direction)); }

    /// True where the work of a flow tells how far it went: not where a back force takes most of
    /// the resistance away, down to nothing and below, nor where the strength is below `least`.
    [[nodiscard]] bool told_by_work(S direction, S least) const noexcept {
        return against(direction) > std::max((this->upper - this->lower) / 4, least);
    }
};

} // namespace ductile
