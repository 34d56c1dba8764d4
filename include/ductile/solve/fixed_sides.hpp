// SPDX-License-Identifier: MIT
//
// A step of Newton with the sides of rows and the states of blocks as they are: rows at a bound
// stay there, blocks on their surface move along it.
#pragma once

#include <cmath>

#include "ductile/solve/block_form.hpp"
#include "ductile/solve/island_system.hpp"

namespace ductile::solve {

/// W and the terms of D.
inline void set_tangents(IslandSystem& system) {
    Island& island = system.island();
    for (std::size_t i = 0; i < island.rows.size(); ++i) {
        if (!system.alone(i)) continue;
        const IslandRow& row = island.rows[i];
        IslandSystem::Row& work = system.rows()[i];
        const bool free = row.side == Side::free && row.lower < row.upper;
        work.weight = work.own > 0 && free ? 1 / work.compliance : 0;
    }
    for (std::size_t k = 0; k < island.blocks.size(); ++k) {
        const BlockView view = view_of(system, k);
        with_form(view, [&view](auto form) { form.set_tangent(view); });
    }
}
/// g and e, from the residuals; the worst that is left [m/s | rad/s]. NaN comes through.
[[nodiscard]] inline double set_right_sides(IslandSystem& system) {
    Island& island = system.island();
    double worst = 0;
    const auto see = [&worst](double off) {
        if (!(off <= worst)) worst = off;
    };
    for (IslandSystem::Row& work : system.rows()) {
        work.right = work.residual;
        work.extra = 0;
    }
    for (std::size_t k = 0; k < island.blocks.size(); ++k) {
        const BlockView view = view_of(system, k);
        see(with_form(view, [&view](auto form) { return form.set_right(view); }));
    }
    for (const IslandSystem::Row& work : system.rows()) {
        if (work.weight != 0) see(std::abs(work.right) * work.share);
    }
    return worst;
}
/// What became of the blocks on their surface: one whose multiplier would leave the range has left
/// it, or keeps a tenth of it, as what is not yet solved elsewhere may have led it.
enum class Stay { all, eased, left };
/// Adds dx to the impulses. `ease`: blocks do not leave their surface at once.
inline Stay take_step(IslandSystem& system, bool ease) {
    constexpr double kept = 0.1;
    Island& island = system.island();
    for (std::size_t i = 0; i < island.rows.size(); ++i) {
        island.rows[i].impulse += system.rows()[i].change;
    }
    Stay stay = Stay::all;
    for (std::size_t k = 0; k < island.blocks.size(); ++k) {
        const BlockView view = view_of(system, k);
        const double before = view.block.multiplier;
        if (with_form(view, [&view](auto form) { return form.take(view); })) continue;
        if (ease && view.block.kind == BlockKind::ellipsoid && before > BlockView::known(0)) {
            view.block.multiplier = kept * before;
            if (stay == Stay::all) stay = Stay::eased;
        } else {
            stay = Stay::left;
        }
    }
    return stay;
}

} // namespace ductile::solve
