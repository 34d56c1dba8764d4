// SPDX-License-Identifier: MIT
//
// The report of a break: which axis, which criterion, when, and how much energy. A joint draws it
// up from its state, so that one restored from a broken state says the same.
#pragma once

#include <concepts>
#include <cstddef>
#include <string_view>

#include "ductile/fracture/fracture.hpp"

namespace ductile {

/// Plain value.
template <std::floating_point S>
struct FractureEvent {
    std::size_t axis = 0; ///< index of the row in its joint
    CriterionKind criterion = CriterionKind::none;
    double time = 0; ///< of the break, on the joint's own clock [s]; a float would stop counting
    S plastic_travel = 0;  ///< accumulated at the break [m | rad]
    S absorbed_energy = 0; ///< dissipated by flow up to the break, >= 0 [J]
    S released_energy = 0; ///< stored energy that the break set free inside the part, >= 0 [J]
    S force = 0;           ///< of the row, signed, just before the break [N | N m]

    [[nodiscard]] constexpr std::string_view name() const noexcept { return to_string(criterion); }

    bool operator==(const FractureEvent&) const = default;
};

} // namespace ductile
