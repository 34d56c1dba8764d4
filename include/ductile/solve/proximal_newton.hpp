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

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "ductile/solve/block_form.hpp"
#include "ductile/solve/contact_slips.hpp"
#include "ductile/solve/fixed_sides.hpp"
#include "ductile/solve/island_system.hpp"

namespace ductile::solve {

/// Not thread-safe. Keeps room between solves.
class ProximalNewton {
  public:
    /// Leaves impulses, sides, states and shifts of the answer in the island. For the last digits
    /// the active set starts from there. `softness`: σ at first, of the rows' own effect [-].
    /// `careful`: slips are followed ahead only as long as that brings them closer. Most settle
    /// sooner if not, some only then.
    void solve(IslandSystem& system, double softness, bool careful) {
        constexpr double alike = 1e-9, last = 1e-14, stiffer = 0.1, closer = 0.01;
        // of the largest velocity
        constexpr double roughly = 1e-3, fair = 1e-6, well = 1e-9, apart = 1e-8;
        constexpr int most = 30;
        system_ = &system;
        iterations_ = 0;
        const std::vector<IslandRow>& rows = system.island().rows;
        rows_.clear();
        impulses_.clear();
        for (std::size_t i = 0; i < rows.size(); ++i) {
            rows_.push_back({system.rows()[i].compliance, system.rows()[i].metric});
            impulses_.push_back(rows[i].impulse);
        }
        slips_.begin(system);
        double enough = roughly, before = roughly;
        double least_apart = std::numeric_limits<double>::infinity();
        Round newton = Round::not_ended;
        for (int round = 0; round < most; ++round) {
            soften(softness);
            if (newton == Round::ended) predict();
            newton = minimise(enough);
            if (newton == Round::no_use) break;
            see();
            respond(); // sides and states
            const double left = std::max(given(), slips_.read(system)) / system.scale();
            const bool there = left <= well && enough <= well;
            const bool slow = softness <= last && left <= fair && left > before / 2;
            if (there ? apart_ <= apart || !(apart_ < least_apart / 2) : slow) break;
            if (there) least_apart = apart_;
            if (softness <= alike && !(careful && left > before)) {
                slips_.follow_ahead(system);
            } else {
                slips_.follow(system);
            }
            before = left;
            if (newton == Round::not_ended) { // once more, from where it came to
                enough = std::max(enough, closer * left);
                continue;
            }
            if (there) { // the less σ, the more impulses follow from a velocity's last digits
                enough *= stiffer;
                continue;
            }
            softness = std::max(stiffer * softness, last);
            enough = std::clamp(closer * left, well, roughly);
        }
        see();
        respond(); // sides and states
        restore();
        for (std::size_t i = 0; i < rows.size(); ++i) {
            system.island().rows[i].impulse = impulses_[i];
        }
        system.update_velocities();
        system.update_residuals();
    }

    [[nodiscard]] int iterations() const noexcept { return iterations_; } ///< of the last solve

  private:
    struct Row {
        double compliance, metric;     ///< as they were
        double softness = 0, from = 0; ///< σ, x'
    };

    enum class Round { ended, not_ended, no_use };
    /// Rows that give nothing where they are, and more than they do elsewhere.
    void soften(double softness) {
        for (std::size_t i = 0; i < rows_.size(); ++i) {
            IslandSystem::Row& row = system_->rows()[i];
            if (!(row.own > 0)) continue;
            const double soft = softness * (rows_[i].metric - rows_[i].compliance);
            row.compliance = row.metric = rows_[i].compliance + soft;
            row.kept = soft * impulses_[i] / row.compliance;
            rows_[i].softness = soft;
            rows_[i].from = impulses_[i];
        }
    }
    /// Largest velocity that rows gave since they were softened.
    [[nodiscard]] double given() const {
        double most = 0;
        for (std::size_t i = 0; i < rows_.size(); ++i) {
            most = std::max(most, rows_[i].softness * std::abs(impulses_[i] - rows_[i].from));
        }
        return most;
    }
    /// A step with the sides of the last round.
    void predict() {
        see();
        set_tangents(*system_);
        static_cast<void>(set_right_sides(*system_));
        ++iterations_;
        if (!system_->factor()) return;
        system_->step();
        for (std::size_t i = 0; i < impulses_.size(); ++i) {
            impulses_[i] += system_->rows()[i].change;
        }
    }
    /// Newton until the velocities stay, `enough` of the largest.
    [[nodiscard]] Round minimise(double enough) {
        constexpr int most = 15;
        std::vector<IslandRow>& rows = system_->island().rows;
        see();
        respond();
        for (int i = 0; i < most; ++i) {
            ++iterations_;
            for (std::size_t k = 0; k < rows.size(); ++k) {
                system_->rows()[k].right = 0;
                system_->rows()[k].extra = rows[k].impulse - impulses_[k];
            }
            if (!system_->factor()) return Round::no_use;
            system_->step();
            start_ = impulses_;
            change_.clear();
            speed_.clear();
            double first = 0, fastest = 0;
            for (std::size_t k = 0; k < rows.size(); ++k) {
                const IslandSystem::Row& work = system_->rows()[k];
                change_.push_back(work.change);
                speed_.push_back(-work.rest);
                first += speed_[k] * (impulses_[k] - rows[k].impulse);
                if (!(std::abs(work.rest) <= fastest)) fastest = std::abs(work.rest);
            }
            if (std::isnan(fastest)) return Round::no_use;
            if (!(first < 0)) {
                apart_ = 0;
                return Round::ended;
            }
            if (!(fastest > enough * system_->scale())) {
                static_cast<void>(slope(1)); // whole: impulses that balance each other follow too
                apart_ = 0;
                for (std::size_t k = 0; k < rows.size(); ++k) {
                    const double off = std::abs(rows[k].impulse - impulses_[k]);
                    apart_ = std::max(apart_, system_->rows()[k].own * off / system_->scale());
                }
                return Round::ended;
            }
            search(first);
        }
        return Round::not_ended;
    }
    /// x(v) in place of the impulses, and the tangents there.
    void respond() {
        Island& island = system_->island();
        for (std::size_t i = 0; i < island.rows.size(); ++i) {
            if (!system_->alone(i)) continue;
            IslandRow& row = island.rows[i];
            IslandSystem::Row& work = system_->rows()[i];
            row.side = Side::free;
            work.weight = 0;
            if (work.own == 0) {
                row.impulse = 0;
                continue;
            }
            const double aim = row.impulse + work.residual / work.compliance;
            if (aim <= row.lower) row.side = Side::lower;
            if (aim >= row.upper) row.side = Side::upper;
            row.impulse = std::min(std::max(aim, row.lower), row.upper);
            if (row.side == Side::free) work.weight = 1 / work.compliance;
        }
        for (std::size_t k = 0; k < island.blocks.size(); ++k) {
            const BlockView view = view_of(*system_, k);
            with_form(view, [&view](auto form) { form.respond(view); });
        }
    }
    /// dvᵀ (M v - Jᵀ x(v)) after a share of the step.
    [[nodiscard]] double slope(double share) {
        for (std::size_t i = 0; i < start_.size(); ++i) {
            impulses_[i] = start_[i] + share * change_[i];
        }
        see();
        respond();
        double sum = 0;
        for (std::size_t i = 0; i < start_.size(); ++i) {
            sum += speed_[i] * (impulses_[i] - system_->island().rows[i].impulse);
        }
        return sum;
    }
    /// Goes along the step to where the function is least; `first`: its slope at the start, < 0.
    /// Leaves x(v) and the tangents there.
    void search(double first) {
        constexpr int most = 30;
        constexpr double near = 0.2; // of the first slope
        double low = 0, at_low = first, high = 1, at_high = slope(1);
        if (!(at_high > -near * first)) return;
        for (int i = 0; i < most; ++i) {
            double t = low + (high - low) * at_low / (at_low - at_high);
            const double edge = 0.1 * (high - low);
            t = std::clamp(t, low + edge, high - edge);
            const double at = slope(t);
            if (!(std::abs(at) > -near * first)) return;
            (at < 0 ? low : high) = t;
            (at < 0 ? at_low : at_high) = at;
        }
    }
    /// Velocities and residuals of the impulses.
    void see() {
        std::vector<IslandRow>& rows = system_->island().rows;
        for (std::size_t i = 0; i < rows.size(); ++i) rows[i].impulse = impulses_[i];
        system_->update_velocities();
        system_->update_residuals();
    }
    void restore() {
        for (std::size_t i = 0; i < rows_.size(); ++i) {
            system_->rows()[i].compliance = rows_[i].compliance;
            system_->rows()[i].metric = rows_[i].metric;
            system_->rows()[i].kept = 0;
        }
    }

    IslandSystem* system_ = nullptr;
    std::vector<Row> rows_;
    std::vector<double> start_, change_, speed_; ///< x, dx, J dv of a step
    std::vector<double> impulses_;               ///< x that belongs to v
    double apart_ = 0; ///< what those lack to x(v), as a velocity, of the scale [-]
    ContactSlips slips_;
    int iterations_ = 0;
};

} // namespace ductile::solve
