// SPDX-License-Identifier: MIT
//
// The short way for the smallest islands: up to six rows between one pair of bodies, or a body and
// what does not move. One dense system of the rows themselves, no order, no memory:
//
//   A x = b - w,   A = J M⁻¹ Jᵀ + C
//
// Sides as in active_set.hpp, with one row a round where several have changed over for long. Rows
// that share an ellipsoid, beside others without bounds, flow with one unknown, its multiplier:
//
//   (A + μ E) x = b,   E = diag(1/P²) of those that share it,   |x/P| = 1
//
// and |x/P|^-1 is concave and rising in μ, so that Newton from 0 never passes the root.
// No row is softened: those of one joint do not repeat each other.
//
// Sources: Murty (1974), doi:10.1016/0024-3795(74)90019-X: the lowest wrong row alone ends in
// finitely many rounds; Moré & Sorensen (1983), doi:10.1137/0904038: the equation of one unknown.
#pragma once

#include "ductile/solve/island.hpp"
#include "ductile/solve/island_report.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::solve {

/// False, and the island as it was, where this is not the way: other rows, another surface, what
/// is not finite or not regular. The answer is otherwise that of IslandSolver.
[[nodiscard]] bool solve_one_pair(Island& island, IslandReport& report) noexcept;

} // namespace ductile::solve

#ifndef DUCTILE_COMPILED
#include "ductile/solve/one_pair.ipp"
#endif
