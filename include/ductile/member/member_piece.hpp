// SPDX-License-Identifier: MIT
//
// A run of segments as one rigid body: mass, inertia, shape, and what becomes of motion where
// bodies are split or made one.
//
// Its frame: origin at the centre of mass, x as the member's, y and z turned about x to where the
// inertia is diagonal, the nearest to the first segment's. One with a held segment has the frame of
// that segment and does not move.
//
// Split. Each piece goes on with the velocity of its place in the whole, v + ω × r: momentum,
// moment of momentum and energy stay what they are, as masses and inertias add up.
// Fused. The whole gets the sums of momentum and of moment of momentum about its centre; its place
// is where the centre of mass of the pieces is and the heaviest of them points to. Energy is lost
// where they moved against each other, ½ Σ m u².
//
// Symbols
//   v, ω  velocity of the centre of mass and spin, world axes [m/s], [rad/s]
//   r     from the centre of the whole, world axes            [m]
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "ductile/joint/link_types.hpp"
#include "ductile/member/member_state.hpp"
#include "ductile/vocabulary/check.hpp"
#include "ductile/vocabulary/vector.hpp"

namespace ductile {

/// `inner` is given in `outer`.
[[nodiscard]] inline JointFrame<double> placed(const JointFrame<double>& outer,
                                               const JointFrame<double>& inner) {
    return {sum(outer.origin, times(outer.axes, inner.origin)), times(outer.axes, inner.axes)};
}
/// The frame whose `inner` is where `inner_in_world` is.
[[nodiscard]] inline JointFrame<double> frame_around(const JointFrame<double>& inner_in_world,
                                                     const JointFrame<double>& inner) {
    const Matrix3<double> axes = times_transposed(inner_in_world.axes, inner.axes);
    return {difference(inner_in_world.origin, times(axes, inner.origin)), axes};
}
[[nodiscard]] inline Matrix3<double> turned_about_x(double angle) {
    Matrix3<double> turn = Matrix3<double>::Identity();
    turn(1, 1) = turn(2, 2) = std::cos(angle);
    turn(2, 1) = std::sin(angle);
    turn(1, 2) = -turn(2, 1);
    return turn;
}

/// The matrix that is diagonal along `axes`.
[[nodiscard]] inline Matrix3<double> along_axes(const Vector3<double>& diagonal,
                                                const Matrix3<double>& axes) {
    Matrix3<double> scaled_axes = axes;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) scaled_axes(i, j) *= diagonal[j];
    }
    return times_transposed(scaled_axes, axes);
}

/// How a body moves. Plain value.
struct BodyMotion {
    Vector3<double> velocity = Vector3<double>::Zero(); ///< v [m/s]
    Vector3<double> spin = Vector3<double>::Zero();     ///< ω [rad/s]

    /// Of the point `r` [m] from the centre.
    [[nodiscard]] Vector3<double> at(const Vector3<double>& r) const noexcept {
        return sum(velocity, cross(spin, r));
    }
};

/// What acts on a body, about its centre of mass, world axes [N], [N m]. Plain value.
struct Wrench {
    Vector3<double> force = Vector3<double>::Zero(), torque = force;
};

/// A body, or several that are one, somewhere. Plain value.
struct PlacedBody {
    JointFrame<double> pose;
    BodyMotion motion;
};

/// Of a snapshot, which calls them `bodies`.
/// @throws std::invalid_argument where one is nowhere or moves at no finite velocity.
inline void require_finite(const std::string& snapshot, std::span<const PlacedBody> bodies) {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        const std::string field = snapshot + ".bodies[" + std::to_string(i) + "].";
        const auto require = [&field](const char* what, const Vector3<double>& v,
                                      const char* unit) {
            for (const double x : v) check::finite(field + what, x, unit);
        };
        const auto& [pose, motion] = bodies[i];
        require("place", pose.origin, "m");
        for (int k = 0; k < 3; ++k) require("axes", column(pose.axes, k), "");
        require("velocity", motion.velocity, "m/s");
        require("spin", motion.spin, "rad/s");
    }
}

/// Plain value.
struct MemberPiece {
    MemberRun run;
    bool held = false;
    double mass = 0;                                   ///< [kg]
    Vector3<double> inertia = Vector3<double>::Zero(); ///< along its frame [kg m²]
    std::vector<JointFrame<double>> segments;          ///< their middles, in its frame

    [[nodiscard]] const JointFrame<double>& segment(int k) const noexcept {
        return segments[std::size_t(k - run.first)];
    }
    /// Where segment `k` of it ends (`end`) or begins, in its frame.
    [[nodiscard]] JointFrame<double> section(const Member& member, int k, bool end) const {
        const double half = member.segment(k).length / 2;
        return placed(segment(k), {.origin = {0, 0, end ? half : -half}});
    }
    /// World axes, where its frame has these `axes`; of one that is held 0.
    [[nodiscard]] Matrix3<double> inertia_in_world(const Matrix3<double>& axes) const {
        return along_axes(inertia, axes);
    }
    [[nodiscard]] Matrix3<double> inverse_inertia_in_world(const Matrix3<double>& axes) const {
        if (held) return Matrix3<double>::Zero();
        return along_axes({1 / inertia[0], 1 / inertia[1], 1 / inertia[2]}, axes);
    }
};

/// The segment of a piece at `pose` that is nearest to `point`, both in the world; not one that has
/// no length.
[[nodiscard]] inline int nearest_segment(const Member& member, const MemberPiece& piece,
                                         const JointFrame<double>& pose,
                                         const Vector3<double>& point) {
    int nearest = piece.run.last;
    double least = std::numeric_limits<double>::infinity();
    for (int k = piece.run.first; k <= piece.run.last; ++k) {
        if (member.segment(k).held) continue;
        const JointFrame<double> segment = placed(pose, piece.segment(k));
        Vector3<double> off = transposed_times(segment.axes, difference(point, segment.origin));
        const double half = member.segment(k).length / 2;
        off[2] -= std::clamp(off[2], -half, half);
        const double away = dot(off, off);
        if (away >= least) continue;
        least = away;
        nearest = k;
    }
    return nearest;
}

/// Segments in a row without a bend, as one length. Plain value.
struct StraightStretch {
    MemberRun run;
    JointFrame<double> middle; ///< in the frame of the piece
    double length = 0;         ///< [m], > 0
};

/// How far what a member collides with goes beyond its ends, its own axes [m], >= 0.
struct MemberOverhang {
    double before = 0, beyond = 0;

    /// Of what reaches from `low` to `high` along the member, whose start is at 0. That of a
    /// clamped one stays in the ground.
    [[nodiscard]] static MemberOverhang of(const Member& member, double low, double high) noexcept {
        const double hair = 1e-6 * member.length();
        const auto over = [hair](double length) { return length > hair ? length : 0.0; };
        return {member.clamped() ? 0 : over(-low), over(high - member.length())};
    }
};

/// Of a piece from its start, a held segment left out. A solid for each of them has no inner faces
/// but where it is bent: two solids in a row, one body, would push aside whatever has its edge
/// where they meet.
[[nodiscard]] inline std::vector<StraightStretch> straight_stretches(
    const Member& member, const MemberPiece& piece, const MemberOverhang& over = {}) {
    constexpr double straight_enough = 1e-6; // [rad]
    std::vector<StraightStretch> result;
    for (int k = piece.run.first; k <= piece.run.last; ++k) {
        if (member.segment(k).held) continue;
        const JointFrame<double>& segment = piece.segment(k);
        const bool goes_on =
            !result.empty() && std::abs(dot(column(result.back().middle.axes, 1),
                                            column(segment.axes, 2))) < straight_enough;
        if (!goes_on) result.push_back({{k, k}, segment, 0});
        StraightStretch& stretch = result.back();
        stretch.run.last = k;
        stretch.length += member.segment(k).length;
        const JointFrame<double> start = piece.section(member, stretch.run.first, false);
        stretch.middle.origin =
            sum(start.origin, scaled(stretch.length / 2, column(stretch.middle.axes, 2)));
    }
    const auto lengthen = [](StraightStretch& stretch, double by, int way) {
        stretch.length += by;
        stretch.middle.origin =
            sum(stretch.middle.origin, scaled(way * by / 2, column(stretch.middle.axes, 2)));
    };
    if (result.empty()) return result;
    if (piece.run.first == 0) lengthen(result.front(), over.before, -1);
    if (piece.run.last == member.segments() - 1) lengthen(result.back(), over.beyond, 1);
    return result;
}

/// `state` says how far the sections within the run are bent.
[[nodiscard]] inline MemberPiece make_piece(const Member& member, const MemberState& state,
                                            const MemberRun& run) {
    MemberPiece piece;
    piece.run = run;
    piece.held = member.segment(run.first).held;
    JointFrame<double> at; // where a segment begins
    for (int k = run.first; k <= run.last; ++k) {
        if (k > run.first) at.axes = times(at.axes, turned_about_x(state[std::size_t(k - 1)].bend));
        const Vector3<double> half = scaled(member.segment(k).length / 2, column(at.axes, 2));
        piece.segments.push_back({sum(at.origin, half), at.axes});
        at.origin = sum(at.origin, scaled(2, half));
        piece.mass += member.segment(k).mass;
    }
    if (piece.held) return piece;
    Vector3<double> centre = Vector3<double>::Zero();
    for (int k = run.first; k <= run.last; ++k) {
        centre = sum(centre, scaled(member.segment(k).mass / piece.mass, piece.segment(k).origin));
    }
    Matrix3<double> inertia = Matrix3<double>::Zero();
    for (int k = run.first; k <= run.last; ++k) {
        const JointFrame<double>& pose = piece.segment(k);
        const Matrix3<double> arm = skew(difference(pose.origin, centre));
        inertia = sum(inertia, sum(along_axes(member.segment(k).inertia, pose.axes),
                                   scaled(member.segment(k).mass, times_transposed(arm, arm))));
    }
    const double twice = std::atan(2 * inertia(1, 2) / (inertia(1, 1) - inertia(2, 2)));
    const Matrix3<double> turn = turned_about_x(inertia(1, 2) == 0 ? 0 : twice / 2);
    const Matrix3<double> along = transposed_times(turn, times(inertia, turn));
    piece.inertia = {along(0, 0), along(1, 1), along(2, 2)};
    for (JointFrame<double>& pose : piece.segments) {
        pose = {transposed_times(turn, difference(pose.origin, centre)),
                transposed_times(turn, pose.axes)};
    }
    return piece;
}

/// A piece somewhere. Plain value.
struct PlacedPiece {
    const MemberPiece* piece = nullptr;
    JointFrame<double> pose;
    BodyMotion motion;
};

/// `part` of `whole`, which has its segments among its own, placed.
[[nodiscard]] inline PlacedPiece split_off(const PlacedPiece& whole, const MemberPiece& part) {
    const JointFrame<double> first = placed(whole.pose, whole.piece->segment(part.run.first));
    const JointFrame<double> pose = frame_around(first, part.segment(part.run.first));
    PlacedPiece result{&part, pose, {}};
    if (part.held || whole.piece->held) return result;
    result.motion = {whole.motion.at(difference(pose.origin, whole.pose.origin)),
                     whole.motion.spin};
    return result;
}

/// `whole` of `parts` in order, which have all its segments. At the start, `held` is where the held
/// segment is.
[[nodiscard]] inline PlacedPiece fused(std::span<const PlacedPiece> parts,
                                       const MemberPiece& whole) {
    const PlacedPiece* heaviest = &parts.front();
    if (!whole.held) {
        for (const PlacedPiece& part : parts) {
            if (part.piece->mass > heaviest->piece->mass) heaviest = &part;
        }
    }
    const int first = heaviest->piece->run.first;
    PlacedPiece result{
        &whole,
        frame_around(placed(heaviest->pose, heaviest->piece->segment(first)), whole.segment(first)),
        {}};
    if (whole.held) return result;
    Vector3<double> centre = Vector3<double>::Zero(), momentum = centre, about = centre;
    for (const PlacedPiece& part : parts) {
        centre = sum(centre, scaled(part.piece->mass / whole.mass, part.pose.origin));
        momentum = sum(momentum, scaled(part.piece->mass, part.motion.velocity));
    }
    result.pose.origin = centre;
    for (const PlacedPiece& part : parts) {
        const Vector3<double> of_part =
            times(part.piece->inertia_in_world(part.pose.axes), part.motion.spin);
        about = sum(
            about, sum(of_part, scaled(part.piece->mass, cross(difference(part.pose.origin, centre),
                                                               part.motion.velocity))));
    }
    result.motion = {scaled(1 / whole.mass, momentum),
                     times(whole.inverse_inertia_in_world(result.pose.axes), about)};
    return result;
}

/// `pieces`, each of what of `old` has its segments; both in order, with all segments of the
/// member.
[[nodiscard]] inline std::vector<PlacedPiece> rearranged(const Member& member,
                                                         const MemberState& state,
                                                         std::span<const PlacedPiece> old,
                                                         std::span<const MemberPiece> pieces) {
    std::vector<PlacedPiece> result;
    std::vector<MemberPiece> shared;
    std::vector<PlacedPiece> parts;
    for (const MemberPiece& piece : pieces) {
        shared.clear();
        shared.reserve(old.size());
        parts.clear();
        for (const PlacedPiece& from : old) {
            const MemberRun both{std::max(piece.run.first, from.piece->run.first),
                                 std::min(piece.run.last, from.piece->run.last)};
            if (both.first > both.last) continue;
            shared.push_back(make_piece(member, state, both));
            parts.push_back(split_off(from, shared.back()));
        }
        result.push_back(fused(parts, piece));
    }
    return result;
}

} // namespace ductile
