// SPDX-License-Identifier: MIT
//
// Bodies of island_solver.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "ductile/solve/block_form.hpp"
#include "ductile/solve/island_solver.hpp"
#include "ductile/solve/one_pair.hpp"

namespace ductile::solve {

namespace detail {

/// A velocity below which digits are lost, however small the unit [m/s | rad/s].
inline constexpr double nothing =
    std::numeric_limits<double>::min() / std::numeric_limits<double>::epsilon();

/// Into bounds and blocks.
DUCTILE_INLINE void project_impulses(IslandSystem& system) noexcept {
    Island& island = system.island();
    for (std::size_t i = 0; i < island.rows.size(); ++i) {
        IslandRow& row = island.rows[i];
        if (system.rows()[i].own == 0) {
            row.impulse = 0;
        } else if (system.alone(i)) {
            row.impulse = std::min(std::max(row.impulse, row.lower), row.upper);
        }
    }
    for (std::size_t k = 0; k < island.blocks.size(); ++k) {
        const BlockView view = view_of(system, k);
        with_form(view, [&view](auto form) { form.project(view); });
    }
}

} // namespace detail

DUCTILE_INLINE IslandReport IslandSolver::solve(Island& island) {
    const IslandReport report = answer(island);
    const double share = unsolved_share * report.scale;
    double off = report.solved ? 0 : report.residual;
    if (std::isnan(report.residual)) off = std::numeric_limits<double>::infinity();
    if (off <= std::min(share, unsolved_speed)) off = 0;
    if (report.gives > unsolved_speed) off = std::max(off, report.gives);
    island.unsolved = off;
    return report;
}

DUCTILE_INLINE IslandReport IslandSolver::answer(Island& island) {
    IslandReport report;
    if (solve_one_pair(island, report)) return report;
    if (ForestSolver::serves(island)) {
        if (forest_ == nullptr) forest_ = std::make_unique<ForestSolver>();
        if (forest_->solve(island, report)) return report;
    }
    if (general_ == nullptr) general_ = std::make_unique<GeneralSolver>();
    return general_->solve(island);
}

DUCTILE_INLINE IslandReport GeneralSolver::solve(Island& island) {
    IslandReport report;
    system_.open(island);
    report.scale = system_.scale();
    if (!std::isfinite(report.scale)) {
        for (IslandRow& row : island.rows) row.impulse = 0;
        for (IslandBody& body : island.bodies) body.velocity.setZero();
        report.solved = false;
        report.residual = std::numeric_limits<double>::quiet_NaN();
        return report;
    }
    take(start_);
    if (report.scale < detail::nothing) {
        for (IslandRow& row : island.rows) row.impulse = 0;
        for (IslandBlock& block : island.blocks) {
            block.state = BlockState::inside;
            block.multiplier = 0;
        }
        certify(report);
        return report;
    }
    const auto touches = [](const IslandBlock& block) { return block.kind == BlockKind::contact; };
    const auto any = [&island](const auto& is) {
        return std::any_of(island.blocks.begin(), island.blocks.end(), is);
    };
    const bool touch = any(touches);
    const bool solved = (touch && (coulomb(report) || lagged(report, start_))) || polished(report);
    if (solved) certify(report);
    if (!solved || !report.solved) {
        fall_back(report, touch);
        certify(report);
    }
    if (!report.solved) give_up(report);
    report.factorisations += system_.factorisations();
    return report;
}

DUCTILE_INLINE bool GeneralSolver::polished(IslandReport& report) {
    const bool brief = InteriorPoint::serves(system_.island());
    const bool settled =
        active_set_.solve(system_, false, brief ? ActiveSet::brief : ActiveSet::usual);
    report.rounds += active_set_.rounds();
    return settled;
}

/// Where it does not settle all is as it was.
DUCTILE_INLINE bool GeneralSolver::coulomb(IslandReport& report) {
    Island& island = system_.island();
    sides_.clear();
    for (const IslandRow& row : island.rows) sides_.push_back(row.side);
    blocks_ = island.blocks;
    for (std::size_t k = 0; k < island.blocks.size(); ++k) {
        const BlockView view = view_of(system_, k);
        view.tangent.coulomb = view.block.kind == BlockKind::contact;
        if (view.tangent.coulomb) view.block.multiplier = 0; // known no better than by a guess
    }
    const bool settled = polished(report);
    for (IslandSystem::Block& block : system_.blocks()) block.coulomb = false;
    if (settled) return true;
    for (std::size_t i = 0; i < sides_.size(); ++i) island.rows[i].side = sides_[i];
    island.blocks = blocks_;
    begin_from(start_);
    return false;
}

/// With nothing kept of another way.
DUCTILE_INLINE void GeneralSolver::begin_from(const std::vector<double>& impulses) {
    for (IslandSystem::Row& row : system_.rows()) row.shift = row.kept = 0;
    put(impulses);
}

DUCTILE_INLINE bool GeneralSolver::lagged(IslandReport& report, const std::vector<double>& from) {
    begin_from(from);
    const bool settled = lagged_friction_.solve(system_);
    report.factorisations += lagged_friction_.factorisations();
    return settled;
}

/// The interior point where it serves, or else proximal Newton, polished by the active set; each
/// pass goes on from the best so far, from where the lagged way often settles that did not from the
/// start.
DUCTILE_INLINE void GeneralSolver::fall_back(IslandReport& report, bool touch) {
    const int most = touch ? 2 : 4;
    constexpr double cold = 0.1, warm = 1e-4;
    double least = std::numeric_limits<double>::infinity();
    const auto keep = [&] {
        certify(report);
        if (report.residual <= least) {
            least = report.residual;
            take(best_);
        } else {
            put(best_);
        }
        return least / report.scale;
    };
    begin_from(start_);
    best_ = start_;
    if (InteriorPoint::serves(system_.island())) {
        interior_point_.solve(system_);
        ++report.safe_ways;
        const bool well = keep() <= solved_well;
        // what rigid rows give the active set alone takes out
        if (well && report.gives <= solved_residual * report.scale) return;
        if (polished(report) || keep() <= solved_well) return;
    }
    for (int pass = 0; pass < most; ++pass) {
        proximal_newton_.solve(system_, pass == 0 ? cold : warm, pass > 0);
        ++report.safe_ways;
        static_cast<void>(keep());
        if (polished(report) || keep() <= solved_well || (touch && lagged(report, best_))) return;
    }
}

DUCTILE_INLINE void GeneralSolver::certify(IslandReport& report) {
    detail::project_impulses(system_);
    system_.update_velocities();
    system_.update_residuals();
    report.residual = certificate(system_);
    const double along = detail::adds_up(system_.island()); // what turns moves by as much again
    report.gives = system_.given() * along * along;
    // where next to nothing is asked for, round-off is more than a share of it; what a light body
    // is asked for is no measure of what is much
    report.solved =
        report.residual <= std::max({std::min(solved_residual * report.scale, unsolved_speed),
                                     system_.round_off(4), detail::nothing});
}

/// Of the answer, the start and nothing the one that leaves the least energy.
DUCTILE_INLINE void GeneralSolver::give_up(IslandReport& report) {
    take(best_);
    double least = system_.energy();
    for (const bool nothing : {false, true}) {
        if (nothing) std::fill(start_.begin(), start_.end(), 0.0);
        put(start_);
        const double energy = system_.energy();
        if (!(energy >= least)) {
            take(best_);
            least = energy;
        }
    }
    put(best_);
    report.residual = certificate(system_);
}

DUCTILE_INLINE void GeneralSolver::put(const std::vector<double>& impulses) {
    std::vector<IslandRow>& rows = system_.island().rows;
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i].impulse = impulses[i];
    detail::project_impulses(system_);
    system_.update_velocities();
    system_.update_residuals();
}

DUCTILE_INLINE void GeneralSolver::take(std::vector<double>& impulses) const {
    const std::vector<IslandRow>& rows = system_.island().rows;
    impulses.resize(rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) impulses[i] = rows[i].impulse;
}

} // namespace ductile::solve
