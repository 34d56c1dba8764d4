// SPDX-License-Identifier: MIT
//
// The slips of an island's contacts, and what their normal rows are asked less for them
// (contact_form.hpp): a fixed point, shift = slip, that rounds of a solver look for.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "ductile/numeric/anderson.hpp"
#include "ductile/solve/contact_form.hpp"
#include "ductile/solve/island_system.hpp"

namespace ductile::solve {

/// Not thread-safe. Keeps room between solves.
class ContactSlips {
  public:
    /// With the shifts as they are in the system.
    void begin(IslandSystem& system) {
        ahead_.restart();
        shifts_.clear();
        each(system, [this](const BlockView& view) { shifts_.push_back(view.work[0].shift); });
    }
    /// The slips of now, of open contacts too; the largest that differs from its shift [m/s].
    [[nodiscard]] double read(IslandSystem& system) {
        slips_.clear();
        double moved = 0;
        each(system, [&](const BlockView& view) {
            const double slip = ContactForm::slip(view);
            moved = std::max(moved, std::abs(slip - shifts_[slips_.size()]));
            slips_.push_back(slip);
        });
        return moved;
    }
    /// Those read become the shifts.
    void follow(IslandSystem& system) {
        ahead_.restart();
        shifts_ = slips_;
        shift(system);
    }
    /// The same, accelerated: since the last restart the problem was one, with other shifts.
    void follow_ahead(IslandSystem& system) {
        ahead_.advance(shifts_, slips_);
        shift(system);
    }

    void restart() noexcept { ahead_.restart(); }

  private:
    template <class Call>
    static void each(IslandSystem& system, const Call& call) {
        for (std::size_t k = 0; k < system.island().blocks.size(); ++k) {
            const BlockView view = view_of(system, k);
            if (view.block.kind == BlockKind::contact && !view.tangent.coulomb) call(view);
        }
    }
    void shift(IslandSystem& system) {
        std::size_t next = 0;
        each(system, [&](const BlockView& view) {
            double& shift = shifts_[next++];
            shift = std::max(shift, 0.0);
            view.work[0].shift = shift;
        });
    }

    numeric::Anderson ahead_;
    std::vector<double> shifts_, slips_; ///< of contacts, in order
};

} // namespace ductile::solve
