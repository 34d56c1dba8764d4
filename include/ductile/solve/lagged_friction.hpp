// SPDX-License-Identifier: MIT
//
// The way through an island whose contacts slide where Newton on Coulomb's law does not settle
// (coulomb_form.hpp): the friction of each is bounded by a disc, whose radius is the normal impulse
// of the round before,
//
//   n >= 0,   |t/f| <= n',   n' <- n
//
// Each round is an island of bounds and ellipsoids, solved warm by the active set, or the safe way
// where that does not settle; the fixed point is Coulomb's law. What friction does to the normals
// is a moment of the sliding forces, f h/l of a body of height h on a base l, so that a few rounds
// settle, accelerated. The cone's own fixed point (contact_form.hpp) shifts by slips instead, by
// which four corners of one face are at odds: of a pair of cubes that slides on a floor it took 300
// factorisations where this takes 7.
//
// Where bodies jam, rounds wander, and settle late or not at all: then this is not the way.
//
// Source: the "lagged" contact of Castro, Han & Masterjohn (2023), arXiv:2312.03908.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "ductile/numeric/anderson.hpp"
#include "ductile/solve/active_set.hpp"
#include "ductile/solve/certificate.hpp"
#include "ductile/solve/contact_form.hpp"
#include "ductile/solve/interior_point.hpp"
#include "ductile/solve/island_report.hpp"
#include "ductile/solve/island_system.hpp"
#include "ductile/solve/proximal_newton.hpp"

namespace ductile::solve {

/// Not thread-safe. Keeps room between solves.
class LaggedFriction {
  public:
    /// From the impulses, sides and states in the island. True where it settled: these are those of
    /// the answer then, velocities and residuals belong to them, and shifts are zero. Else all is
    /// as it was.
    /// Accelerated, rounds settle sooner, and wander where bodies jam: then they go on from the
    /// closest so far, half of the way each, for a while.
    [[nodiscard]] bool solve(IslandSystem& system) {
        constexpr int most = 160;                       // rounds
        constexpr double settled = 1e-9, nearly = 1e-8; // of the largest velocity
        constexpr int patience = 10;                    // rounds without coming closer by half
        constexpr int most_wandered = 2, slow = 20;
        begin(system);
        const double enough = std::max(system.round_off(40), settled * system.scale()),
                     fair = std::max(enough, nearly * system.scale());
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

    /// Of the last solve.
    [[nodiscard]] int factorisations() const noexcept { return factorisations_; }

  private:
    void begin(IslandSystem& system) {
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
        brief_ = InteriorPoint::serves(flat_);
    }
    /// What Newton on the velocities found counts where the active set, which makes it exact, goes
    /// in circles.
    [[nodiscard]] bool solve_round() {
        constexpr double cold = 0.1;
        take_from_flat();
        if (active_set_.solve(system_, false, brief_ ? ActiveSet::brief : ActiveSet::usual)) {
            return true;
        }
        give_to_flat();
        if (brief_) { // but for the last digits of what repeats itself, which the radii follow
            interior_point_.solve(system_);
            brief_ = active_set_.solve(system_, true);
            if (brief_) return true;
            give_to_flat();
        }
        proximal_newton_.solve(system_, cold, false);
        const bool well = certificate(system_) <= solved_well * system_.scale();
        take_from_flat();
        if (active_set_.solve(system_, true)) return true;
        give_to_flat();
        return well;
    }
    void take_from_flat() {
        rows_ = flat_.rows;
        blocks_ = flat_.blocks;
    }
    /// With nothing kept of another way.
    void give_to_flat() {
        flat_.rows = rows_;
        flat_.blocks = blocks_;
        for (IslandSystem::Row& row : system_.rows()) row.shift = row.kept = 0;
    }
    /// The normals; the largest velocity by which friction is off [m/s].
    [[nodiscard]] double read(const IslandSystem& system) {
        const Island& island = system.island();
        normals_.clear();
        double moved = 0;
        for (std::size_t c = 0; c < contacts_.size(); ++c) {
            const IslandBlock& cone = island.blocks[contacts_[c]];
            const auto first = std::size_t(cone.first);
            const double normal = std::max(flat_.rows[first].impulse, 0.0);
            normals_.push_back(normal);
            double square = 0, own = 0; // of t/f
            for (std::size_t i = 1; i < std::size_t(cone.count); ++i) {
                const double share = flat_.rows[first + i].impulse / cone.size[i];
                square += share * share;
                const IslandSystem::Row& work = system_.rows()[first + i];
                own = std::max(own, cone.size[i] * work.share * work.metric);
            }
            const bool held =
                flat_.blocks[contacts_[c]].state == BlockState::inside && radii_[c] > 0;
            const double off = held ? std::sqrt(square) - normal : std::abs(normal - radii_[c]);
            moved = std::max(moved, off * own);
        }
        return moved;
    }
    void set_radii(const Island& island) {
        for (std::size_t c = 0; c < contacts_.size(); ++c) {
            IslandBlock& disc = flat_.blocks[contacts_[c]];
            const IslandBlock& cone = island.blocks[contacts_[c]];
            for (std::size_t i = 0; i < std::size_t(disc.count); ++i) {
                disc.size[i] = cone.size[i + 1] * radii_[c];
            }
        }
    }
    void give(IslandSystem& system) const {
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

    Island flat_; ///< the island with discs in place of cones
    IslandSystem system_;
    ActiveSet active_set_;
    InteriorPoint interior_point_;
    ProximalNewton proximal_newton_;
    numeric::Anderson ahead_;
    std::vector<std::size_t> contacts_;   ///< their blocks, here and there
    std::vector<double> radii_, normals_; ///< n', n by contact
    std::vector<IslandRow> rows_;         ///< what a way starts from, should it fail
    std::vector<IslandBlock> blocks_;
    int factorisations_ = 0;
    bool brief_ = false; ///< the interior point serves, and was made exact whenever it was asked
};

} // namespace ductile::solve
