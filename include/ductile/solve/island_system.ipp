// SPDX-License-Identifier: MIT
//
// Bodies of island_system.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "ductile/solve/island_system.hpp"

namespace ductile::solve {

namespace detail {

/// A row's entries on an axis that a body has locked are of no effect.
DUCTILE_INLINE void lock(Vector6<double>& on, const IslandBody& body) noexcept {
    for (int i = 0; i < 3; ++i) {
        if (body.inverse_mass[i] == 0) on[i] = 0;
        if (body.inverse_inertia(i, i) == 0) on[3 + i] = 0;
    }
}

} // namespace detail

DUCTILE_INLINE void IslandSystem::open(Island& island) {
    island_ = &island;
    factorisations_ = 0;
    current_ = false;
    rows_.resize(island.rows.size());
    blocks_.resize(island.blocks.size());
    change_.resize(island.bodies.size());
    masses_.clear();
    for (const IslandBody& body : island.bodies) masses_.push_back(mass(body));
    find_runs();
    find_pattern();
    block_of_.assign(island.rows.size(), -1);
    for (std::size_t k = 0; k < island.blocks.size(); ++k) {
        const IslandBlock& block = island.blocks[k];
        for (int i = 0; i < block.count; ++i) block_of_[std::size_t(block.first + i)] = int(k);
    }
    scale_ = 0;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        IslandRow& given = island.rows[i];
        Row& row = rows_[i];
        row = {};
        if (given.a >= 0) detail::lock(given.on_a, island.bodies[std::size_t(given.a)]);
        if (given.b >= 0) detail::lock(given.on_b, island.bodies[std::size_t(given.b)]);
        row.own = own_effect(island, given);
        const double softness = given.softness > 0 ? given.softness : least_softness * row.own;
        row.compliance = given.compliance <= softness ? softness : given.compliance; // or NaN
        const bool contact = block_of_[i] >= 0 &&
                             island.blocks[std::size_t(block_of_[i])].kind == BlockKind::contact;
        row.rigid = !contact && !(given.softness > 0) && given.compliance <= softness;
        row.metric = row.own + row.compliance;
        row.share = row.own > 0 ? row.own / row.metric : 0;
        // what can only push asks for nothing while it opens: a gap over a short step is no speed
        const bool nothing =
            contact ? given.target < 0 && island.blocks[std::size_t(block_of_[i])].first == int(i)
                    : opens(given);
        const double size = (nothing ? 0 : std::abs(given.target) * row.share) +
                            0 * row.metric; // NaN and infinity come through
        if (row.own == 0) continue;
        if (!(size <= scale_) && !std::isnan(scale_)) scale_ = size;
    }
    for (const IslandBlock& block : island.blocks) {
        if (block.kind == BlockKind::contact) make_isotropic(block);
    }
}

DUCTILE_INLINE double IslandSystem::given() const noexcept {
    double most = 0;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        const Row& row = rows_[i];
        if (!row.rigid || row.own == 0) continue;
        most = std::max(most, row.compliance * std::abs(island_->rows[i].impulse - row.kept));
    }
    return most;
}

DUCTILE_INLINE void IslandSystem::read_rigid(std::vector<double>& kept,
                                             std::vector<double>& impulses) const {
    kept.clear();
    impulses.clear();
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        if (!rows_[i].rigid) continue;
        const double scale = std::sqrt(rows_[i].compliance);
        kept.push_back(scale * rows_[i].kept);
        impulses.push_back(scale * island_->rows[i].impulse);
    }
}

DUCTILE_INLINE void IslandSystem::keep(const std::vector<double>& kept) noexcept {
    std::size_t next = 0;
    for (Row& row : rows_) {
        if (!row.rigid) continue;
        const double scaled = kept[next++];
        row.kept = row.compliance > 0 ? scaled / std::sqrt(row.compliance) : 0;
    }
}

/// The friction rows of a contact get one compliance and one metric, in shares of their
/// coefficients.
DUCTILE_INLINE void IslandSystem::make_isotropic(const IslandBlock& block) noexcept {
    double compliance = 0, own = 0;
    for (int i = 1; i < block.count; ++i) {
        const Row& row = rows_[std::size_t(block.first + i)];
        const double f = block.size[std::size_t(i)];
        compliance = std::max(compliance, f * f * row.compliance);
        own = std::max(own, f * f * row.own);
    }
    for (int i = 1; i < block.count; ++i) {
        Row& row = rows_[std::size_t(block.first + i)];
        const double f = block.size[std::size_t(i)];
        row.compliance = compliance / (f * f);
        row.metric = (own + compliance) / (f * f);
        row.share = own > 0 ? own / (own + compliance) : 0;
    }
}

DUCTILE_INLINE void IslandSystem::find_runs() {
    runs_.clear();
    edges_.clear();
    for (std::size_t i = 0; i < island_->rows.size(); ++i) {
        const IslandRow& row = island_->rows[i];
        if (runs_.empty() || runs_.back().a != row.a || runs_.back().b != row.b) {
            Run& run = runs_.emplace_back();
            run.first = i;
            run.a = row.a;
            run.b = row.b;
            if (row.a >= 0 && row.b >= 0)
                edges_.emplace_back(std::min(row.a, row.b), std::max(row.a, row.b));
        }
        runs_.back().end = i + 1;
    }
    std::size_t run = 0;
    for (std::size_t k = 0; k < blocks_.size(); ++k) {
        const auto first = std::size_t(island_->blocks[k].first);
        if (run < runs_.size() && runs_[run].first > first) run = 0;
        while (run < runs_.size() && runs_[run].end <= first) ++run;
        blocks_[k] = {};
        blocks_[k].run = run;
    }
}

/// Of the island's own pairs alone, so that an answer does not depend on islands before it.
DUCTILE_INLINE void IslandSystem::find_pattern() {
    const int bodies = int(island_->bodies.size());
    if (edges_ != pattern_ || bodies != factors_.size()) {
        pattern_ = edges_;
        std::sort(edges_.begin(), edges_.end());
        edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
        factors_.set_pattern(bodies, edges_);
    }
    for (Run& run : runs_) {
        if (run.a >= 0 && run.b >= 0) run.place = factors_.place(run.a, run.b);
    }
}

DUCTILE_INLINE void IslandSystem::update_velocities() noexcept {
    std::vector<IslandBody>& bodies = island_->bodies;
    for (IslandBody& body : bodies) body.velocity.setZero();
    for (const IslandRow& row : island_->rows) {
        if (row.impulse == 0) continue;
        if (row.a >= 0) bodies[std::size_t(row.a)].velocity += row.impulse * row.on_a;
        if (row.b >= 0) bodies[std::size_t(row.b)].velocity += row.impulse * row.on_b;
    }
    for (IslandBody& body : bodies) {
        const Vector6<double> impulse = body.velocity;
        body.velocity = moved(body, impulse);
    }
}

DUCTILE_INLINE void IslandSystem::update_residuals() noexcept {
    const std::vector<IslandBody>& bodies = island_->bodies;
    double most = 0;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        const IslandRow& row = island_->rows[i];
        most = std::max(most, rows_[i].own * std::abs(row.impulse));
        double residual =
            row.target - rows_[i].shift - rows_[i].compliance * (row.impulse - rows_[i].kept);
        if (row.a >= 0) residual -= row.on_a.dot(bodies[std::size_t(row.a)].velocity);
        if (row.b >= 0) residual -= row.on_b.dot(bodies[std::size_t(row.b)].velocity);
        rows_[i].residual = residual;
    }
    noise_ = std::numeric_limits<double>::epsilon() * most;
}

/// J^T D J of the rows between two bodies, where D is another than the last time: most rows of a
/// structure are as they were. False where it is the same.
DUCTILE_INLINE bool IslandSystem::update(Run& run) noexcept {
    bool same = run.known;
    for (std::size_t i = run.first; i < run.end; ++i) {
        Row& row = rows_[i];
        same = same && row.weight == row.factored;
        row.factored = row.weight;
    }
    if (same && !run.ranks) return false;
    run.known = true;
    run.on_a.setZero();
    run.on_b.setZero();
    run.across.setZero();
    for (std::size_t i = run.first; i < run.end; ++i) {
        if (rows_[i].weight != 0) {
            run.add(rows_[i].weight, island_->rows[i].on_a, island_->rows[i].on_b);
        }
    }
    return true;
}

DUCTILE_INLINE void IslandSystem::Run::add(double weight, const Vector6<double>& of_a,
                                           const Vector6<double>& of_b) noexcept {
    if (a >= 0) on_a.noalias() += (weight * of_a) * of_a.transpose();
    if (b >= 0) on_b.noalias() += (weight * of_b) * of_b.transpose();
    if (a < 0 || b < 0) return;
    const bool turned = place.transposed;
    across.noalias() += (weight * (turned ? of_b : of_a)) * (turned ? of_a : of_b).transpose();
}

DUCTILE_INLINE bool IslandSystem::factor() noexcept {
    bool same = current_;
    for (Run& run : runs_) {
        if (update(run)) same = false;
    }
    const bool flat = std::all_of(blocks_.begin(), blocks_.end(), [](const Block& block) {
        return block.terms[0].coefficient == 0 && block.terms[1].coefficient == 0;
    });
    if (same && flat) return true;
    ++factorisations_;
    factors_.clear();
    for (std::size_t i = 0; i < island_->bodies.size(); ++i) {
        factors_.diagonal(int(i)) = masses_[i];
    }
    for (Run& run : runs_) run.ranks = false;
    bool coupled = false;
    for (std::size_t k = 0; k < blocks_.size(); ++k) {
        for (const Block::Term& term : blocks_[k].terms) {
            if (term.coefficient == 0) continue;
            const auto [on_a, on_b] = along(k, term);
            Run& run = runs_[blocks_[k].run];
            run.add(term.coefficient, on_a, on_b);
            run.ranks = true;
        }
        coupled = coupled || blocks_[k].coupling != 0;
    }
    for (const Run& run : runs_) {
        if (run.a >= 0) factors_.diagonal(run.a) += run.on_a;
        if (run.b >= 0) factors_.diagonal(run.b) += run.on_b;
        if (run.a >= 0 && run.b >= 0) factors_.off_diagonal(run.place) += run.across;
    }
    current_ = false;
    if (coupled) {
        couple();
        factors_.factor_general();
        return true;
    }
    const bool definite = factors_.factor();
    current_ = definite && flat;
    return definite;
}

/// Jᵀ t.
DUCTILE_INLINE auto IslandSystem::along(std::size_t block, const Block::Term& term) const noexcept
    -> Pair {
    const IslandBlock& given = island_->blocks[block];
    Pair on{Vector6<double>::Zero(), Vector6<double>::Zero()};
    for (int i = 0; i < given.count; ++i) {
        const IslandRow& row = island_->rows[std::size_t(given.first + i)];
        on.first += term.direction[i] * row.on_a;
        on.second += term.direction[i] * row.on_b;
    }
    return on;
}

/// Jᵀ c₀ t e₀ᵀ J, in the factors.
DUCTILE_INLINE void IslandSystem::couple() noexcept {
    factors_.mirror();
    for (std::size_t k = 0; k < blocks_.size(); ++k) {
        const double coupling = blocks_[k].coupling;
        if (coupling == 0) continue;
        auto [on_a, on_b] = along(k, blocks_[k].terms[0]);
        on_a *= coupling;
        on_b *= coupling;
        const IslandRow& first = island_->rows[std::size_t(island_->blocks[k].first)];
        const Run& run = runs_[blocks_[k].run];
        if (run.a >= 0) factors_.diagonal(run.a).noalias() += on_a * first.on_a.transpose();
        if (run.b >= 0) factors_.diagonal(run.b).noalias() += on_b * first.on_b.transpose();
        if (run.a < 0 || run.b < 0) continue;
        auto& a_b =
            run.place.transposed ? factors_.mirrored(run.place) : factors_.off_diagonal(run.place);
        auto& b_a =
            run.place.transposed ? factors_.off_diagonal(run.place) : factors_.mirrored(run.place);
        a_b.noalias() += on_a * first.on_b.transpose();
        b_a.noalias() += on_b * first.on_a.transpose();
    }
}

DUCTILE_INLINE void IslandSystem::step() noexcept {
    // D g + e, and later D (g - J dv) + e: the same map
    const auto apply = [this](double Row::*from, double Row::*to) {
        for (Row& row : rows_) row.*to = row.weight * (row.*from) + row.extra;
        for (std::size_t k = 0; k < blocks_.size(); ++k) {
            const IslandBlock& given = island_->blocks[k];
            if (blocks_[k].coupling != 0) {
                const double driven = blocks_[k].coupling * (rows_[std::size_t(given.first)].*from);
                for (int i = 1; i < given.count; ++i) {
                    rows_[std::size_t(given.first + i)].*to +=
                        driven * blocks_[k].terms[0].direction[i];
                }
            }
            for (const Block::Term& term : blocks_[k].terms) {
                if (term.coefficient == 0) continue;
                double along = 0;
                for (int i = 0; i < given.count; ++i) {
                    along += term.direction[i] * (rows_[std::size_t(given.first + i)].*from);
                }
                along *= term.coefficient;
                for (int i = 0; i < given.count; ++i) {
                    rows_[std::size_t(given.first + i)].*to += along * term.direction[i];
                }
            }
        }
    };
    apply(&Row::right, &Row::change);
    for (Vector6<double>& change : change_) change.setZero();
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        const double impulse = rows_[i].change;
        if (impulse == 0) continue;
        const IslandRow& row = island_->rows[i];
        if (row.a >= 0) change_[std::size_t(row.a)] += impulse * row.on_a;
        if (row.b >= 0) change_[std::size_t(row.b)] += impulse * row.on_b;
    }
    factors_.solve(change_);
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        const IslandRow& row = island_->rows[i];
        double rest = rows_[i].right;
        if (row.a >= 0) rest -= row.on_a.dot(change_[std::size_t(row.a)]);
        if (row.b >= 0) rest -= row.on_b.dot(change_[std::size_t(row.b)]);
        rows_[i].rest = rest;
    }
    apply(&Row::rest, &Row::change);
}

DUCTILE_INLINE double IslandSystem::energy() const noexcept {
    double twice = 0;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        twice -= island_->rows[i].impulse *
                 (island_->rows[i].target + rows_[i].residual + rows_[i].shift);
    }
    return twice / 2;
}

} // namespace ductile::solve
