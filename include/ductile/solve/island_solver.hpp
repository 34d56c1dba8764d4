// SPDX-License-Identifier: MIT
//
// Solves an island: all rows of joints, contacts and friction at once.
//
//   IslandSolver solver;
//   const IslandReport report = solver.solve(island);   // impulses, sides, velocities: in the
//   island
//
// The answer is that of a convex problem, and unique with the softness of its rows:
//
//   minimise 1/2 vᵀ M v + 1/2 xᵀ C x - bᵀ x,   v = M⁻¹ Jᵀ x,   x within bounds and blocks
//
// Rows without a softness of their own are rigid: the active set takes out what the least softness
// gives. Among rows that repeat each other the shares stay those of the softness.
//
// Friction is more. Warm active set first (active_set.hpp), contacts by Coulomb's law itself
// (coulomb_form.hpp). Where that does not settle, as in jams, convex problems until they repeat
// themselves: with slips that shift what the normals are asked for (contact_form.hpp), or with the
// normals of one round as the friction's bounds of the next (lagged_friction.hpp); at last Newton
// on a convex function (proximal_newton.hpp), polished by the active set. At the end the
// certificate, of Coulomb's law itself.
//
// What is not solved says so, to all joints of the island too where it is much
// (world/island_joint.hpp): their own rows may be met to the last digit under the wrong forces of a
// contact. Of the answer, the start and no impulse at all the one is taken that leaves the
// least energy: where bounds enclose zero an island never gains any, whatever went wrong. Input
// that is not finite gets no impulse and `solved == false`.
//
// Cost: O(bodies + rows) for chains and trees, some n^1.2 for frames. 1 factorisation where no row
// changes sides.
#pragma once

#include <memory>
#include <vector>

#include "ductile/solve/active_set.hpp"
#include "ductile/solve/certificate.hpp"
#include "ductile/solve/forest_solver.hpp"
#include "ductile/solve/interior_point.hpp"
#include "ductile/solve/island.hpp"
#include "ductile/solve/island_report.hpp"
#include "ductile/solve/island_system.hpp"
#include "ductile/solve/lagged_friction.hpp"
#include "ductile/solve/proximal_newton.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::solve {

/// The way of any island. Not thread-safe.
class GeneralSolver {
  public:
    IslandReport solve(Island& island);

  private:
    bool polished(IslandReport& report);
    bool coulomb(IslandReport& report);
    bool lagged(IslandReport& report, const std::vector<double>& from);
    void fall_back(IslandReport& report, bool touch);
    void certify(IslandReport& report);
    void give_up(IslandReport& report);
    void begin_from(const std::vector<double>& impulses);
    void put(const std::vector<double>& impulses);
    void take(std::vector<double>& impulses) const;

    IslandSystem system_;
    ActiveSet active_set_;
    LaggedFriction lagged_friction_;
    InteriorPoint interior_point_;
    ProximalNewton proximal_newton_;
    std::vector<double> start_, best_;
    std::vector<Side> sides_; ///< at the start, as are the blocks
    std::vector<IslandBlock> blocks_;
};

/// One per island that lasts: it keeps the topology. Not thread-safe.
class IslandSolver {
  public:
    /// Also leaves in the island whether it is solved.
    IslandReport solve(Island& island);

  private:
    [[nodiscard]] IslandReport answer(Island& island);

    std::unique_ptr<ForestSolver> forest_;
    std::unique_ptr<GeneralSolver> general_; ///< 4.5 kB that no single joint needs
};

} // namespace ductile::solve

#ifndef DUCTILE_COMPILED
#include "ductile/solve/island_solver.ipp"
#endif
