// SPDX-License-Identifier: MIT
//
// A constraint whose rows are its own: it states them to an island (solve/island.hpp), or to ODE
// where something in its island is ODE's.
#pragma once

#include "ductile/solve/island.hpp"
#include "ductile/world/island_joint.hpp"

namespace ductile::ode {

/// Around ODE's step, after `prepare`: either open_rows and close_rows, or make_rows.
class IslandRows {
  public:
    /// True where the constraint takes part in the coming step.
    [[nodiscard]] virtual bool acts() const = 0;
    /// False while it swings or flows: its bodies are not to fall asleep.
    [[nodiscard]] virtual bool rests() const = 0;
    /// Adds the rows of a step of `dt` [s] between its bodies A and B.
    virtual void open_rows(solve::Island& island, const IslandSeat& a, const IslandSeat& b,
                           double dt) = 0;
    /// The island is solved: asks for what fits bodies that leave the part so (turn_rows). True
    /// where that is something else.
    [[nodiscard]] virtual bool turn_rows(solve::Island& island, const IslandSeat& a,
                                         const IslandSeat& b, double dt) = 0;
    /// The island is solved: the impulses of those rows become forces on the bodies.
    virtual void close_rows(const solve::Island& island, double dt) = 0;
    /// Gives the rows to ODE.
    virtual void make_rows(double dt) = 0;

  protected:
    IslandRows() = default;
    ~IslandRows() = default;
};

} // namespace ductile::ode
