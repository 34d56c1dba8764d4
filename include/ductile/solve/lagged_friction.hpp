// SPDX-License-Identifier: MIT
//
// The way through an island whose contacts slide where Newton on Coulomb's law does not settle
// (coulomb_form.hpp): the friction of each is bounded by a disc, whose radius is the normal impulse
// of the round before,
//
//   n >= 0,   |t/f| <= n',   n' <- n
//
// Each round is an island of bounds and ellipsoids, solved warm by the active set, or the safe way
// where that does not settle; the fixed point is Coulomb's law. What friction does to the normals
// is a moment of the sliding forces, f h/l of a body of height h on a base l, so that a few rounds
// settle, accelerated. The cone's own fixed point (contact_form.hpp) shifts by slips instead, by
// which four corners of one face are at odds: of a pair of cubes that slides on a floor it took 300
// factorisations where this takes 7.
//
// Where bodies jam, rounds wander, and settle late or not at all: then this is not the way.
//
// Source: the "lagged" contact of Castro, Han & Masterjohn (2023), arXiv:2312.03908.
#pragma once

#include <cstddef>
#include <vector>

#include "ductile/numeric/anderson.hpp"
#include "ductile/solve/active_set.hpp"
#include "ductile/solve/island_system.hpp"
#include "ductile/solve/proximal_newton.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::solve {

/// Not thread-safe. Keeps room between solves.
class LaggedFriction {
  public:
    /// From the impulses, sides and states in the island. True where it settled: these are those of
    /// the answer then, velocities and residuals belong to them, and shifts are zero. Else all is
    /// as it was.
    [[nodiscard]] bool solve(IslandSystem& system);

    /// Of the last solve.
    [[nodiscard]] int factorisations() const noexcept { return factorisations_; }

  private:
    void begin(IslandSystem& system);
    [[nodiscard]] bool solve_round();
    void take_from_flat();
    void give_to_flat();
    [[nodiscard]] double read(const IslandSystem& system);
    void set_radii(const Island& island);
    void give(IslandSystem& system) const;

    Island flat_; ///< the island with discs in place of cones
    IslandSystem system_;
    ActiveSet active_set_;
    ProximalNewton proximal_newton_;
    numeric::Anderson ahead_;
    std::vector<std::size_t> contacts_;   ///< their blocks, here and there
    std::vector<double> radii_, normals_; ///< n', n by contact
    std::vector<IslandRow> rows_;         ///< what a way starts from, should it fail
    std::vector<IslandBlock> blocks_;
    int factorisations_ = 0;
};

} // namespace ductile::solve

#ifndef DUCTILE_COMPILED
#include "ductile/solve/lagged_friction.ipp"
#endif
