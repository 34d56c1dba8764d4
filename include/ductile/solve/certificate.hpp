// SPDX-License-Identifier: MIT
//
// How far an answer is from what an island asks for, whoever found it.
#pragma once

#include "ductile/solve/island_system.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::solve {

/// Worst violation of a row, with velocities and residuals as they are [m/s | rad/s]: how far each
/// row or block is from its own optimum, times its own effect. NaN comes through.
[[nodiscard]] double certificate(IslandSystem& system) noexcept;

} // namespace ductile::solve

#ifndef DUCTILE_COMPILED
#include "ductile/solve/certificate.ipp"
#endif
