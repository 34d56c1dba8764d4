// SPDX-License-Identifier: MIT
//
// Bodies of a plan that their closed joints make one rigid body: mass, inertia, place and motion.
// One that joints hold to the ground has the world's frame and does not move.
//
// A body that leaves goes on with the velocity of its place, v + ω × r; what becomes one keeps the
// sums of momentum and of moment of momentum. Bodies stay where they are against each other, to the
// last bit of their joints' drift.
//
// Symbols
//   v, ω  velocity of the centre of mass and spin, world axes [m/s], [rad/s]
//   r     from the centre, world axes                         [m]
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "ductile/member/member_piece.hpp"
#include "ductile/numeric/symmetric_axes.hpp"
#include "ductile/structure/plan_body.hpp"

namespace ductile {

/// The axes nearest to these, which round-off has turned out of square.
[[nodiscard]] inline Matrix3<double> squared_up(const Matrix3<double>& axes) {
    const auto unit = [](const Vector3<double>& v) { return scaled(1 / norm(v), v); };
    const Vector3<double> z = unit(column(axes, 2)), x = unit(cross(column(axes, 1), z)),
                          y = cross(z, x);
    Matrix3<double> result;
    for (int i = 0; i < 3; ++i) {
        result(i, 0) = x[i];
        result(i, 1) = y[i];
        result(i, 2) = z[i];
    }
    return result;
}

/// Plain value.
struct Cluster {
    std::vector<std::size_t> bodies;                   ///< of the plan, rising
    bool held = false;                                 ///< to the ground
    double mass = 0;                                   ///< [kg]
    Vector3<double> inertia = Vector3<double>::Zero(); ///< along its frame [kg m²]
    std::vector<JointFrame<double>> places;            ///< of its bodies, in its frame

    [[nodiscard]] const JointFrame<double>& place(std::size_t body) const noexcept {
        std::size_t i = 0;
        while (bodies[i] != body) ++i;
        return places[i];
    }
};

/// `bodies` as one; `all`: where the plan's bodies are. Where it is is told in `at`.
[[nodiscard]] inline Cluster make_cluster(std::vector<std::size_t> bodies, bool held,
                                          std::span<const PlanBody> plan,
                                          std::span<const PlacedBody> all, PlacedBody& at) {
    Cluster result;
    result.bodies = std::move(bodies);
    result.held = held;
    at = {};
    for (const std::size_t b : result.bodies) result.mass += plan[b].mass;
    if (held || result.bodies.size() == 1) {
        if (!held) {
            at = all[result.bodies.front()];
            result.inertia = plan[result.bodies.front()].inertia;
        }
    } else {
        Vector3<double> momentum = Vector3<double>::Zero(), about = momentum;
        for (const std::size_t b : result.bodies) {
            const double share = plan[b].mass / result.mass;
            at.pose.origin = sum(at.pose.origin, scaled(share, all[b].pose.origin));
            momentum = sum(momentum, scaled(plan[b].mass, all[b].motion.velocity));
        }
        Matrix3<double> tensor = Matrix3<double>::Zero();
        for (const std::size_t b : result.bodies) {
            const Vector3<double> arm = difference(all[b].pose.origin, at.pose.origin);
            const Matrix3<double> across = skew(arm),
                                  own = along_axes(plan[b].inertia, all[b].pose.axes);
            tensor = sum(tensor, sum(own, scaled(plan[b].mass, times_transposed(across, across))));
            about = sum(about, sum(times(own, all[b].motion.spin),
                                   scaled(plan[b].mass, cross(arm, all[b].motion.velocity))));
        }
        const auto principal = numeric::symmetric_axes(tensor);
        result.inertia = principal.values;
        at.pose.axes = principal.axes;
        at.motion.velocity = scaled(1 / result.mass, momentum);
        Vector3<double> along = transposed_times(principal.axes, about);
        for (int i = 0; i < 3; ++i) along[i] /= result.inertia[i];
        at.motion.spin = times(principal.axes, along);
    }
    for (const std::size_t b : result.bodies) {
        const JointFrame<double>& pose = all[b].pose;
        result.places.push_back(
            {transposed_times(at.pose.axes, difference(pose.origin, at.pose.origin)),
             transposed_times(at.pose.axes, pose.axes)});
    }
    return result;
}

/// Where a body of a cluster is, and how it moves.
[[nodiscard]] inline PlacedBody within(const PlacedBody& cluster, bool held,
                                       const JointFrame<double>& place) {
    PlacedBody result{placed(cluster.pose, place), {}};
    if (held) return result;
    const Vector3<double> r = difference(result.pose.origin, cluster.pose.origin);
    result.motion = {cluster.motion.at(r), cluster.motion.spin};
    return result;
}

} // namespace ductile
