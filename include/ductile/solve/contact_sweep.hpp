// SPDX-License-Identifier: MIT
//
// The patient way through the contacts of an island: one after the other by Coulomb's own law, with
// the joints between them condensed.
//
//   round   joints solved to the end with the contacts' impulses held (active_set.hpp), convex
//           G = J_c K⁻¹ J_cᵀ + C_c: what contacts do to each other through bodies and through the
//           joints as they flow now
//           sweeps: each contact solved alone, the others held, until none moves any more; each
//           from where the last ones point (numeric/anderson.hpp)
//
// A round in which no joint changed sides is the last. Nothing is assumed of the sides of contacts,
// and no slip has to settle: it finds answers where the fixed point of contact_form.hpp wanders.
// Slower: one solve of the factors for each row of a contact, and as many products a sweep as
// contacts feel each other through a body or a joint. What it may cost is the caller's to say.
//
// Source: non-smooth contact dynamics, Jean (1999), doi:10.1016/S0045-7825(98)00383-1; on its
// robustness beside other methods: Acary, Brémond & Huber (2018), doi:10.1007/978-3-319-75972-2_10.
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
class ContactSweep {
  public:
    /// From the impulses in the island; leaves impulses and states of its answer there. `joints`:
    /// what solves them, and `safe` where that does not; `effort`: products that it
    /// may still cost, less what it took.
    void solve(IslandSystem& system, ActiveSet& joints, ProximalNewton& safe, double& effort);

    [[nodiscard]] int sweeps() const noexcept { return sweeps_; } ///< of the last solve

  private:
    struct Entry {
        std::size_t row = 0; ///< in rows_
        double effect = 0;   ///< entry of G
    };

    void condense();
    void sweep_contacts(double& effort);
    void go_ahead();
    void tell_impulses(std::vector<double>& to) const;
    void feel(std::size_t row, double by);
    [[nodiscard]] double solve_contact(std::size_t contact);
    void tell_states();

    IslandSystem* system_ = nullptr;
    std::vector<std::size_t> contacts_; ///< their blocks
    std::vector<std::size_t> rows_;     ///< of all of them, in order
    std::vector<std::size_t> first_;    ///< of each in rows_
    std::vector<Entry> entries_;        ///< of G that are not zero, column by column
    std::vector<std::size_t> column_;   ///< where each begins; rows_.size() + 1
    std::vector<Matrix6<double>> own_;  ///< G of each contact on itself
    std::vector<double> residual_;      ///< b - J v - C x
    numeric::Anderson ahead_;
    std::vector<double> from_, to_; ///< impulses before a sweep and after it
    int sweeps_ = 0;
};

} // namespace ductile::solve

#ifndef DUCTILE_COMPILED
#include "ductile/solve/contact_sweep.ipp"
#endif
