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

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "ductile/numeric/anderson.hpp"
#include "ductile/solve/block_form.hpp"
#include "ductile/solve/contact_slips.hpp"
#include "ductile/solve/fixed_sides.hpp"
#include "ductile/solve/island_system.hpp"

namespace ductile::solve {

namespace detail {

inline constexpr double exactness = 1e-12;  ///< of the largest velocity: a row is solved
inline constexpr double sufficient = 1e-7;  ///< the same where round-off allows no more
inline constexpr double acceptance = 1e-11; ///< of the largest velocity: a row is on the right side
inline constexpr double settled = 1e-7;     ///< of the largest velocity: a slip has settled

/// What rows give adds up along a chain, as round-off does not [-].
[[nodiscard]] inline double adds_up(const Island& island) noexcept {
    constexpr double few = 10; // bodies
    return std::max(1.0, double(island.bodies.size()) / few);
}

} // namespace detail

/// Not thread-safe. Keeps room between solves.
class ActiveSet {
  public:
    /// Rounds without fewer rows in the wrong place; `brief`: where the way that follows is short,
    /// with as few steps a round, as most that settle take.
    static constexpr int usual = 6, brief = 3;

    /// From the sides, impulses and multipliers in the island. True where each row is where it
    /// belongs; the impulses are then those of the answer, and velocities and residuals belong to
    /// them. `near`: all but a few are there already.
    [[nodiscard]] bool solve(IslandSystem& system, bool near = false, int patience = usual) {
        constexpr int most = 30; // rounds
        system_ = &system;
        rounds_ = 0;
        steps_ = patience == brief ? few_steps : usual_steps;
        begin();
        near_ = cautious_ = near;
        int fewest = std::numeric_limits<int>::max(), left = patience;
        bool same = false; // all sides are as they were, and the factors of use
        while (rounds_ < most) {
            ++rounds_;
            place();
            const bool solved = solve_free_rows(same);
            // before a guess takes the place of what was solved
            const double moved = slips_.read(system);
            const int wrong = change_over() + (solved ? 0 : 1);
            if (wrong == 0 && moved <= detail::settled * system.scale()) return true;
            same = wrong == 0;
            if (wrong == 0) { // contacts alone have to settle
                slips_.follow_ahead(system);
                continue;
            }
            if (solved) {
                slips_.follow(system);
            } else {
                slips_.restart();
            }
            if (wrong < fewest) {
                fewest = wrong;
                left = patience;
            } else if (--left <= 0) {
                if (cautious_ || wrong_rows_ == 0) return false;
                cautious_ = true;
                fewest = std::numeric_limits<int>::max();
                left = most;
            }
        }
        return false;
    }

    [[nodiscard]] int rounds() const noexcept { return rounds_; } ///< of the last solve

  private:
    static constexpr int few_steps = 4, usual_steps = 12; ///< of Newton, a round

    /// Sides that are none, and what is not known of blocks on their surface.
    void begin() {
        Island& island = system_->island();
        for (IslandRow& row : island.rows) {
            const bool bounded = row.side == Side::lower   ? std::isfinite(row.lower)
                                 : row.side == Side::upper ? std::isfinite(row.upper)
                                                           : true;
            if (!bounded) row.side = Side::free;
        }
        const auto unknown = [](const IslandBlock& block) {
            return block.state == BlockState::apex ||
                   (block.state == BlockState::surface && block.multiplier == 0);
        };
        hardens_ = true;
        if (std::any_of(island.blocks.begin(), island.blocks.end(), unknown)) {
            system_->update_velocities();
            system_->update_residuals();
        }
        for (std::size_t k = 0; k < island.blocks.size(); ++k) {
            const BlockView view = view_of(*system_, k);
            if (view.on_surface() && view.block.multiplier == 0) {
                with_form(view, [&view](auto form) { form.guess(view); });
            }
        }
        slips_.begin(*system_);
        static_cast<void>(slips_.read(*system_));
        slips_.follow(*system_);
    }
    void place() {
        Island& island = system_->island();
        for (std::size_t i = 0; i < island.rows.size(); ++i) {
            IslandRow& row = island.rows[i];
            if (!system_->alone(i)) continue;
            if (system_->rows()[i].own == 0) {
                row.impulse = 0;
            } else if (row.lower >= row.upper || row.side == Side::lower) {
                row.impulse = row.lower;
            } else if (row.side == Side::upper) {
                row.impulse = row.upper;
            }
        }
        for (std::size_t k = 0; k < island.blocks.size(); ++k) {
            const BlockView view = view_of(*system_, k);
            with_form(view, [&view](auto form) { form.place(view); });
        }
    }
    /// To round-off, with the sides as they are; `factored`: by factors that were made for these
    /// sides. What the factors were not made for, a surface that a block moved along, calls for
    /// others; round-off does not.
    [[nodiscard]] bool solve_free_rows(bool factored) {
        constexpr double slow = 0.1, stalled = 0.5;
        const std::vector<IslandBlock>& blocks = system_->island().blocks;
        const bool curved = std::any_of(blocks.begin(), blocks.end(), [](const IslandBlock& block) {
            return block.state == BlockState::surface;
        });
        if (!factored) set_tangents(*system_);
        Stay stay = Stay::all;
        double worst = 0, before = std::numeric_limits<double>::infinity();
        kept_.restart();
        least_given_ = last_given_ = before;
        slow_ = 0;
        for (int step = 0;; ++step) {
            system_->update_velocities();
            system_->update_residuals();
            worst = set_right_sides(*system_);
            bool again = false;
            if (worst <= exact()) {
                if (!harden()) return true;
                again = true;
            } else if (stay == Stay::left || std::isnan(worst) || step >= steps_ ||
                       (step > 1 && !curved && worst > stalled * before)) {
                if (stay != Stay::all ||
                    !(least_given_ < std::numeric_limits<double>::infinity())) {
                    break;
                }
                end_hardening(); // round-off allows no more
                again = true;
            }
            if (again) {
                before = std::numeric_limits<double>::infinity();
                step = 0;
                continue;
            }
            if (!factored || (curved && !(worst < slow * before))) {
                if (step > 0) { // else they are those of now
                    set_tangents(*system_);
                    static_cast<void>(set_right_sides(*system_));
                }
                if (!system_->factor()) return false;
                factored = true;
            }
            before = worst;
            system_->step();
            stay = take_step(*system_, near_);
        }
        const double enough = steps_ == usual_steps
                                  ? std::max(exact(), detail::sufficient * system_->scale())
                                  : exact();
        return stay == Stay::all && worst <= enough;
    }
    /// Takes out what rigid rows give: they give nothing at the impulses that are kept, and are
    /// kept at those of the last answer, accelerated. False where nothing is left to do. Where rows
    /// contradict each other what they give does not fade, and the best so far stays.
    [[nodiscard]] bool harden() {
        constexpr int most_slow = 6;
        constexpr double stands = 0.999; // what hardly changes is not to be extrapolated
        if (!hardens_) return false;
        const double given = system_->given();
        if (given <= exact() / detail::adds_up(system_->island())) return false;
        system_->read_rigid(keep_, impulses_);
        if (given < least_given_ / 2) {
            least_given_ = given;
            best_kept_ = keep_;
            slow_ = 0;
        } else if (++slow_ > most_slow || std::abs(given - last_given_) < (1 - stands) * given) {
            end_hardening();
            return true;
        }
        last_given_ = given;
        kept_.advance(keep_, impulses_);
        system_->keep(keep_);
        return true;
    }
    /// Back to the best so far.
    void end_hardening() {
        system_->keep(best_kept_);
        hardens_ = false;
        least_given_ = std::numeric_limits<double>::infinity();
    }
    /// Where a row is solved, and where it is on the right side [m/s | rad/s].
    [[nodiscard]] double exact() const noexcept {
        return std::max(system_->round_off(4), detail::exactness * system_->scale());
    }
    [[nodiscard]] double accepted() const noexcept {
        return std::max(system_->round_off(40), detail::acceptance * system_->scale());
    }
    [[nodiscard]] int change_over() {
        Island& island = system_->island();
        int wrong = 0;
        double worst = 0;
        for (std::size_t i = 0; cautious_ && i < island.rows.size(); ++i) {
            if (system_->alone(i)) worst = std::max(worst, where(i).off);
        }
        for (std::size_t i = 0; i < island.rows.size(); ++i) {
            if (!system_->alone(i)) continue;
            const Place place = where(i);
            wrong += place.side != island.rows[i].side;
            if (place.off >= worst / 2) island.rows[i].side = place.side;
        }
        wrong_rows_ = wrong;
        const double least = accepted();
        for (std::size_t k = 0; k < island.blocks.size(); ++k) {
            const BlockView view = view_of(*system_, k);
            wrong += with_form(view, [&](auto form) { return form.change_over(view, least); });
        }
        return wrong;
    }
    struct Place {
        Side side = Side::free;
        double off = 0; ///< [m/s | rad/s]
    };
    /// Where a row belongs, and by how much it is wrong where it is.
    [[nodiscard]] Place where(std::size_t i) const {
        const IslandRow& row = system_->island().rows[i];
        const IslandSystem::Row& work = system_->rows()[i];
        if (work.own == 0 || !(row.lower < row.upper)) return {row.side, 0};
        const double least = accepted();
        if (row.side != Side::free) {
            const double off =
                work.share * (row.side == Side::lower ? work.residual : -work.residual);
            return {off > least ? Side::free : row.side, off};
        }
        double cap = 0;
        if (std::isfinite(row.lower)) cap = std::abs(row.lower);
        if (std::isfinite(row.upper)) cap = std::max(cap, std::abs(row.upper));
        const double slack = 1e-10 * cap + least / work.own;
        if (row.impulse < row.lower - slack) {
            return {Side::lower, (row.lower - row.impulse) * work.own};
        }
        if (row.impulse > row.upper + slack) {
            return {Side::upper, (row.impulse - row.upper) * work.own};
        }
        return {Side::free, 0};
    }

    IslandSystem* system_ = nullptr;
    ContactSlips slips_;
    numeric::Anderson kept_;
    std::vector<double> keep_, best_kept_, impulses_; ///< of rigid rows
    int rounds_ = 0;
    int steps_ = 0;                           ///< of Newton in a round, at most
    double least_given_ = 0, last_given_ = 0; ///< by a rigid row, with these sides [m/s | rad/s]
    int slow_ = 0;                            ///< steps since
    bool hardens_ = false;                    ///< rigid rows are to give nothing
    bool cautious_ = false;                   ///< rows that are most wrong go first
    bool near_ = false;                       ///< blocks leave their surface by and by
    int wrong_rows_ = 0;                      ///< that belong to no block
};

} // namespace ductile::solve
