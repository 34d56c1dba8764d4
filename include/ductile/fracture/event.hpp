// SPDX-License-Identifier: MIT
//
// The report of a break: which axis, which criterion, when, and how much energy.
#pragma once

#include <concepts>
#include <cstddef>
#include <string_view>

#include "ductile/fracture/fracture.hpp"

namespace ductile {

/// Plain value, written once by the joint that broke.
template <std::floating_point S>
struct FractureEvent {
    std::size_t axis = 0; ///< index of the row in its joint
    CriterionKind criterion = CriterionKind::none;
    S time = 0;            ///< simulated time of the break [s]
    S plastic_travel = 0;  ///< accumulated at the break [m | rad]
    S absorbed_energy = 0; ///< dissipated by flow up to the break, >= 0 [J]
    S released_energy = 0; ///< elastic energy the break set free, >= 0 [J]
    S force = 0;           ///< signed, just before the break [N | N m]

    [[nodiscard]] constexpr std::string_view name() const noexcept { return to_string(criterion); }

    bool operator==(const FractureEvent&) const = default;
};

} // namespace ductile
