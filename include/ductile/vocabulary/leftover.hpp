// SPDX-License-Identifier: MIT
//
// What counts as nothing of a travel that many steps have added up to.
#pragma once

#include <concepts>

namespace ductile {

/// A step that leaves less than this share of what it could use uses up all [-]: the sum is off by as
/// much, and for the rest an end would come one step late.
template <std::floating_point S>
inline constexpr S leftover_share = sizeof(S) == sizeof(float) ? S(1e-5) : S(1e-9);

} // namespace ductile
