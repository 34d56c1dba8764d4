// SPDX-License-Identifier: MIT
//
// A safe way through an island for sets of any shape: bounds, ellipsoids, cones, surfaces with
// corners. Rows are held near the impulses x' that they have, and those follow:
//
//   x' <- argmin 1/2 vᵀ M v + 1/2 xᵀ C x - bᵀ x + 1/2 (x - x')ᵀ σ (x - x'),   v = M⁻¹ Jᵀ x
//
// By its dual each round is a smooth convex function of the velocities alone,
//
//   1/2 vᵀ M v + Σ φ(b - J v),   x(v) = Π((u + σ x')/(C + σ)) in the metric C + σ,   M v = Jᵀ x(v)
//
// on which Newton with a line search cannot fail: along a step its slope rises, so that the line
// search is a root of the slope. σ falls from a tenth of the rows' own effect to below the softness
// of any row while x' becomes better, so that few rows change sides in a round; at the answer x =
// x', and σ has no part in it.
//
// Where σ fell, a round starts with a step that leaves sides and states as the last one had them:
// rows that gave would jump to their bounds with less σ, all along a chain, and Newton would bring
// them back one by one.
//
// The shifts of contacts follow their slips from round to round.
//
// Source: proximal method of multipliers: Rockafellar (1976), doi:10.1287/moor.1.2.97; Newton on
// its rounds: Li, Sun & Toh (2018), doi:10.1137/16M1097572; as a function of the velocities:
// Castro, Permenter & Han (2022), doi:10.1109/TRO.2022.3209077.
#pragma once

#include <vector>

#include "ductile/solve/contact_slips.hpp"
#include "ductile/solve/island_system.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::solve {

/// Not thread-safe. Keeps room between solves.
class ProximalNewton {
  public:
    /// Leaves impulses, sides, states and shifts of the answer in the island. For the last digits
    /// the active set starts from there. `softness`: σ at first, of the rows' own effect [-].
    /// `careful`: slips are followed ahead only as long as that brings them closer. Most settle
    /// sooner if not, some only then.
    void solve(IslandSystem& system, double softness, bool careful);

    [[nodiscard]] int iterations() const noexcept { return iterations_; } ///< of the last solve

  private:
    struct Row {
        double compliance, metric;     ///< as they were
        double softness = 0, from = 0; ///< σ, x'
    };

    enum class Round { ended, not_ended, no_use };
    void soften(double softness);
    [[nodiscard]] double given() const;
    void predict();
    [[nodiscard]] Round minimise(double enough);
    void respond();
    [[nodiscard]] double slope(double share);
    void search(double first);
    void see();
    void restore();

    IslandSystem* system_ = nullptr;
    std::vector<Row> rows_;
    std::vector<double> start_, change_, speed_; ///< x, dx, J dv of a step
    std::vector<double> impulses_;               ///< x that belongs to v
    double apart_ = 0; ///< what those lack to x(v), as a velocity, of the scale [-]
    ContactSlips slips_;
    int iterations_ = 0;
};

} // namespace ductile::solve

#ifndef DUCTILE_COMPILED
#include "ductile/solve/proximal_newton.ipp"
#endif
