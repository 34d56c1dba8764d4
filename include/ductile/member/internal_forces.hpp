// SPDX-License-Identifier: MIT
//
// What the sections within a rigid piece carry in a step, by inverse dynamics: what acts on one
// side of a section and is not in the motion of that side goes through the section,
//
//   F = Σ m (Δv + dt ω × (ω × r)) - Σ J,   M = Σ [ c × (...) + I Δω + dt ω × I ω ] - Σ (p × J + N)
//
// over all that is beyond it, moments about the section. Exact for impulses too. The sum goes on to
// the start of the piece, where nothing is left unless an impulse is missing or another was in the
// motion: `left_over`, the certificate. A piece that is held has what holds it there, and no
// certificate. O(segments + loads).
//
// One rigid body is the exact solution of the always-jointed member where no section is beyond what
// it can carry: sections that hold are rows within their bounds, and the velocities of such a
// system are unique. Where what holds a piece is redundant the impulses are not unique, and a
// section may be opened that holds then: at the cost of another solve, without an error
// (redundant_forces.hpp).
//
// Symbols, all in world axes
//   J, N, p   impulse, its moment, where it acts         [N s], [N m s], [m]
//   Δv, Δω    change of a segment's velocity in the step, gravity's left out  [m/s], [rad/s]
//   c, r      a segment's centre from the section, from the centre of the piece [m]
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "ductile/member/member_piece.hpp"

namespace ductile {

/// Acts on a segment in a step, whatever it comes from. Plain value.
struct MemberLoad {
    int segment = 0;
    Vector3<double> point = Vector3<double>::Zero();   ///< p [m]
    Vector3<double> impulse = Vector3<double>::Zero(); ///< J [N s]
    Vector3<double> moment = Vector3<double>::Zero();  ///< N [N m s]
    const void* support = nullptr; ///< the joint with what cannot move, whatever pushes it
    Vector3<double> held_at = Vector3<double>::Zero(); ///< by that, in the segment [m]
    /// Whether its kind bears a force along y and z of the segment, a moment about x, either way.
    std::array<bool, 3> bears{};
};

/// How a piece went through a step. Plain value.
struct PieceStep {
    JointFrame<double> pose{}; ///< where the rows were solved
    /// Of its centre, what gravity gave it left out; of a piece that is held less g dt.
    BodyMotion change{};
    Vector3<double> spin = Vector3<double>::Zero(); ///< ω before
    double dt = 0;                                  ///< in which it turned [s]; 0 in a blow
    double blur = 0; ///< of its change, by the engine's last digits [m/s]
};

/// Of a section that is closed. Plain value.
struct SectionForce {
    int section = 0;
    Vector3<double> point = Vector3<double>::Zero();  ///< [m]
    Vector3<double> force = Vector3<double>::Zero();  ///< on what is beyond [N s]
    Vector3<double> moment = Vector3<double>::Zero(); ///< about the section [N m s]
    double bending = 0; ///< of it about x, as a joint's row would give it [N m s]
    /// Along z [N s], about y and z [N m s]; where the member knows what it bears of these.
    double axial = 0, weak_bending = 0, torsion = 0;
};

/// Kept from step to step, so that nothing is allocated.
struct InternalForces {
    std::vector<SectionForce> sections;                         ///< from the last to the first
    Vector3<double> left_over_force = Vector3<double>::Zero();  ///< [N s]
    Vector3<double> left_over_moment = Vector3<double>::Zero(); ///< about the start [N m s]
    double largest_force = 0, largest_moment = 0; ///< of what was added up, for its scale

    /// Of the largest that were added up; 0 where the piece is held [-].
    [[nodiscard]] double left_over() const noexcept {
        const double force = norm(left_over_force), moment = norm(left_over_moment);
        return std::max(force > 0 ? force / largest_force : 0.0,
                        moment > 0 ? moment / largest_moment : 0.0);
    }
};

/// `loads` of other pieces are left out.
inline void internal_forces(const Member& member, const MemberPiece& piece, const PieceStep& step,
                            std::span<const MemberLoad> loads, InternalForces& result) {
    result.sections.clear();
    result.largest_force = result.largest_moment = 0;
    Vector3<double> force = Vector3<double>::Zero(), moment = force; // about `about`
    Vector3<double> about = placed(step.pose, piece.section(member, piece.run.last, true)).origin;
    const auto add = [&](const Vector3<double>& at, const Vector3<double>& impulse,
                         const Vector3<double>& alone, double sign) {
        const Vector3<double> arm = difference(at, about);
        const Vector3<double> turned = sum(cross(arm, impulse), alone);
        force = sum(force, scaled(sign, impulse));
        moment = sum(moment, scaled(sign, turned));
        result.largest_force = std::max(result.largest_force, norm(impulse));
        result.largest_moment =
            std::max(result.largest_moment, norm(arm) * norm(impulse) + norm(alone));
    };
    const auto move_to = [&](const Vector3<double>& point) {
        moment = sum(moment, cross(difference(about, point), force));
        about = point;
    };
    for (int k = piece.run.last; k >= piece.run.first; --k) {
        const MemberSegment& segment = member.segment(k);
        const JointFrame<double> pose = placed(step.pose, piece.segment(k));
        if (!segment.held) {
            const Vector3<double> r = difference(pose.origin, step.pose.origin);
            const Vector3<double> bent = scaled(step.dt, cross(step.spin, cross(step.spin, r)));
            const Matrix3<double> inertia = along_axes(segment.inertia, pose.axes);
            const Vector3<double> gyroscopic =
                scaled(step.dt, cross(step.spin, times(inertia, step.spin)));
            add(pose.origin, scaled(segment.mass, sum(step.change.at(r), bent)),
                sum(times(inertia, step.change.spin), gyroscopic), 1);
        }
        for (const MemberLoad& load : loads) {
            if (load.segment == k) add(load.point, load.impulse, load.moment, -1);
        }
        const JointFrame<double> start = placed(step.pose, piece.section(member, k, false));
        move_to(start.origin);
        if (k == piece.run.first) break;
        // a row's axes are those of the segment before
        const Matrix3<double> axes = placed(step.pose, piece.segment(k - 1)).axes;
        result.sections.push_back(
            {k - 1, start.origin, force, moment, dot(column(axes, 0), moment)});
        if (!member.all_axes()) continue;
        SectionForce& section = result.sections.back();
        section.axial = dot(column(axes, 2), force);
        section.weak_bending = dot(column(axes, 1), moment);
        section.torsion = dot(column(axes, 2), moment);
    }
    result.left_over_force = piece.held ? Vector3<double>::Zero() : force;
    result.left_over_moment = piece.held ? Vector3<double>::Zero() : moment;
}

} // namespace ductile
