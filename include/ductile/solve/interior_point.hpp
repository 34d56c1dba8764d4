// SPDX-License-Identifier: MIT
//
// The safe way through an island: a primal-dual interior point method. 10 to 20 factorisations
// whatever the stiffness and from whatever start; it cannot go in circles.
//
//   rows     r + z_l - z_u = 0,   z_l (x - l) = τ c,  z_u (u - x) = τ c
//   blocks   r - λ ∇f = 0,        λ s = τ c,          s = -f(x),  f <= 0 the block's set, convex
//
// with r = b - J v - C x and v = M⁻¹ Jᵀ x at all times, and τ -> 0 by Mehrotra's predictor and
// corrector. c puts all products on one scale, that of a velocity: the width of a row's bounds, for
// a block what its first product is. Without it boxes of 1e-9 N s beside boxes of 1e4 N s
// underflow.
//
//   row      D = 1/(C + z_l/(x - l) + z_u/(u - x))
//   block    D = (C + λ ∇²f + (λ/s) ∇f ∇fᵀ)⁻¹, by its form (ellipsoid_form.hpp, contact_form.hpp)
//
// The shifts of contacts are those in the system; following the slips is the caller's loop.
//
// Source: Mehrotra (1992), doi:10.1137/0802028; Nocedal & Wright (2006), section 14.2.
#pragma once

#include <vector>

#include "ductile/solve/island_system.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::solve {

/// Not thread-safe. Keeps room between solves.
class InteriorPoint {
  public:
    /// Leaves impulses, sides and multipliers of the answer in the island. Its accuracy is some
    /// 1e-8 of the velocities: for the last digits the active set starts from there.
    /// `contacts_held`: they keep their impulses.
    void solve(IslandSystem& system, bool contacts_held = false);

    [[nodiscard]] int iterations() const noexcept { return iterations_; } ///< of the last solve

  private:
    struct Row {
        bool open = false, below = false, above = false;
        double cap = 1; ///< c
        double z_lower = 0, z_upper = 0;
        double to_lower = 1, to_upper = 1; ///< x - l, u - x
        double change_lower = 0, change_upper = 0;
        double first_change = 0, first_lower = 0, first_upper = 0; ///< of the predictor
    };
    struct Block {
        bool open = false;
        double cap = 1;                   ///< c
        double multiplier = 0, slack = 1; ///< λ, s
        double change = 0;                ///< of λ
        double first_change = 0, first_slack = 0;
    };
    /// What is left of the optimality conditions, of the largest velocity.
    struct Left {
        double residual = 0, gap = 0, mean = 0;
        int products = 0;
    };

    void start();
    [[nodiscard]] bool held(const IslandBlock& block) const noexcept {
        return contacts_held_ && block.kind == BlockKind::contact;
    }
    [[nodiscard]] Left look();
    void set_weights();
    /// Changes towards products of `target` c; `second`: with what the predictor left out. The
    /// share of them that reaches a bound.
    [[nodiscard]] double direct(double target, bool second);
    void set_right_sides(double target, bool second);
    [[nodiscard]] double reach();
    [[nodiscard]] double mean_after(double share, int products) const;
    void keep_predictor();
    void move(double share);
    void tell_sides();

    IslandSystem* system_ = nullptr;
    std::vector<Row> rows_;
    std::vector<Block> blocks_;
    std::vector<double> best_;
    int iterations_ = 0;
    bool contacts_held_ = false;
};

} // namespace ductile::solve

#ifndef DUCTILE_COMPILED
#include "ductile/solve/interior_point.ipp"
#endif
