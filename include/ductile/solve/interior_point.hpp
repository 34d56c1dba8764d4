// SPDX-License-Identifier: MIT
//
// The safe way through an island of bounds and ellipsoids, in 10 to 30 factorisations however many
// rows change sides: where a rigid chain is struck most of its joints may. All rows stay inside
// and come to the answer along the middle, on which each multiplier times what is left to its
// bound or surface is one energy τ, which falls to nothing:
//
//   row         r = z_u - z_l,    z_u (u - x) = z_l (x - l) = τ
//   ellipsoid   r = μ n,          μ g = τ,    n = x/P²,   g = (1 - |x/P|²)/2
//
// Newton on that, the changes of the multipliers put in:
//
//   (C + z_u/(u - x) + z_l/(x - l)) dx = r - τ/(u - x) + τ/(x - l) - J dv
//   (C + μ/P² + (μ/g) n nᵀ) dx         = r - (τ/g) n - J dv
//
// first with τ = 0, which tells how far it may fall, then with that τ and the second-order terms of
// the first step, by the same factors.
//
// Source: Mehrotra (1992), doi:10.1137/0802028; convex constraints by their multipliers: Boyd &
// Vandenberghe (2004), section 11.7.
#pragma once

#include <cstddef>
#include <vector>

#include "ductile/solve/block_view.hpp"
#include "ductile/solve/island_system.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::solve {

/// Not thread-safe. Keeps room between solves.
class InteriorPoint {
  public:
    /// True of islands whose blocks are all ellipsoids.
    [[nodiscard]] static bool serves(const Island& island) noexcept;
    /// From the impulses in the island. Leaves impulses, sides, states and multipliers, mostly
    /// within 1e-9 of the largest velocity of the answer.
    void solve(IslandSystem& system);

    [[nodiscard]] int iterations() const noexcept { return iterations_; } ///< of the last solve

  private:
    /// To a bound or a surface.
    struct Gap {
        bool there = false;
        double left = 0, multiplier = 0; ///< their product is an energy [J]
        double push = 0;                 ///< τ and the second-order terms [J]
        double change = 0;               ///< of the multiplier
    };
    struct Row {
        Gap lower, upper;
    };
    /// What is left to a surface after a share t of the step: left - along t - bend t².
    struct Way {
        double along = 0, bend = 0;
    };

    void begin();
    [[nodiscard]] double lacking() const;
    void measure();
    [[nodiscard]] double energy(double share) const;
    void set_tangents();
    void aim(double energy, bool second_order);
    void read_changes();
    [[nodiscard]] double reach() const;
    void take(double share);
    void leave();
    [[nodiscard]] bool bounded(std::size_t row) const noexcept;
    [[nodiscard]] double lack(std::size_t block, int row) const noexcept;
    [[nodiscard]] double flow(std::size_t block) const noexcept;
    [[nodiscard]] double off() const;
    [[nodiscard]] Way way(std::size_t block) const noexcept;

    IslandSystem* system_ = nullptr;
    std::vector<Row> rows_;
    std::vector<Gap> blocks_;
    int iterations_ = 0;
};

} // namespace ductile::solve

#ifndef DUCTILE_COMPILED
#include "ductile/solve/interior_point.ipp"
#endif
