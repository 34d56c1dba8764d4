// SPDX-License-Identifier: MIT
//
// What the joints of any engine tell a frame of their last part (frame/part_row.hpp).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "ductile/frame/part_row.hpp"
#include "ductile/joint/any_link.hpp"
#include "ductile/joint/axis_joint.hpp"

namespace ductile {

/// Of what a row may be off by at rest, the speed that is as good as rest [-].
inline constexpr double resting_share = 0.01;

/// A spring that did not flow all the part: below that share of its strength at the mean.
[[nodiscard]] inline bool swings(bool flowing, double share) noexcept {
    constexpr double all_along = 0.99;
    return !flowing || share < all_along;
}

/// Of what a brittle joint took beyond what its springs hold, the share of the time in which it was
/// broken [J].
template <class Step>
[[nodiscard]] double released_late(const Step& last) noexcept {
    if (last.plastic_work > 0 || !(last.held > 0)) return 0;
    const double taken = std::abs(last.release) + std::abs(last.other_work);
    return taken * last.after_break / (last.held + last.after_break);
}

/// Of a flow along several axes, what its rows as they turned meanwhile would take more or less
/// than those that were solved [J]. Those are of where the bodies would be with the velocities u
/// that the part began with, right for a flow that goes on as it is; one from rest is by a h²/8
/// ahead of there in the middle, and at the end of the part has what its rows take for h/4. In
/// between it is |u' - u|/(|u| + |u'|) of that.
[[nodiscard]] inline double turned_flow(const AnyLink<double>& link,
                                        std::span<const PartRow> rows) noexcept {
    double start = 0, end = 0, turned = 0, change = 0;
    for (std::size_t k = 0; k < rows.size(); ++k) {
        const PartRow& row = rows[k];
        const double later = link.turned_velocities()[Eigen::Index(index(link.axes()[k]))];
        start += std::pow(row.strength * row.start, 2);
        end += std::pow(row.strength * row.end, 2);
        turned += std::pow(row.strength * later, 2);
        change += std::pow(row.strength * (row.end - row.start), 2);
    }
    const double both = std::sqrt(start) + std::sqrt(end);
    if (!(both > 0)) return 0;
    const double more = std::abs(std::sqrt(turned) - std::sqrt(end));
    return more * std::sqrt(change) / both * link.last_length() / 4;
}

/// Of the strength of an axis that shares a surface, what counts [-]: at most three times what it
/// has where the forces, grown in proportion, meet the surface. One far stronger than the axis that
/// flows holds, and what is off of its travel does the work of the force that it has.
[[nodiscard]] inline double along_forces(double own_share, double share) noexcept {
    constexpr double most = 3;
    return most * own_share < share ? most * own_share / share : 1;
}

/// Adds a row for each plastic axis; `joint`: its number; `acts`: the part was solved with it.
inline void add_part_rows(const AnyLink<double>& link, std::size_t joint, bool acts,
                          std::vector<PartRow>& rows) {
    const double share = acts ? link.utilisation() : 0;
    // waves along the axes of a section are for its dampers to end
    const bool spring = link.axes().size() == 1 && !link.all_rigid();
    double given = acts ? std::max(0.0, -link.last().damped) : 0;
    double misfit = link.last().misfit, freed = link.last().lost;
    double unfit = acts ? link.unfit() : 0;
    double astray = 0; // by its break
    const std::size_t first = rows.size();
    const bool snaps = acts && link.snaps();
    const bool alone = link.axes().size() == 1, flowed = link.last().plastic_work > 0;
    if (const double held = link.last().held; held > 0) {
        const double after = link.last().after_break / (held + link.last().after_break);
        astray = link.last().plastic_work * (alone ? 1 : after) + released_late(link.last());
    }
    for (const JointAxis axis : link.axes()) {
        const auto i = Eigen::Index(index(axis));
        PartRow& row = rows.emplace_back();
        row.joint = joint;
        row.noise = resting_share * link.absolute_residual();
        row.turning = link.turning_speed();
        row.least = link.least_travel();
        row.too_far = link.turned_too_far();
        row.carried = link.driven_turn();
        row.broke = link.last().held;
        if (row.broke > 0) {
            row.freed = std::exchange(freed, 0);
            row.astray = std::exchange(astray, 0);
            row.misfit = std::exchange(misfit, 0);
            row.alone = alone && flowed;
            row.snapped = !flowed;
            row.run = link.last().run;
            row.force = link.force(axis);
            row.start = link.start_velocities()[i];
            row.end = link.end_velocities()[i];
        }
        row.elastic = !link.all_rigid();
        if (!acts) continue;
        row.start = link.start_velocities()[i];
        row.end = link.end_velocities()[i];
        row.misfit = std::exchange(misfit, 0);
        row.unfit = std::exchange(unfit, 0);
        row.share = share;
        row.swings = spring && swings(link.totals().flowing, share);
        row.yielded = link.totals().plastic_work > 0;
        row.below = link.totals().flowing ? std::max(0.0, 1 - share) : 0;
        row.force = link.force(axis);
        row.strength = link.strength(axis);
        row.own_share = std::abs(link.force(axis)) / row.strength;
        row.spring = row.strength * row.strength / (2 * link.section_stiffness()[i]);
        row.given = std::exchange(given, 0);
        // a spring that snaps never flows: what nobody misses is of what it holds then
        if (row.elastic && snaps) row.least = std::min(row.least, row.spring / row.strength);
    }
    if (!acts || alone) return;
    const std::span of_joint = std::span(rows).subspan(first);
    if (link.totals().flowing) rows[first].misfit += turned_flow(link, of_joint);
    for (PartRow& row : of_joint) {
        const double counts = along_forces(row.own_share, share);
        row.strength *= counts;
        row.spring *= counts * counts;
    }
}

/// Adds the row; `force`: that of the part [N | N m]; `carried`: turn in it of a driven one of its
/// bodies [rad].
inline void add_part_row(const AxisJoint& axis, double force, double carried, std::size_t joint,
                         bool acts, std::vector<PartRow>& rows) {
    PartRow& row = rows.emplace_back();
    row.joint = joint;
    row.carried = carried;
    row.noise = resting_share * axis.allowed_residual(0);
    row.least = axis.least_travel();
    row.elastic = !axis.rigid();
    row.broke = axis.last().held;
    row.alone = axis.last().plastic_work > 0;
    row.snapped = !row.alone;
    row.run = axis.last().run;
    row.freed = axis.last().lost;
    row.force = force;
    if (row.broke > 0) row.astray = axis.last().plastic_work + released_late(axis.last());
    if (!acts && !(row.broke > 0)) return;
    row.misfit = axis.last().misfit;
    row.start = axis.start_velocity();
    row.end = axis.velocity();
    if (!acts || axis.broken()) return;
    row.strength = axis.strength(force > 0 ? -1 : 1);
    row.share = axis.utilisation(force);
    row.swings = row.elastic && swings(axis.totals().flowing, row.share);
    row.yielded = axis.totals().plastic_work > 0;
    row.spring = row.strength * row.strength / (2 * axis.stiffness());
}

} // namespace ductile
