// SPDX-License-Identifier: MIT
//
// A constraint that states its rows to an island (solve/island.hpp) by itself, without a detour
// through Bullet's fields: in double, whatever Bullet's precision, with compliance, surfaces and
// all reactions.
#pragma once

#include "ductile/solve/island.hpp"
#include "ductile/world/island_joint.hpp"

namespace ductile::bullet {

/// Base beside btTypedConstraint.
class IslandRows {
  public:
    /// Adds the rows of the coming tick of `tick` [s] between its bodies A and B; `erp`: the
    /// world's.
    virtual void open_rows(solve::Island& island, const IslandSeat& a, const IslandSeat& b,
                           double tick, double erp) = 0;
    /// The island is solved: asks for what fits the velocities with which its bodies leave the
    /// part. True where that is something else.
    [[nodiscard]] virtual bool turn_rows(solve::Island& /*island*/, const IslandSeat& /*a*/,
                                         const IslandSeat& /*b*/) {
        return false;
    }
    /// The island is solved: takes the impulses of those rows.
    virtual void close_rows(const solve::Island& island) = 0;

  protected:
    IslandRows() = default;
    ~IslandRows() = default;
};

} // namespace ductile::bullet
