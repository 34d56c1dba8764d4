// SPDX-License-Identifier: MIT
//
// A step of Newton with the sides of rows and the states of blocks as they are: rows at a bound
// stay there, blocks on their surface move along it.
#pragma once

#include "ductile/solve/island_system.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::solve {

/// W and the terms of D.
void set_tangents(IslandSystem& system);
/// g and e, from the residuals; the worst that is left [m/s | rad/s]. NaN comes through.
[[nodiscard]] double set_right_sides(IslandSystem& system);
/// What became of the blocks on their surface: one whose multiplier would leave the range has left
/// it, or keeps a tenth of it, as what is not yet solved elsewhere may have led it.
enum class Stay { all, eased, left };
/// Adds dx to the impulses. `ease`: blocks do not leave their surface at once.
Stay take_step(IslandSystem& system, bool ease);

} // namespace ductile::solve

#ifndef DUCTILE_COMPILED
#include "ductile/solve/fixed_sides.ipp"
#endif
