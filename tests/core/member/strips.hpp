// SPDX-License-Identifier: MIT
//
// Members that the tests strike: Parkes' cantilevers and free bars.
#pragma once

#include <vector>

#include "ductile/material/named.hpp"
#include "ductile/member/internal_forces.hpp"
#include "ductile/section/box.hpp"

namespace ductile::test {

enum class Lumping {
    ends, ///< half of a segment's mass at either end
    rods
};

/// P13: 1 m, 2 kg/m, M_p = 100 N m.
inline Member strip(int segments, bool clamped = true, Lumping lumping = Lumping::ends,
                    double strength = 100) {
    MemberParameters p;
    p.segments = lumped_segments(1.0, 2.0, segments, {1e-6, 1e-6, 2e-6});
    if (lumping == Lumping::rods) {
        for (MemberSegment& segment : p.segments) {
            const double rod = segment.mass * segment.length * segment.length / 12;
            segment.inertia = {rod, rod, 1e-5};
        }
    }
    if (clamped) {
        p.segments.insert(p.segments.begin(), {.length = 0, .mass = 0, .held = true});
    }
    p.sections.assign(p.segments.size() - 1,
                      UsualAxisJoint(Perfect<double>({.strength = strength})));
    return Member(p);
}

/// P39's post, clamped: 2 m, a box of S355, 100 x 100 x 4 mm.
constexpr double post_length = 2, post_mass = 24.1152, post_strength = 19641.44,
                 post_stiffness = 496312.32;
inline Member elastic_post(int segments, bool clamped = true) {
    MemberParameters p;
    p.segments = lumped_segments(post_length, post_mass, segments, {1.54e-3, 1.54e-3, 3.08e-3});
    if (clamped) p.segments.insert(p.segments.begin(), {.length = 0, .mass = 0, .held = true});
    p.sections.assign(p.segments.size() - 1,
                      UsualAxisJoint(Perfect<double>({.strength = post_strength})));
    p.bending_stiffness = post_stiffness;
    return Member(p);
}

/// The same by its section, which says what it bears in all axes.
inline Member steel_post(bool clamped, bool fixed_end) {
    return beam(
        Box<double>(
            {.width = 0.1, .height = 0.1, .web_thickness = 0.004, .flange_thickness = 0.004}),
        Material<double>(s355<double>()),
        {.length = post_length, .segments = 32, .clamped = clamped, .fixed_end = fixed_end});
}

/// Of a cantilever, or a free bar, as one body: what its sections carry.
inline InternalForces of_whole(const Member& member, const BodyMotion& change,
                               const std::vector<MemberLoad>& loads) {
    const MemberPiece piece = make_piece(member, straight(member), {0, member.segments() - 1});
    const JointFrame<double> start = piece.section(member, 0, false);
    InternalForces forces;
    internal_forces(member, piece, {.pose = frame_around({}, start), .change = change}, loads,
                    forces);
    return forces;
}

/// 2 m, 24 kg, clamped.
inline Member heavy_post(int segments = 10, double strength = 500) {
    MemberParameters p;
    p.segments = lumped_segments(2, 24, segments, {1e-4, 1e-4, 2e-4});
    p.segments.insert(p.segments.begin(), {.length = 0, .mass = 0, .held = true});
    p.sections.assign(p.segments.size() - 1,
                      UsualAxisJoint(Perfect<double>({.strength = strength})));
    return Member(p);
}

/// The same, not clamped.
inline Member free_bar(double bending_stiffness = std::numeric_limits<double>::infinity()) {
    MemberParameters p;
    p.segments = lumped_segments(2, 24, 10, {1e-4, 1e-4, 2e-4});
    p.sections.assign(9, UsualAxisJoint(Perfect<double>({.strength = 500})));
    p.bending_stiffness = bending_stiffness;
    return Member(p);
}

/// 2 m, 24 kg in ten segments of some width, clamped.
inline Member cantilever(double strength) {
    MemberParameters p;
    p.segments = lumped_segments(2, 24, 10, {1e-2, 1e-2, 2e-2});
    p.segments.insert(p.segments.begin(), {.length = 0, .mass = 0, .held = true});
    p.sections.assign(10, UsualAxisJoint(Perfect<double>({.strength = strength})));
    return Member(p);
}

/// P11: 4 m, 400 kg, M_p = 50 kN m, clamped, a stub at its end that cannot turn where it is held.
inline Member beam_to_hold(int segments) {
    MemberParameters p;
    p.segments = lumped_segments(4, 400, segments, {1e-5, 1e-5, 1e-3});
    p.segments.insert(p.segments.begin(), {.length = 0, .mass = 0, .held = true});
    p.segments.push_back({.length = 1e-6, .mass = 1, .inertia = {1, 1, 1}});
    p.sections.assign(p.segments.size() - 1, UsualAxisJoint(Perfect<double>({.strength = 50e3})));
    return Member(p);
}

/// 4 m, 0.4 kg, M_p = 5 kN m, EI = 1 MN m², else as beam_to_hold: a wave is next to nothing.
inline Member elastic_beam_to_hold() {
    MemberParameters p;
    p.segments = lumped_segments(4, 0.4, 16, {1e-4, 1e-4, 1e-3});
    p.segments.insert(p.segments.begin(), {.length = 0, .mass = 0, .held = true});
    p.segments.push_back({.length = 1e-6, .mass = 1, .inertia = {1, 1, 1}});
    p.sections.assign(p.segments.size() - 1, UsualAxisJoint(Perfect<double>({.strength = 5e3})));
    p.bending_stiffness = 1e6;
    return Member(p);
}

/// 2 m, 24 kg in ten segments; its fifth section breaks at 0.05 rad, all others are strong.
inline Member post_that_breaks() {
    MemberParameters p;
    p.segments = lumped_segments(2, 24, 10, {1e-2, 1e-2, 2e-2});
    p.segments.insert(p.segments.begin(), {.length = 0, .mass = 0, .held = true});
    p.sections.assign(10, UsualAxisJoint(Perfect<double>({.strength = 5e4})));
    p.sections[4] =
        UsualAxisJoint(Perfect<double>({.strength = 500}), TravelLimit<double>({.limit = 0.05}));
    return Member(p);
}

} // namespace ductile::test
