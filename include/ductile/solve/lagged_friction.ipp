// SPDX-License-Identifier: MIT
//
// Bodies of lagged_friction.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "ductile/solve/certificate.hpp"
#include "ductile/solve/contact_form.hpp"
#include "ductile/solve/lagged_friction.hpp"

namespace ductile::solve {

/// Accelerated, rounds settle sooner, and wander where bodies jam: then they go on from the closest
/// so far, half of the way each, for a while.
DUCTILE_INLINE bool LaggedFriction::solve(IslandSystem& system) {
    constexpr int most = 160;                       // rounds
    constexpr double settled = 1e-9, nearly = 1e-8; // of the largest velocity that a row gives
    constexpr int patience = 10;                    // rounds without coming closer by half
    constexpr int most_wandered = 2, slow = 20;
    begin(system);
    const double enough = std::max(system.round_off(40), settled * system.fastest()),
                 fair = std::max(enough, nearly * system.fastest());
    double least = std::numeric_limits<double>::infinity();
    std::vector<double> closest; // radii
    int left = patience, wandered = 0, halved = 0;
    for (int round = 0; round < most; ++round) {
        set_radii(system.island());
        const bool solved = solve_round();
        factorisations_ = system_.factorisations();
        if (!solved) return false;
        const double moved = read(system);
        left = halved > 0 || moved < least / 2 ? patience : left - 1;
        if (moved <= enough || (left == 0 && moved <= fair)) {
            give(system);
            return true;
        }
        if (moved < least) {
            least = moved;
            closest = radii_;
        }
        if (left == 0) {
            if (++wandered == most_wandered) return false;
            radii_ = closest;
            ahead_.restart();
            left = patience;
            halved = slow;
            continue;
        }
        if (halved > 0) {
            --halved;
            for (std::size_t c = 0; c < radii_.size(); ++c) {
                radii_[c] = (radii_[c] + normals_[c]) / 2;
            }
        } else {
            ahead_.advance(radii_, normals_);
        }
        for (double& radius : radii_) radius = std::max(radius, 0.0);
    }
    return false;
}

/// What the safe way found counts where the active set, which makes it exact, goes in circles.
DUCTILE_INLINE bool LaggedFriction::solve_round() {
    constexpr double cold = 0.1;
    take_from_flat();
    if (active_set_.solve(system_)) return true;
    give_to_flat();
    proximal_newton_.solve(system_, cold, false);
    const bool well = certificate(system_) <= solved_well * system_.scale();
    take_from_flat();
    if (active_set_.solve(system_, true)) return true;
    give_to_flat();
    return well;
}

DUCTILE_INLINE void LaggedFriction::take_from_flat() {
    rows_ = flat_.rows;
    blocks_ = flat_.blocks;
}

/// With nothing kept of another way.
DUCTILE_INLINE void LaggedFriction::give_to_flat() {
    flat_.rows = rows_;
    flat_.blocks = blocks_;
    for (IslandSystem::Row& row : system_.rows()) row.shift = row.kept = 0;
}

DUCTILE_INLINE void LaggedFriction::begin(IslandSystem& system) {
    const Island& island = system.island();
    flat_ = island;
    contacts_.clear();
    radii_.clear();
    ahead_.restart();
    factorisations_ = 0;
    for (std::size_t k = 0; k < flat_.blocks.size(); ++k) {
        IslandBlock& block = flat_.blocks[k];
        if (block.kind != BlockKind::contact) continue;
        contacts_.push_back(k);
        IslandRow& normal = flat_.rows[std::size_t(block.first)];
        normal.lower = 0;
        normal.upper = std::numeric_limits<double>::infinity();
        normal.side = block.state == BlockState::apex ? Side::lower : Side::free;
        radii_.push_back(std::max(normal.impulse, 0.0));
        for (int i = 1; i < block.count; ++i) { // the same in all directions
            const auto row = std::size_t(block.first + i);
            flat_.rows[row].compliance = system.rows()[row].compliance;
        }
        block.kind = BlockKind::ellipsoid;
        if (block.state == BlockState::apex) block.state = BlockState::inside;
        block.multiplier = 0;
        ++block.first;
        --block.count;
    }
    system_.open(flat_);
}

DUCTILE_INLINE void LaggedFriction::set_radii(const Island& island) {
    for (std::size_t c = 0; c < contacts_.size(); ++c) {
        IslandBlock& disc = flat_.blocks[contacts_[c]];
        const IslandBlock& cone = island.blocks[contacts_[c]];
        for (std::size_t i = 0; i < std::size_t(disc.count); ++i) {
            disc.size[i] = cone.size[i + 1] * radii_[c];
        }
    }
}

/// The normals; the largest velocity by which friction is off [m/s].
DUCTILE_INLINE double LaggedFriction::read(const IslandSystem& system) {
    const Island& island = system.island();
    normals_.clear();
    double moved = 0;
    for (std::size_t c = 0; c < contacts_.size(); ++c) {
        const IslandBlock& cone = island.blocks[contacts_[c]];
        const auto first = std::size_t(cone.first);
        const double normal = std::max(flat_.rows[first].impulse, 0.0);
        normals_.push_back(normal);
        double square = 0, metric = 0; // of t/f
        for (std::size_t i = 1; i < std::size_t(cone.count); ++i) {
            const double share = flat_.rows[first + i].impulse / cone.size[i];
            square += share * share;
            metric = std::max(metric, cone.size[i] * system_.rows()[first + i].metric);
        }
        const bool held = flat_.blocks[contacts_[c]].state == BlockState::inside && radii_[c] > 0;
        const double off = held ? std::sqrt(square) - normal : std::abs(normal - radii_[c]);
        moved = std::max(moved, off * metric);
    }
    return moved;
}

DUCTILE_INLINE void LaggedFriction::give(IslandSystem& system) const {
    Island& island = system.island();
    for (std::size_t i = 0; i < island.rows.size(); ++i) {
        island.rows[i].impulse = flat_.rows[i].impulse;
        island.rows[i].side = flat_.rows[i].side;
        system.rows()[i].shift = system.rows()[i].kept = 0;
    }
    system.update_velocities();
    system.update_residuals();
    for (std::size_t k = 0; k < island.blocks.size(); ++k) {
        const BlockView view = view_of(system, k);
        view.block.state = flat_.blocks[k].state;
        view.block.multiplier = flat_.blocks[k].multiplier;
        if (view.block.kind != BlockKind::contact) continue;
        if (!(view.row[0].impulse > 0)) view.block.state = BlockState::apex;
        view.block.multiplier = 0;
        if (view.on_surface()) ContactForm::guess(view);
    }
}

} // namespace ductile::solve
