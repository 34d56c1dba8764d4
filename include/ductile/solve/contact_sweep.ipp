// SPDX-License-Identifier: MIT
//
// Bodies of contact_sweep.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "ductile/solve/block_form.hpp"
#include "ductile/solve/certificate.hpp"
#include "ductile/solve/contact_sweep.hpp"
#include "ductile/solve/island_report.hpp"

namespace ductile::solve {

DUCTILE_INLINE void ContactSweep::solve(IslandSystem& system, ActiveSet& joints,
                                        ProximalNewton& safe, double& effort) {
    constexpr int most = 20;
    constexpr double enough = solved_residual / 10;
    system_ = &system;
    sweeps_ = 0;
    contacts_.clear();
    rows_.clear();
    first_.clear();
    const std::vector<IslandBlock>& blocks = system.island().blocks;
    for (std::size_t k = 0; k < blocks.size(); ++k) {
        if (blocks[k].kind != BlockKind::contact) continue;
        contacts_.push_back(k);
        first_.push_back(rows_.size());
        for (int i = 0; i < blocks[k].count; ++i) rows_.push_back(std::size_t(blocks[k].first + i));
    }
    for (IslandSystem::Row& row : system.rows()) row.shift = 0;
    double off = 0;
    for (int round = 0; round < most; ++round) {
        const bool settled = joints.solve(system, {.contacts_held = true});
        // without contacts it was asked before
        const bool unsettled = !settled && !contacts_.empty();
        if (unsettled) safe.solve(system, true);
        const double before = off;
        off = certificate(system) / system.scale();
        const bool stalled = round > 0 && ((off <= solved_residual && off > before / 2) ||
                                           (unsettled && off > 0.99 * before) ||
                                           (contacts_.empty() && !(off < before)));
        if (off <= enough || stalled || !(effort > 0)) break;
        if (round == 0 || unsettled ||
            joints.rounds() > 1) { // else what contacts do to each other is as it was
            if (!joints.linearise(system)) break;
            condense();
            effort -=
                double(rows_.size() * (12 * rows_.size() + 100 * system.island().bodies.size()));
        }
        for (std::size_t i = 0; i < rows_.size(); ++i) {
            residual_[i] = system.rows()[rows_[i]].residual;
        }
        sweep_contacts(effort);
    }
    tell_states();
}

DUCTILE_INLINE void ContactSweep::condense() {
    const std::size_t n = rows_.size();
    entries_.clear();
    column_.assign(1, 0);
    own_.assign(contacts_.size(), Matrix6<double>::Zero());
    residual_.resize(n);
    for (std::size_t c = 0; c < contacts_.size(); ++c) {
        const std::size_t end = c + 1 < contacts_.size() ? first_[c + 1] : n;
        for (std::size_t i = first_[c]; i < end; ++i) {
            const std::vector<Vector6<double>>& change = system_->response(rows_[i]);
            for (std::size_t j = 0; j < n; ++j) {
                double effect = system_->along(rows_[j], change);
                if (i == j) effect += system_->rows()[rows_[i]].compliance;
                if (effect == 0) continue;
                entries_.push_back({j, effect});
                if (j < first_[c] || j >= end) continue;
                own_[c](Eigen::Index(j - first_[c]), Eigen::Index(i - first_[c])) = effect;
            }
            column_.push_back(entries_.size());
        }
    }
}

DUCTILE_INLINE void ContactSweep::sweep_contacts(double& effort) {
    constexpr int most = 30;
    const double enough = 1e-7 * system_->scale();
    double least = std::numeric_limits<double>::infinity();
    ahead_.restart();
    tell_impulses(from_);
    for (int sweep = 0; sweep < most; ++sweep) {
        ++sweeps_;
        double moved = 0;
        for (std::size_t c = 0; c < contacts_.size(); ++c) {
            moved = std::max(moved, solve_contact(c));
        }
        effort -= 2 * double(entries_.size());
        if (!(moved > enough) || !(effort > 0) || sweep + 1 == most) return;
        if (moved > 2 * least) ahead_.restart(); // it went astray
        least = std::min(least, moved);
        go_ahead();
    }
}

/// From what the last sweep made of `from_` to where the next one starts.
DUCTILE_INLINE void ContactSweep::go_ahead() {
    std::vector<IslandRow>& rows = system_->island().rows;
    tell_impulses(to_);
    ahead_.advance(from_, to_);
    for (std::size_t i = 0; i < rows_.size(); ++i) rows[rows_[i]].impulse = from_[i];
    for (const std::size_t contact : contacts_) ContactForm::project(view_of(*system_, contact));
    tell_impulses(from_);
    for (std::size_t i = 0; i < rows_.size(); ++i) feel(i, from_[i] - to_[i]);
}

DUCTILE_INLINE void ContactSweep::tell_impulses(std::vector<double>& to) const {
    to.resize(rows_.size());
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        to[i] = system_->island().rows[rows_[i]].impulse;
    }
}

/// A change of an impulse, by all contacts.
DUCTILE_INLINE void ContactSweep::feel(std::size_t row, double by) {
    if (by == 0) return;
    for (std::size_t k = column_[row]; k < column_[row + 1]; ++k) {
        residual_[entries_[k].row] -= entries_[k].effect * by;
    }
}

/// How far it moved, as a velocity. Not to the end: the next sweep comes by again.
DUCTILE_INLINE double ContactSweep::solve_contact(std::size_t contact) {
    constexpr int most = 2;
    const BlockView view = view_of(*system_, contacts_[contact]);
    const std::size_t first = first_[contact];
    const int count = view.count();
    if (!(view.work[0].own > 0)) return 0;
    const Matrix6<double>& effect = own_[contact];
    Vector6<double> before = Vector6<double>::Zero(), residual = before;
    for (int i = 0; i < count; ++i) {
        before[i] = view.row[i].impulse;
        residual[i] = residual_[first + std::size_t(i)];
    }
    double metric = 0; // of the friction rows, in shares
    for (int i = 1; i < count; ++i) {
        if (view.live(i)) metric += effect(i, i) * view.size(i) * view.size(i);
    }
    const auto change = [&](int i, double by) {
        view.row[i].impulse += by;
        for (int j = 0; j < count; ++j) residual[j] -= effect(i, j) * by;
    };
    for (int turn = 0; turn < most; ++turn) {
        double moved = 0;
        const double normal = std::max(0.0, view.row[0].impulse + residual[0] / effect(0, 0));
        moved = std::abs(normal - view.row[0].impulse) * effect(0, 0);
        change(0, normal - view.row[0].impulse);
        Vector6<double> aim = Vector6<double>::Zero();
        double square = 0;
        for (int i = 1; i < count; ++i) {
            if (!view.live(i)) continue;
            aim[i] = view.row[i].impulse / view.size(i) + residual[i] * view.size(i) / metric;
            square += aim[i] * aim[i];
        }
        const double length = std::sqrt(square), share = length > normal ? normal / length : 1;
        for (int i = 1; i < count; ++i) {
            if (!view.live(i)) continue;
            const double by = aim[i] * share * view.size(i) - view.row[i].impulse;
            moved = std::max(moved, std::abs(by) * effect(i, i));
            change(i, by);
        }
        if (moved <= 1e-13 * system_->scale()) break;
    }
    double moved = 0;
    for (int i = 0; i < count; ++i) {
        const double by = view.row[i].impulse - before[i];
        moved = std::max(moved, std::abs(by) * effect(i, i));
        feel(first + std::size_t(i), by);
    }
    return moved;
}

DUCTILE_INLINE void ContactSweep::tell_states() {
    system_->update_velocities();
    system_->update_residuals();
    for (const std::size_t contact : contacts_) {
        const BlockView view = view_of(*system_, contact);
        double square = 0, slip = 0;
        for (int i = 1; i < view.count(); ++i) {
            if (!view.live(i)) continue;
            square += std::pow(view.row[i].impulse / view.size(i), 2);
            slip += std::pow(view.work[i].residual * view.size(i), 2);
        }
        const double normal = view.row[0].impulse, edge = 1e-9;
        view.block.state = !(normal > 0)                             ? BlockState::apex
                           : std::sqrt(square) < normal * (1 - edge) ? BlockState::inside
                                                                     : BlockState::surface;
        view.block.multiplier = view.on_surface() ? BlockView::known(std::sqrt(slip)) : 0;
    }
}

} // namespace ductile::solve
