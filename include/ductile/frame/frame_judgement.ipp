// SPDX-License-Identifier: MIT
//
// Bodies of frame_control.hpp: what a part is found to have misplaced. A part of frame_control.ipp.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "ductile/frame/frame_rules.hpp"
#include "ductile/vocabulary/angle.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile {

DUCTILE_INLINE PartBefore FrameControl::before(std::size_t row,
                                               const PartMotion& motion) const noexcept {
    if (!detail::was_there(past_, motion, row)) return {};
    const Past& past = past_[row];
    return {.acceleration = past.acceleration,
            .length = before_,
            .end = past.row.end,
            .force = past.row.force,
            .mass = past.mass,
            .swings = past.row.swings && past.row.moves(),
            .driven = past.driven,
            .fast = past.fast || used() > detail::of_swings};
}

/// Rigid rows take more of what the engine rounds than all that flows could, in any part.
DUCTILE_INLINE bool FrameControl::is_noise(const PartEngine& engine,
                                           const Judgement& judged) const {
    return tolerated_share() * engine.rounding(length_) > judged.tolerated;
}

/// Of all rows, or of those of one island [J].
struct FrameControl::Tally {
    double work = 0;       ///< plastic, so far
    double ahead = 0;      ///< that those that move will still take
    double of_flows = 0;   ///< of it: by what flows
    double least = 0;      ///< strength x travel that nobody misses
    double unmissed = 0;   ///< of it: of what is rigid
    double of_springs = 0; ///< the same of the first spring that yields
    double nearest = 0;    ///< share of its strength that a spring comes to [-]
    double freed = 0;      ///< that springs held which broke
    double error = 0;      ///< of an island, as Judgement has it
    double unfit = 0;      ///< the same
    bool moves = false;

    void add(const PartRow& row) noexcept {
        const double of_row = row.strength * row.least;
        least += of_row;
        if (row.elastic) {
            of_springs = std::max(of_springs, of_row);
        } else {
            unmissed += of_row;
        }
    }
    void add_moving(const PartRow& row, double h) noexcept {
        const double coming = work_ahead(row, h);
        moves = true;
        ahead += coming;
        if (!row.elastic || row.flows()) of_flows += coming;
        if (row.elastic) nearest = std::max(nearest, row.share);
    }
    /// Springs near their strength may come to flow, by no more than they hold, `stored` [J].
    [[nodiscard]] double near_flow(double scale, double stored) const noexcept {
        if (!(nearest > detail::near_strength)) return scale;
        return std::min(scale, of_flows + detail::of_stored * stored +
                                   detail::unmissed * (unmissed + of_springs));
    }
};

/// In the part before, at or near its strength.
DUCTILE_INLINE bool FrameControl::flowed(std::size_t row, const PartMotion& motion) const noexcept {
    constexpr double near = 0.5;
    return detail::was_there(past_, motion, row) && before_ > 0 && past_[row].row.moves() &&
           past_[row].row.share > near;
}

/// In this part, not in one before.
DUCTILE_INLINE bool FrameControl::breaks(std::size_t row, const PartMotion& motion) const noexcept {
    const bool broke_before = detail::was_there(past_, motion, row) && past_[row].row.broke > 0;
    return motion.rows[row].broke > 0 && !broke_before;
}

/// In a part below the `shortest` contacts are struck, which misplaces nothing.
DUCTILE_INLINE FrameControl::Judgement FrameControl::judge(const PartMotion& motion, double h,
                                                           double shortest) const {
    Judgement judged;
    Tally all{.work = motion.plastic_work - motion.idle_work,
              .least = motion.closed_work,
              .unmissed = motion.closed_work};
    double largest = 0;
    judged.of_one = motion.closed_work;
    bool lets_go = false; // a joint breaks: what its spring sets free is no misfit
    double held = h;      // until the first joint broke
    double held_share = motion.closed_share; // of its strength, by a rigid row
    for (std::size_t i = 0; i < motion.rows.size(); ++i) {
        if (!breaks(i, motion)) continue;
        const PartRow& row = motion.rows[i];
        const PartBefore known = before(i, motion);
        const BrokeAlone broke = row.alone ? broke_alone(row, known, flowed(i, motion))
                                           : broke_with_others(row, h, known);
        judged.astray += broke.astray;
        all.freed += row.freed;
        held = std::min(held, broke.stop);
        if (broke.astray > largest) {
            largest = broke.astray;
            judged.stop = broke.stop;
        }
    }
    for (std::size_t i = 0; i < motion.rows.size(); ++i) {
        const PartRow& row = motion.rows[i];
        all.add(row);
        judged.of_one = std::max(judged.of_one, row.strength * row.least);
        judged.turned =
            std::max(judged.turned, row.too_far / (detail::of_turns * small_turn<double>));
        judged.given += row.given;
        lets_go = lets_go || row.broke > 0;
        if (!(row.broke > 0) || breaks(i, motion)) judged.error += row.misfit;
        judged.struck += row.unfit;
        if (!row.elastic && (row.starts() || !row.moves()))
            held_share = std::max(held_share, row.share);
        if (!row.moves()) continue;
        const double later = flow_after(row, held, h);
        judged.astray += later;
        if (later > largest) {
            largest = later;
            judged.stop = held;
        }
        const Misplaced off = misplaced(row, h, before(i, motion));
        const double error = misplaced_energy(row, off, all.work);
        judged.error += error;
        judged.ended = judged.ended || off.ended;
        if (off.stop > 0 && error > largest) {
            largest = error;
            judged.stop = off.stop;
        }
        all.add_moving(row, h);
        judged.of_rows = judged.error;
        judged.power += row.strength * std::abs(row.start + row.end) / 2;
        judged.most += row.strength * row.speed() * h;
    }
    if (const double turn = detail::turn_of(motion); turn > detail::followed_turn) {
        judged.turned = std::max(judged.turned, turn / (detail::of_turns * detail::followed_turn));
    }
    judged.error += judged.given + judged.astray;
    // velocities that did not fit may rest in the part untold by rigid rows; a spring still moves
    judged.struck = std::max(judged.struck, motion.rigid_work);
    judged.least = all.least;
    const bool rested = judged.struck + std::min(taken_, 0.0) > detail::unmissed * judged.least;
    judged.moves = all.moves || (rested && all.unmissed > 0 && !lets_go);
    if (judged.moves) {
        // velocities that did not fit are struck too, once; what rows give is never a blow
        judged.fitted = h <= shortest && judged.struck > 0 && !fitted_;
        if (!judged.fitted) {
            judged.error += std::max(judged.struck, -motion.rigid_work);
            judged.error += std::max(motion.others_work, 0.0);
        }
        if (!(h <= shortest)) {
            judged.error += detail::contact_share * std::abs(motion.contact_work);
        }
        if (motion.contact_lost) judged.error += judged.power * h / 2;
    }
    const double share = tolerated_share();
    double scale = all.ahead + detail::unmissed * all.least;
    const bool near = held_share * motion.own.peak > detail::near_peak;
    if (near) {
        judged.error += motion.own.swings;
        scale += detail::of_stored * motion.own.energy;
    }
    judged.error += std::min(motion.own.late, 1.0) * judged.most;
    if (near || judged.moves) {
        judged.error += motion.own.stops;
        if (motion.own.stops > largest) judged.stop = motion.own.stop;
    }
    judged.tolerated = share * (all.work + all.near_flow(scale, motion.stored) + all.freed);
    judge_islands(motion, h, judged);
    judged.allowed = judged.tolerated;
    // a push that came too early took this share of the speed
    if (pushed_too_early(motion.closed, h, share)) judged.closed = motion.closed;
    if (used() > detail::coarse_from) {
        judged.allowed *= std::pow(10.0, 8 * (used() - detail::coarse_from));
    }
    return judged;
}

/// What one misplaces is a share of its own work, whatever others do: where that is the larger
/// share it counts as such of all work. Of islands the rows alone tell, so that what contacts and
/// the engine's joints took is judged for all of them together.
DUCTILE_INLINE void FrameControl::judge_islands(const PartMotion& motion, double h,
                                                Judgement& judged) const {
    const int first = motion.rows.empty() ? -1 : motion.rows.front().island;
    int last = first;
    bool one = true, members = motion.closed_work > 0; // which have no number
    for (const PartRow& row : motion.rows) {
        one = one && row.island == first;
        last = std::max(last, row.island);
        members = members || row.island < 0;
    }
    if (one) return;
    std::vector<Tally> islands(std::size_t(last + 1));
    for (const PartRow& row : motion.rows) {
        if (row.island < 0) continue;
        islands[std::size_t(row.island)].work += row.work;
    }
    for (std::size_t i = 0; i < motion.rows.size(); ++i) {
        const PartRow& row = motion.rows[i];
        if (row.island < 0) continue;
        Tally& island = islands[std::size_t(row.island)];
        island.add(row);
        island.error += row.given;
        island.unfit += row.unfit;
        if (!(row.broke > 0)) island.error += row.misfit;
        if (breaks(i, motion)) {
            island.error += row.misfit + row.astray;
            island.freed += row.freed;
        }
        if (!row.moves()) continue;
        island.add_moving(row, h);
        const Misplaced off = misplaced(row, h, before(i, motion));
        island.error += misplaced_energy(row, off, island.work);
    }
    double worst = 0, unfit = 0, share = judged.tolerated;
    double untouched = 0; // of all that never flowed
    for (const Tally& island : islands) {
        if (!(island.least > 0)) continue; // it has none, or none that holds
        const double scale =
            island.near_flow(island.ahead + detail::unmissed * island.least, motion.stored);
        const double tolerated = tolerated_share() * (island.work + scale + island.freed);
        if (island.moves || island.work > 0) {
            share = std::min(share, tolerated);
        } else {
            untouched += tolerated;
        }
        const double struck = judged.fitted ? 0 : island.unfit;
        unfit = std::max(unfit, struck / tolerated);
        worst = std::max(worst, (island.error + struck) / tolerated);
    }
    if (untouched > 0) share = std::min(share, untouched);
    judged.error = std::max(judged.error, worst * judged.tolerated);
    judged.struck = std::max(judged.struck, unfit * judged.tolerated);
    if (!members && judged.tolerated > 0) judged.of_island = share / judged.tolerated;
}

} // namespace ductile
