// SPDX-License-Identifier: MIT
//
// A block while its island is solved: what is given, its rows, and what the system works with. What
// a kind of block does is a form, a class of static functions on it:
//
//   guess       a multiplier where none is known
//   place       x to where the state says
//   set_tangent, set_right, take    Newton on the surface, as in active_set.hpp
//   change_over where it belongs; true where that is another state than before
//   off         how far it is from its own optimum, as a velocity
//   project     x into the set
//   respond     x to Π(x + r/d) and its tangent, for proximal_newton.hpp
//
// Symbols as in island.hpp, active_set.hpp and proximal_newton.hpp.
#pragma once

#include <limits>
#include <utility>

#include "ductile/solve/island_system.hpp"

namespace ductile::solve {

/// Refers to an IslandSystem. The index of all members: row of the block.
struct BlockView {
    IslandBlock& block;
    IslandRow* row;
    IslandSystem::Row* work;
    IslandSystem::Block& tangent;

    [[nodiscard]] int count() const noexcept { return block.count; }
    [[nodiscard]] double size(int i) const noexcept { return block.size[std::size_t(i)]; }
    /// False of rows that nothing can follow or that may carry nothing.
    [[nodiscard]] bool live(int i) const noexcept { return work[i].own > 0 && size(i) > 0; }
    [[nodiscard]] bool on_surface() const noexcept { return block.state == BlockState::surface; }

    /// What a row does from `free` on: nothing, or follow its compliance.
    void release(int i, bool free) const noexcept {
        work[i].weight = free && work[i].own > 0 ? 1 / work[i].compliance : 0;
    }
    void clear_terms() const noexcept {
        for (auto& term : tangent.terms) term.coefficient = 0;
        tangent.coupling = 0;
    }
    /// A multiplier that is not zero, which means unknown.
    static double known(double multiplier) noexcept {
        return multiplier > 0 ? multiplier : std::numeric_limits<double>::min();
    }
};

[[nodiscard]] inline BlockView view_of(IslandSystem& system, std::size_t block) noexcept {
    IslandBlock& given = system.island().blocks[block];
    const auto first = std::size_t(given.first);
    return {given, &system.island().rows[first], &system.rows()[first], system.blocks()[block]};
}

} // namespace ductile::solve
