// SPDX-License-Identifier: MIT
//
// Contact of a sharp straight edge with one face of a box: all that touches in a Charpy test are the
// two edges of the nose on the specimen's front and the two edges of the anvils on its back.
//
// The engines' own box collision finds a contact only after it has penetrated, and for a nose of 2 mm
// picks the wrong side of it at steps of 0.1 ms. Here the normal is the face's, and points are
// reported while they are still apart, so that a solver stops the approach at the surface instead of
// pushing out afterwards.
//
// When a contact is made: a step's forces act over the whole step, so a contact made in the step in
// which the surfaces meet acts too long by the share of the step before they met, and one made in the
// next step too late by the rest. `reach` makes it in whichever step holds the larger share: the error
// is at most half a step of force, of either sign. A contact once made is kept while it is near.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace charpy {

using Vector = Eigen::Vector3d;
using Rotation = Eigen::Matrix3d;

struct Edge {
    Vector from, to; ///< world [m]
};

/// A box's face normal to its local x axis: side +1 is the front, -1 the back.
struct BoxFace {
    Vector centre;     ///< of the box, world [m]
    Rotation rotation; ///< box to world
    Vector half;       ///< half extents [m]
    double side = 1;
};

struct ContactPoint {
    Vector position = Vector::Zero(); ///< on the edge, world [m]
    Vector normal = Vector::Zero();   ///< of the face, outwards, world
    double gap = 0;  ///< from face to edge along the normal, negative where it penetrates [m]
};

/// Of the two ends of the part of the edge that lies over the face those that are nearer than
/// `margin` [m]; none where one is through the box's other side. `count` of `points` are valid.
struct EdgeContact {
    int count = 0;
    std::array<ContactPoint, 2> points;
};

[[nodiscard]] inline EdgeContact touch(const Edge& edge, const BoxFace& face, double margin) {
    EdgeContact result;
    const Vector p = face.rotation.transpose() * (edge.from - face.centre);
    const Vector q = face.rotation.transpose() * (edge.to - face.centre);
    // clip the edge to the face's rectangle
    double lo = 0, hi = 1;
    for (const int axis : {1, 2}) {
        const double span = q[axis] - p[axis];
        for (const double bound : {-face.half[axis], face.half[axis]}) {
            const double inward = bound < 0 ? 1 : -1;
            const double inside = inward * (p[axis] - bound), slope = inward * span;
            if (slope == 0) {
                if (inside < 0) return result;
            } else if (slope > 0) {
                lo = std::max(lo, -inside / slope);
            } else {
                hi = std::min(hi, -inside / slope);
            }
        }
    }
    if (!(lo < hi)) return result;
    const Vector normal = face.side * face.rotation.col(0);
    for (const double t : {lo, hi}) {
        const Vector local = p + t * (q - p);
        const double gap = face.side * local.x() - face.half.x();
        if (gap < -2 * face.half.x()) return {};
        if (gap > margin) continue;
        result.points[std::size_t(result.count++)] = {edge.from + t * (edge.to - edge.from), normal, gap};
    }
    return result;
}

/// How near an edge must be to make a contact [m]: half of what it closes in the step, given the closing
/// speed [m/s]; the thickness of the part where the contact was made before.
[[nodiscard]] inline double reach(bool made, double thickness, double closing_speed, double dt) {
    constexpr double resting = 1e-6; // apart only by round-off
    return made ? thickness : std::max(closing_speed, 0.0) * dt / 2 + resting;
}

/// Speed at which a contact point parts again, by Newton's rule [m/s]: the share `restitution` of the speed at which
/// it closes. None below 0.2 m/s, Bullet's threshold, without which contacts at rest would never come to rest.
[[nodiscard]] inline double rebound(double restitution, double closing_speed) {
    constexpr double slowest = 0.2; // [m/s]
    return closing_speed > slowest ? restitution * closing_speed : 0;
}

/// How far a contact gives way, which keeps direct solvers from failing on redundant contacts [m/s/N]: 10 kN yield
/// at 1 mm/s. A rebound takes the whole blow in one step, in which that would swallow a fifth of the speed.
[[nodiscard]] inline double compliance(double restitution) { return restitution > 0 ? 1e-10 : 1e-7; }

/// The edges of a hammer that can strike, in a frame at the middle of the flat that strikes first:
/// those of the flat and, where there is draft, those where the taper ends. Along y they reach
/// `half_height` to both sides [m].
[[nodiscard]] inline std::vector<Edge> hammer_edges(double flat, double draft, double thickness,
                                                    double half_height) {
    std::vector<Edge> edges;
    const auto pair = [&](double x, double width) {
        for (const double z : {-width / 2, width / 2}) {
            edges.push_back({Vector(x, -half_height, z), Vector(x, half_height, z)});
        }
    };
    pair(0, flat);
    if (draft > 0) pair(draft, thickness);
    return edges;
}

} // namespace charpy
