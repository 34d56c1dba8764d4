// SPDX-License-Identifier: MIT
//
// Bodies of island_joint.hpp.
#pragma once

#include <cmath>

#include "ductile/world/island_joint.hpp"

namespace ductile {

namespace detail {

/// The six rows of a joint in an island: those that share a surface first, in its order.
struct RowOrder {
    std::array<JointAxis, 6> axes = all_joint_axes;
    std::array<int, 6> place{0, 1, 2, 3, 4, 5};         ///< of each axis
    int shared = 0;                                     ///< rows
    Vector6<double> strength = Vector6<double>::Zero(); ///< of those, by axis [N | N m]
};

DUCTILE_INLINE RowOrder row_order(const AnyLink<double>& link) noexcept {
    RowOrder order;
    order.strength = link.shared_strength();
    int next = 0;
    const auto put = [&](JointAxis axis) {
        order.axes[std::size_t(next)] = axis;
        order.place[index(axis)] = next++;
    };
    for (const JointAxis axis : link.axes()) {
        if (!(order.strength[Eigen::Index(index(axis))] > 0)) return {};
    }
    for (const JointAxis axis : link.axes()) put(axis);
    order.shared = next;
    for (const JointAxis axis : all_joint_axes) {
        if (!link.is_plastic(axis)) put(axis);
    }
    return order;
}

/// Of the rows that share a surface; without a row where none do.
DUCTILE_INLINE solve::IslandBlock block_of(const AnyLink<double>& link, const RowOrder& order,
                                           int first, double dt) {
    solve::IslandBlock block{.first = first, .count = order.shared};
    block.surface = link.surface();
    if (block.surface != nullptr) block.kind = solve::BlockKind::surface;
    for (int i = 0; i < block.count; ++i) {
        const auto axis = Eigen::Index(index(order.axes[std::size_t(i)]));
        block.size[std::size_t(i)] = order.strength[axis] * dt;
    }
    return block;
}

/// Share of a bound from where a row, or a surface, counts as reached.
inline constexpr double at_bound = 1 - 1e-5;

DUCTILE_INLINE void add_block(solve::Island& island, solve::IslandBlock block, bool reached) {
    if (reached) block.state = solve::BlockState::surface;
    island.blocks.push_back(block);
}

/// Compliance and bounds of a row [N s | N m s].
DUCTILE_INLINE void rule(solve::IslandRow& row, const RowLimits<double>& limits, double dt) {
    row.compliance = limits.compliance;
    row.softness = limits.softness;
    row.lower = limits.lower * dt;
    row.upper = limits.upper * dt;
}

/// Whether its bodies alone, and what its springs give, would need more than the surface has to
/// meet the rows' velocities.
DUCTILE_INLINE bool passes(const solve::Island& island, const solve::IslandBlock& block) {
    Vector6<double> share = Vector6<double>::Zero();
    for (int i = 0; i < block.count; ++i) {
        const solve::IslandRow& row = island.rows[std::size_t(block.first + i)];
        const double effect =
            (own_effect(island, row) + row.compliance) * block.size[std::size_t(i)];
        if (effect > 0) share[i] = row.target / effect;
    }
    return block.surface != nullptr ? block.surface->value(share) > 1 : share.squaredNorm() > 1;
}

/// True where the rows of a block are ruled anew, for a solver that meets their surface itself.
DUCTILE_INLINE bool meet_surface(solve::Island& island, AnyLink<double>& link,
                                 const RowOrder& order, const solve::IslandBlock& block,
                                 double dt) {
    if (block.count == 0) return false;
    const AnyLink<double>::Limits alone = link.limits();
    if (!link.meet_surface(dt, passes(island, block))) return false;
    for (const JointAxis axis : link.axes()) {
        solve::IslandRow& row = island.rows[std::size_t(block.first + order.place[index(axis)])];
        const RowLimits<double>& limits = link.limits()[index(axis)];
        row.target += limits.bias - alone[index(axis)].bias;
        rule(row, limits, dt);
    }
    return true;
}

/// Rows that flowed in the last step, or stood at their bounds.
DUCTILE_INLINE void begin_at_bounds(solve::Island& island, const AnyLink<double>& link,
                                    const RowOrder& order, int first) {
    for (const JointAxis axis : link.axes()) {
        const RowLimits<double>& limits = link.limits()[index(axis)];
        const double force = link.forces()[Eigen::Index(index(axis))];
        solve::IslandRow& row = island.rows[std::size_t(first + order.place[index(axis)])];
        if (force < 0 && force <= at_bound * limits.lower) row.side = solve::Side::lower;
        if (force > 0 && force >= at_bound * limits.upper) row.side = solve::Side::upper;
    }
}

} // namespace detail

DUCTILE_INLINE solve::IslandRow& add_row(solve::Island& island, const IslandSeat& a,
                                         const IslandSeat& b, const Vector3<double>& arm_a,
                                         const Vector3<double>& arm_b, const Vector3<double>& along,
                                         double target) {
    const Vector3<double> about_a = cross(arm_a, along), about_b = cross(arm_b, along);
    solve::IslandRow& row = island.rows.emplace_back();
    row.a = a.number;
    row.b = b.number;
    row.on_a = twist_of(along, about_a);
    row.on_b = -twist_of(along, about_b);
    row.target = target - dot(along, a.velocity) - dot(about_a, a.spin) + dot(along, b.velocity) +
                 dot(about_b, b.spin);
    return row;
}

DUCTILE_INLINE solve::IslandRow& add_moment_row(solve::Island& island, const IslandSeat& a,
                                                const IslandSeat& b, const Vector3<double>& about,
                                                double target) {
    const Vector3<double> none = Vector3<double>::Zero();
    solve::IslandRow& row = island.rows.emplace_back();
    row.a = a.number;
    row.b = b.number;
    row.on_a = twist_of(none, about);
    row.on_b = -row.on_a;
    row.target = target - dot(about, a.spin) + dot(about, b.spin);
    return row;
}

DUCTILE_INLINE int add_rows(solve::Island& island, AnyLink<double>& link, const IslandSeat& a,
                            const IslandSeat& b, double dt) {
    const int first = int(island.rows.size());
    const LinkPose<double>& pose = link.pose();
    const detail::RowOrder order = detail::row_order(link);
    for (const JointAxis axis : order.axes) {
        const auto i = Eigen::Index(index(axis));
        const RowLimits<double>& limits = link.limits()[index(axis)];
        const Matrix3<double>& directions = turns(axis) ? pose.moment_axes() : pose.axes();
        const Vector3<double> direction = column(directions, int(i % 3));
        solve::IslandRow& row =
            turns(axis) ? add_moment_row(island, a, b, direction, limits.bias)
                        : add_row(island, a, b, pose.arm_a(), pose.arm_b(), direction, limits.bias);
        detail::rule(row, limits, dt);
        row.impulse = link.forces()[i] * dt; // so that contacts begin with slips near the answer's
    }
    const solve::IslandBlock block = detail::block_of(link, order, first, dt);
    // one that stands may have reached it too
    const bool reached = link.totals().flowing || link.utilisation() >= detail::at_bound;
    if (detail::meet_surface(island, link, order, block, dt)) {
        detail::add_block(island, block, reached);
    } else if (reached) {
        detail::begin_at_bounds(island, link, order, first);
    }
    return first;
}

DUCTILE_INLINE BodyState<double> leaving(const solve::Island& island, const IslandSeat& seat,
                                         BodyState<double> body) {
    body.velocity = seat.velocity;
    body.spin = seat.spin;
    if (seat.number == solve::immovable) return body;
    const Vector6<double>& change = island.bodies[std::size_t(seat.number)].velocity;
    body.velocity = sum(body.velocity, linear(change));
    body.spin = sum(body.spin, angular(change));
    return body;
}

DUCTILE_INLINE bool turn_rows(solve::Island& island, AnyLink<double>& link, int first,
                              const BodyState<double>& a, const BodyState<double>& b, double dt) {
    const Vector3<double> change = link.turn_at_end(a, b, dt);
    if (is_zero(change)) return false;
    const detail::RowOrder order = detail::row_order(link);
    for (int i = 0; i < 3; ++i) {
        island.rows[std::size_t(first + order.place[std::size_t(i)])].target += change[i];
    }
    return true;
}

DUCTILE_INLINE void add_given_rows(solve::Island& island, const IslandSeat& a, const IslandSeat& b,
                                   const LinkPose<double>& pose,
                                   const JointImpulse<double>& impulse) {
    const Vector3<double> none = Vector3<double>::Zero();
    for (int i = 0; i < 6; ++i) {
        Vector3<double> unit = none;
        unit[i % 3] = 1;
        solve::IslandRow& row = i < 3 ? add_row(island, a, b, pose.arm_a(), pose.arm_b(), unit, 0)
                                      : add_moment_row(island, a, b, unit, 0);
        row.lower = row.upper = (i < 3 ? impulse.linear : impulse.angular)[i % 3];
        row.side = solve::Side::lower;
    }
}

DUCTILE_INLINE Vector6<double> take_forces(const solve::Island& island, AnyLink<double>& link,
                                           int first, double dt) noexcept {
    link.see_island(island.unsolved);
    Vector6<double> forces;
    const detail::RowOrder order = detail::row_order(link);
    for (int i = 0; i < 6; ++i) {
        const int row = first + order.place[std::size_t(i)];
        forces[i] = island.rows[std::size_t(row)].impulse / dt;
    }
    return forces;
}

DUCTILE_INLINE void begin_contact(solve::Island& island, solve::IslandBlock contact) {
    constexpr double slides = 1 - 1e-6;
    solve::IslandRow& normal = island.rows[std::size_t(contact.first)];
    const bool open = !(normal.impulse > 0 || normal.target > 0);
    if (contact.count == 1) {
        normal.lower = 0;
        normal.side = open ? solve::Side::lower : solve::Side::free;
        return;
    }
    double square = 0, slip = 0;
    for (int k = 1; k < contact.count; ++k) {
        const solve::IslandRow& row = island.rows[std::size_t(contact.first + k)];
        square += std::pow(row.impulse / contact.size[std::size_t(k)], 2);
        slip += std::pow(row.target * contact.size[std::size_t(k)], 2);
    }
    if (open) {
        contact.state = solve::BlockState::apex;
    } else if (square > 0 && std::sqrt(square) >= slides * normal.impulse) {
        contact.state = solve::BlockState::surface;
        contact.multiplier = std::sqrt(slip); // as before the step
    }
    island.blocks.push_back(contact);
}

} // namespace ductile
