// SPDX-License-Identifier: MIT
//
// The fast way through an island: guess which rows are at their bounds and which blocks are on
// their surface, solve what is left exactly, look again.
//
//   round   rows at a bound: x = bound; blocks on their surface: x there
//           Newton on the rest, with one factorisation as long as it converges by a tenth a step,
//           that of the last round where no side changed
//           each row and block looks where it belongs; those that are wrong change over
//           contacts that slide take the slip of now for their shift (contact_form.hpp),
//           accelerated
//
// Where a row belongs. In the metric d = J M⁻¹ Jᵀ + C of its own the answer is a projection,
// x = Π(x + r/d), r = b - J v - C x: inside where x + r/d is inside, at the bound or on the surface
// otherwise. A block that comes to its surface starts from there.
//
// From the sides of the last step it takes one round where nothing changed. It may go in circles,
// where many rows change over together: then those alone that are most wrong do, and where the
// rounds end without an answer proximal_newton.hpp has the word. From near the answer it does so
// from the start, and blocks leave their surface by and by, as those that leave at once come back.
//
// Source: block principal pivoting (Júdice & Pires 1994, doi:10.1016/0305-0548(94)90106-6).
#pragma once

#include <vector>

#include "ductile/numeric/anderson.hpp"
#include "ductile/solve/contact_slips.hpp"
#include "ductile/solve/island_system.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::solve {

/// Not thread-safe. Keeps room between solves.
class ActiveSet {
  public:
    /// Rounds without fewer rows in the wrong place; `brief`: where the way that follows is short.
    static constexpr int usual = 6, brief = 3;

    /// From the sides, impulses and multipliers in the island. True where each row is where it
    /// belongs; the impulses are then those of the answer, and velocities and residuals belong to
    /// them. `near`: all but a few are there already.
    [[nodiscard]] bool solve(IslandSystem& system, bool near = false, int patience = usual);

    [[nodiscard]] int rounds() const noexcept { return rounds_; } ///< of the last solve

  private:
    void begin();
    void place();
    [[nodiscard]] bool solve_free_rows(bool factored);
    [[nodiscard]] bool harden();
    void end_hardening();
    [[nodiscard]] double exact() const noexcept;
    [[nodiscard]] double accepted() const noexcept;
    [[nodiscard]] int change_over();
    struct Place {
        Side side = Side::free;
        double off = 0; ///< [m/s | rad/s]
    };
    [[nodiscard]] Place where(std::size_t row) const;

    IslandSystem* system_ = nullptr;
    ContactSlips slips_;
    numeric::Anderson kept_;
    std::vector<double> keep_, best_kept_, impulses_; ///< of rigid rows
    int rounds_ = 0;
    double least_given_ = 0, last_given_ = 0; ///< by a rigid row, with these sides [m/s | rad/s]
    int slow_ = 0;                            ///< steps since
    bool hardens_ = false;                    ///< rigid rows are to give nothing
    bool cautious_ = false;                   ///< rows that are most wrong go first
    bool near_ = false;                       ///< blocks leave their surface by and by
    int wrong_rows_ = 0;                      ///< that belong to no block
};

} // namespace ductile::solve

#ifndef DUCTILE_COMPILED
#include "ductile/solve/active_set.ipp"
#endif
