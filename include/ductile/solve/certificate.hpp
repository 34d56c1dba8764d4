// SPDX-License-Identifier: MIT
//
// How far an answer is from what an island asks for, whoever found it.
#pragma once

#include <cmath>

#include "ductile/solve/block_form.hpp"
#include "ductile/solve/island_system.hpp"

namespace ductile::solve {

/// Worst violation of a row, with velocities and residuals as they are [m/s | rad/s]: how far each
/// row or block is from its own optimum, times its own effect. NaN comes through.
[[nodiscard]] inline double certificate(IslandSystem& system) noexcept {
    const Island& island = system.island();
    double worst = 0;
    const auto see = [&worst](double off) {
        if (!(off <= worst)) worst = off;
    };
    for (std::size_t i = 0; i < island.rows.size(); ++i) {
        const IslandSystem::Row& work = system.rows()[i];
        if (!system.alone(i) || work.own == 0) continue;
        const IslandRow& row = island.rows[i];
        const double aim = row.impulse + work.residual / work.metric;
        const double to = aim < row.lower ? row.lower : aim > row.upper ? row.upper : aim;
        see(std::abs(to - row.impulse) * work.own);
    }
    for (std::size_t k = 0; k < island.blocks.size(); ++k) {
        const BlockView view = view_of(system, k);
        see(with_form(view, [&view](auto form) { return form.off(view); }));
    }
    return worst;
}

} // namespace ductile::solve
