// SPDX-License-Identifier: MIT
//
// The short way for the smallest islands: up to six rows between one pair of bodies, or a body and
// what does not move. One dense system of the rows themselves, no order, no memory:
//
//   A x = b - w,   A = J M⁻¹ Jᵀ + C
//
// Sides as in active_set.hpp, with one row a round where several have changed over for long. Rows
// of a block are solved here as long as the block is not on its surface.
// No row is softened: those of one joint do not repeat each other.
//
// Source: Murty (1974), doi:10.1016/0024-3795(74)90019-X: the lowest wrong row alone ends in
// finitely many rounds.
#pragma once

#include "ductile/solve/island.hpp"
#include "ductile/solve/island_report.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::solve {

/// False, and the island as it was, where this is not the way: other rows, a surface reached, what
/// is not finite or not regular. The answer is otherwise that of IslandSolver.
[[nodiscard]] bool solve_one_pair(Island& island, IslandReport& report) noexcept;

} // namespace ductile::solve

#ifndef DUCTILE_COMPILED
#include "ductile/solve/one_pair.ipp"
#endif
