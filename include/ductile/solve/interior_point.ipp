// SPDX-License-Identifier: MIT
//
// Bodies of interior_point.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "ductile/solve/certificate.hpp"
#include "ductile/solve/ellipsoid_form.hpp"
#include "ductile/solve/interior_point.hpp"

namespace ductile::solve {

DUCTILE_INLINE bool InteriorPoint::serves(const Island& island) noexcept {
    return std::all_of(island.blocks.begin(), island.blocks.end(),
                       [](const IslandBlock& block) { return block.kind == BlockKind::ellipsoid; });
}

DUCTILE_INLINE void InteriorPoint::solve(IslandSystem& system) {
    constexpr int most = 40;
    constexpr double well = 1e-9;   // of the largest velocity
    constexpr double inside = 0.99; // of the way to the nearest bound
    constexpr double close = 0.1;
    constexpr double far = 0.3; // of a step: second-order terms of a shorter one mislead
    system_ = &system;
    begin();
    for (iterations_ = 0; iterations_ < most; ++iterations_) {
        measure();
        if (!(off() > well * system.scale())) break;
        set_tangents();
        if (!system.factor()) break;
        aim(0, false);
        system.step();
        read_changes();
        const double now = energy(0), share = std::min(1.0, reach());
        const double falls = now > 0 ? energy(share) / now : 0;
        // not far below what the residuals lack, or rows would stick to bounds on the way
        aim(std::max(falls * falls * falls * now, close * lacking()), share > far);
        system.step();
        read_changes();
        take(std::min(1.0, inside * reach()));
    }
    leave();
}

/// True of rows by themselves that can move.
DUCTILE_INLINE bool InteriorPoint::bounded(std::size_t i) const noexcept {
    const IslandRow& row = system_->island().rows[i];
    return system_->alone(i) && system_->rows()[i].own > 0 && row.lower < row.upper;
}

/// Inside all bounds and surfaces, with multipliers that fit.
DUCTILE_INLINE void InteriorPoint::begin() {
    constexpr double edge = 0.3; // of the room between bounds
    Island& island = system_->island();
    rows_.assign(island.rows.size(), {});
    blocks_.assign(island.blocks.size(), {});
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        IslandRow& row = island.rows[i];
        if (!system_->alone(i)) continue;
        if (!bounded(i)) {
            row.impulse = system_->rows()[i].own > 0 ? row.lower : 0;
            continue;
        }
        const bool low = std::isfinite(row.lower), high = std::isfinite(row.upper);
        const double room = edge * (low && high ? row.upper - row.lower
                                                : system_->scale() / system_->rows()[i].own);
        if (low) row.impulse = std::max(row.impulse, row.lower + room);
        if (high) row.impulse = std::min(row.impulse, row.upper - room);
        rows_[i].lower.there = low;
        rows_[i].upper.there = high;
    }
    for (std::size_t k = 0; k < blocks_.size(); ++k) {
        const BlockView v = view_of(*system_, k);
        for (int i = 0; i < v.count(); ++i) {
            if (!v.live(i)) v.row[i].impulse = 0;
            blocks_[k].there = blocks_[k].there || v.live(i);
        }
        const double most = (1 - edge) / std::sqrt(EllipsoidForm::square_gauge(v));
        for (int i = 0; most < 1 && i < v.count(); ++i) v.row[i].impulse *= most;
    }
    measure();
    const double energy = lacking();
    const auto open = [energy](Gap& gap, double least) {
        if (gap.there) gap.multiplier = std::max(energy / gap.left, least);
    };
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        open(rows_[i].lower, -system_->rows()[i].residual);
        open(rows_[i].upper, system_->rows()[i].residual);
    }
    for (std::size_t k = 0; k < blocks_.size(); ++k) {
        const BlockView v = view_of(*system_, k);
        double power = 0;
        for (int i = 0; i < v.count(); ++i) power += v.row[i].impulse * v.work[i].residual;
        open(blocks_[k], power);
    }
}

/// What residuals and multipliers differ by, of all rows, a share for each bound and surface: where
/// nothing is lacking yet others will ask for it [J].
DUCTILE_INLINE double InteriorPoint::lacking() const {
    double sum = 0;
    int count = 0;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        const IslandSystem::Row& work = system_->rows()[i];
        if (!system_->alone(i) || work.own == 0) continue;
        const auto& [lower, upper] = rows_[i];
        const double speed = std::abs(work.residual + lower.multiplier - upper.multiplier);
        double most = speed / work.metric;
        for (const Gap& gap : {lower, upper}) {
            if (gap.there) most = std::min(most, gap.left);
            count += gap.there;
        }
        sum += speed * most;
    }
    for (std::size_t k = 0; k < blocks_.size(); ++k) {
        const BlockView v = view_of(*system_, k);
        for (int i = 0; i < v.count(); ++i) {
            if (!v.live(i)) continue;
            const double speed = std::abs(lack(k, i));
            sum += speed * std::min(speed / v.work[i].metric, v.size(i));
        }
        count += blocks_[k].there;
    }
    return std::max(sum / std::max(count, 1), std::numeric_limits<double>::min());
}

/// Velocities, residuals and what is left of the impulses.
DUCTILE_INLINE void InteriorPoint::measure() {
    constexpr double least = 1e-15; // round-off of a gauge
    system_->update_velocities();
    system_->update_residuals();
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        const IslandRow& row = system_->island().rows[i];
        rows_[i].lower.left = row.impulse - row.lower;
        rows_[i].upper.left = row.upper - row.impulse;
    }
    for (std::size_t k = 0; k < blocks_.size(); ++k) {
        const double square = EllipsoidForm::square_gauge(view_of(*system_, k));
        blocks_[k].left = std::max((1 - square) / 2, least);
    }
}

/// Residual of a live row of a block, less the flow that its multiplier says [m/s | rad/s].
DUCTILE_INLINE double InteriorPoint::lack(std::size_t k, int i) const noexcept {
    const BlockView v = view_of(*system_, k);
    const double normal = v.row[i].impulse / (v.size(i) * v.size(i));
    return v.work[i].residual - blocks_[k].multiplier * normal;
}

/// By its multiplier [m/s | rad/s].
DUCTILE_INLINE double InteriorPoint::flow(std::size_t k) const noexcept {
    const BlockView v = view_of(*system_, k);
    double flow = 0;
    for (int i = 0; i < v.count(); ++i) {
        if (!v.live(i)) continue;
        const double normal = std::abs(v.row[i].impulse) / (v.size(i) * v.size(i));
        flow = std::max(flow, v.work[i].share * blocks_[k].multiplier * normal);
    }
    return flow;
}

/// How far the answer is, surfaces by their gauge too: in a short step a whole strength gives next
/// to no velocity [m/s | rad/s].
DUCTILE_INLINE double InteriorPoint::off() const {
    double worst = certificate(*system_);
    for (std::size_t k = 0; k < blocks_.size(); ++k) {
        worst = std::max(worst, std::min(blocks_[k].left * system_->scale(), flow(k)));
    }
    return worst;
}

DUCTILE_INLINE auto InteriorPoint::way(std::size_t k) const noexcept -> Way {
    const BlockView v = view_of(*system_, k);
    Way of;
    for (int i = 0; i < v.count(); ++i) {
        if (!v.live(i)) continue;
        const double by = v.work[i].change / v.size(i);
        of.along += by * v.row[i].impulse / v.size(i);
        of.bend += by * by / 2;
    }
    return of;
}

/// The mean of τ after a share of the step [J].
DUCTILE_INLINE double InteriorPoint::energy(double share) const {
    double sum = 0;
    int count = 0;
    const auto see = [&](const Gap& gap, double change) {
        if (!gap.there) return;
        sum += (gap.left + change) * (gap.multiplier + share * gap.change);
        ++count;
    };
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        const double change = share * system_->rows()[i].change;
        see(rows_[i].lower, change);
        see(rows_[i].upper, -change);
    }
    for (std::size_t k = 0; k < blocks_.size(); ++k) {
        const Way of = way(k);
        see(blocks_[k], -share * (of.along + share * of.bend));
    }
    return count > 0 ? sum / count : 0;
}

DUCTILE_INLINE void InteriorPoint::set_tangents() {
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        if (!system_->alone(i)) continue;
        IslandSystem::Row& work = system_->rows()[i];
        double stiff = work.compliance;
        for (const Gap& gap : {rows_[i].lower, rows_[i].upper}) {
            if (gap.there) stiff += gap.multiplier / gap.left;
        }
        work.weight = bounded(i) ? 1 / stiff : 0;
    }
    for (std::size_t k = 0; k < blocks_.size(); ++k) {
        const BlockView v = view_of(*system_, k);
        const Gap& gap = blocks_[k];
        v.clear_terms();
        const double along = EllipsoidForm::set_weights(v, gap.multiplier);
        if (!gap.there) continue;
        v.tangent.terms[0].coefficient = -1 / (along + gap.left / gap.multiplier);
    }
}

/// Right sides for a τ [J]; `second_order`: with what the last step left out.
DUCTILE_INLINE void InteriorPoint::aim(double energy, bool second_order) {
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        if (!system_->alone(i)) continue;
        IslandSystem::Row& work = system_->rows()[i];
        work.right = work.residual;
        work.extra = 0;
        const auto push = [&](Gap& gap, double sign) {
            if (!gap.there) return;
            gap.push = energy - (second_order ? sign * work.change * gap.change : 0);
            work.right += sign * gap.push / gap.left;
        };
        push(rows_[i].lower, 1);
        push(rows_[i].upper, -1);
    }
    for (std::size_t k = 0; k < blocks_.size(); ++k) {
        const BlockView v = view_of(*system_, k);
        Gap& gap = blocks_[k];
        const Way of = second_order ? way(k) : Way{};
        const double turned = second_order ? gap.change : 0;
        gap.push = energy + gap.multiplier * of.bend + turned * (of.along + of.bend);
        for (int i = 0; i < v.count(); ++i) {
            v.work[i].right = v.work[i].extra = 0;
            if (!v.live(i)) continue;
            const double p2 = v.size(i) * v.size(i);
            v.work[i].right = v.work[i].residual - gap.push / gap.left * v.row[i].impulse / p2 -
                              turned * v.work[i].change / p2;
        }
    }
}

/// Of the multipliers, after a step.
DUCTILE_INLINE void InteriorPoint::read_changes() {
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        const auto read = [](Gap& gap, double change) {
            if (!gap.there) return;
            gap.change = (gap.push - gap.multiplier * change) / gap.left - gap.multiplier;
        };
        read(rows_[i].lower, system_->rows()[i].change);
        read(rows_[i].upper, -system_->rows()[i].change);
    }
    for (std::size_t k = 0; k < blocks_.size(); ++k) {
        const BlockView v = view_of(*system_, k);
        Gap& gap = blocks_[k];
        if (!gap.there) continue;
        // (μ/g) n·dx, which would lose the digits of n·dx, by what the surface lets through
        const auto& term = v.tangent.terms[0];
        double through = 0;
        for (int i = 0; i < v.count(); ++i) through += term.direction[i] * v.work[i].rest;
        gap.change = gap.push / gap.left - gap.multiplier - term.coefficient * through;
    }
}

/// Share of the step to the nearest bound, surface or zero of a multiplier.
DUCTILE_INLINE double InteriorPoint::reach() const {
    double most = std::numeric_limits<double>::infinity();
    const auto see = [&most](const Gap& gap, double change) {
        if (!gap.there) return;
        if (change < 0) most = std::min(most, -gap.left / change);
        if (gap.change < 0) most = std::min(most, -gap.multiplier / gap.change);
    };
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        see(rows_[i].lower, system_->rows()[i].change);
        see(rows_[i].upper, -system_->rows()[i].change);
    }
    for (std::size_t k = 0; k < blocks_.size(); ++k) {
        see(blocks_[k], 0);
        const Way of = way(k);
        if (!(of.bend > 0)) continue;
        const double left = blocks_[k].left;
        const double root = std::sqrt(of.along * of.along + 4 * of.bend * left);
        most = std::min(
            most, of.along > 0 ? 2 * left / (of.along + root) : (root - of.along) / (2 * of.bend));
    }
    return most;
}

DUCTILE_INLINE void InteriorPoint::take(double share) {
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        system_->island().rows[i].impulse += share * system_->rows()[i].change;
        for (Gap* gap : {&rows_[i].lower, &rows_[i].upper}) gap->multiplier += share * gap->change;
    }
    for (Gap& gap : blocks_) gap.multiplier += share * gap.change;
}

/// Sides and states: at the bound or surface that less is left to than its multiplier says, and to
/// the last digit then.
DUCTILE_INLINE void InteriorPoint::leave() {
    Island& island = system_->island();
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        if (!system_->alone(i)) continue;
        IslandRow& row = island.rows[i];
        const auto at = [&](const Gap& gap) {
            return gap.there && gap.left * system_->rows()[i].metric < gap.multiplier;
        };
        row.side = at(rows_[i].lower) ? Side::lower : at(rows_[i].upper) ? Side::upper : Side::free;
        if (row.side == Side::lower) row.impulse = row.lower;
        if (row.side == Side::upper) row.impulse = row.upper;
    }
    for (std::size_t k = 0; k < blocks_.size(); ++k) {
        const bool flows = blocks_[k].left * system_->scale() < flow(k);
        island.blocks[k].state = flows ? BlockState::surface : BlockState::inside;
        island.blocks[k].multiplier = flows ? blocks_[k].multiplier : 0;
        EllipsoidForm::place(view_of(*system_, k));
    }
    system_->update_velocities();
    system_->update_residuals();
}

} // namespace ductile::solve
