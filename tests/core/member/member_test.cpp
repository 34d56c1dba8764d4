// SPDX-License-Identifier: MIT
#include "ductile/member/member.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <limits>

#include "core/member/strips.hpp"
#include "ductile/material/named.hpp"
#include "ductile/member/member_course.hpp"
#include "ductile/section/rectangle.hpp"
#include "support/throws.hpp"

using namespace ductile;
using ductile::test::message_of;
using ductile::test::of_whole;
using ductile::test::strip;

namespace {

const Vector3<double> none = Vector3<double>::Zero();

} // namespace

TEST_CASE("a cantilever at rest carries its weight and a load at its end", "[member]") {
    const Member member = strip(16);
    const double g = 9.81, dt = 1e-3, load = 30;
    const auto forces =
        of_whole(member, {{0, g * dt, 0}, none},
                 {{.segment = 16, .point = {0, 0, 1}, .impulse = {0, -load * dt, 0}}});
    REQUIRE(forces.sections.size() == 16);
    for (const SectionForce& carried : forces.sections) {
        const double beyond = 1 - member.place(carried.section);
        CHECK(carried.bending / dt ==
              Approx(-(g * 2 * beyond * beyond / 2 + load * beyond)).epsilon(1e-12));
        CHECK(carried.force[1] / dt == Approx(load + g * 2 * beyond).epsilon(1e-12));
    }
}

TEST_CASE("a bar at rest on two supports carries q s (L - s)/2, and both ends agree", "[member]") {
    const Member member = strip(16, false);
    const double g = 9.81, dt = 1e-3, reaction = g * dt;
    std::vector<MemberLoad> supports{
        {.segment = 0, .point = {0, 0, 0}, .impulse = {0, reaction, 0}},
        {.segment = 15, .point = {0, 0, 1}, .impulse = {0, reaction, 0}}};
    const auto forces = of_whole(member, {{0, g * dt, 0}, none}, supports);
    REQUIRE(forces.sections.size() == 15);
    for (const SectionForce& carried : forces.sections) {
        const double s = member.place(carried.section);
        CHECK(std::abs(carried.bending) / dt == Approx(g * 2 * s * (1 - s) / 2).epsilon(1e-12));
    }
    CHECK(forces.left_over() < 1e-12);
    supports.pop_back();
    CHECK(of_whole(member, {{0, g * dt, 0}, none}, supports).left_over() > 0.1);
}

TEST_CASE("a spinning bar is stretched by what it holds on its circle", "[member]") {
    const Member member = strip(32, false);
    const MemberPiece piece = make_piece(member, straight(member), {0, 31});
    InternalForces forces;
    internal_forces(member, piece, {.spin = {5, 0, 0}, .dt = 1e-3}, {}, forces);
    CHECK(forces.left_over() < 1e-12);
    // ∫ μ ω² r dr from the middle
    const SectionForce& middle = forces.sections[15];
    CHECK(-middle.force[2] / 1e-3 == Approx(2 * 25 * 0.25 / 2).epsilon(1e-12));
    CHECK(std::abs(middle.bending) < 1e-15);
}

TEST_CASE("bodies that are split and made one keep momentum and moment of momentum", "[member]") {
    const Member member = strip(7, false);
    MemberState state = straight(member);
    state[1].bend = 0.4;
    state[4].bend = -1.1;
    const MemberPiece whole = make_piece(member, state, {0, 6});
    const Matrix3<double> axes = turned_by<double>({0.3, -0.8, 1.2}, Matrix3<double>::Identity());
    const PlacedPiece before{&whole, {{3, -2, 1}, axes}, {{1, 2, 3}, {-4, 5, 6}}};
    const auto momenta = [](std::span<const PlacedPiece> pieces) {
        Vector6<double> all = Vector6<double>::Zero();
        for (const PlacedPiece& p : pieces) {
            const Vector3<double> linear = scaled(p.piece->mass, p.motion.velocity);
            all +=
                twist_of(linear, sum(cross(p.pose.origin, linear),
                                     times(p.piece->inertia_in_world(p.pose.axes), p.motion.spin)));
        }
        return all;
    };
    const Vector6<double> all = momenta(std::array{before});
    std::array<MemberPiece, 3> pieces{make_piece(member, state, {0, 1}),
                                      make_piece(member, state, {2, 2}),
                                      make_piece(member, state, {3, 6})};
    std::array<PlacedPiece, 3> parts;
    for (std::size_t i = 0; i < 3; ++i) parts[i] = split_off(before, pieces[i]);
    CHECK((momenta(parts) - all).norm() < 1e-12 * all.norm());
    // its segments have not moved
    const auto at = [](const PlacedPiece& p, int k) { return placed(p.pose, p.piece->segment(k)); };
    CHECK((at(parts[2], 5).origin - at(before, 5).origin).norm() < 1e-14);
    CHECK((at(parts[2], 5).axes - at(before, 5).axes).norm() < 1e-14);
    parts[0].motion.spin[0] += 3; // they move against each other
    const Vector6<double> moved = momenta(parts);
    const PlacedPiece after = fused(parts, whole);
    CHECK((momenta(std::array{after}) - moved).norm() < 1e-12 * moved.norm());
    CHECK((after.pose.origin - before.pose.origin).norm() < 1e-14);
}

TEST_CASE("a bent piece has the inertia of its segments about its own axes", "[member]") {
    const Member member = strip(2, false);
    MemberState state = straight(member);
    state[0].bend = M_PI / 2;
    const MemberPiece piece = make_piece(member, state, {0, 1});
    // two bars of 1 kg, at right angles: each middle √2/8 m from the centre
    const double i = member.segment(0).inertia[0];
    CHECK(piece.inertia[0] == Approx(2 * i + 2.0 / 32));
    CHECK(piece.inertia[1] + piece.inertia[2] ==
          Approx(2 * (member.segment(0).inertia[1] + member.segment(0).inertia[2]) + 2.0 / 32));
    CHECK(piece.mass == 2);
}

TEST_CASE("a piece is straight from bend to bend", "[member]") {
    const Member member = strip(8);
    MemberState state = straight(member);
    state[0].bend = 0.1; // of the root: nothing is before it
    state[4].bend = 0.2;
    state[6].bend = 1e-7;
    const MemberPiece piece = make_piece(member, state, {0, 8});
    const auto stretches = straight_stretches(member, piece);
    REQUIRE(stretches.size() == 2);
    CHECK(stretches[0].run == MemberRun{1, 4});
    CHECK(stretches[1].run == MemberRun{5, 8});
    for (const StraightStretch& stretch : stretches) {
        CHECK(stretch.length == Approx(0.5));
        const Vector3<double> half = scaled(0.25, column(stretch.middle.axes, 2));
        const auto end_of = [&](int k, bool end) { return piece.section(member, k, end).origin; };
        CHECK(norm(difference(sum(stretch.middle.origin, half), end_of(stretch.run.last, true))) <
              1e-6);
        CHECK(norm(difference(difference(stretch.middle.origin, half),
                              end_of(stretch.run.first, false))) < 1e-12);
    }
}

TEST_CASE("a beam is finer towards an end that is struck, and as heavy and long", "[member]") {
    const Rectangle<double> section({.width = 0.064, .height = 0.004});
    const Material<double> steel(s355<double>());
    const Member equal = beam(section, steel, {.length = 2, .segments = 8, .clamped = true});
    const Member finer =
        beam(section, steel, {.length = 2, .segments = 8, .halvings = 3, .clamped = true});
    REQUIRE(finer.segments() == equal.segments() + 3);
    CHECK(finer.segment(7).length == Approx(0.25));
    const double halves[] = {0.125, 0.0625, 0.03125, 0.03125};
    for (int i = 0; i < 4; ++i) CHECK(finer.segment(8 + i).length == Approx(halves[i]));
    CHECK(finer.length() == Approx(2).epsilon(1e-15));
    CHECK(finer.mass() == Approx(equal.mass()).epsilon(1e-14));
    CHECK(message_of([&] { (void)beam(section, steel, {.length = 2, .halvings = -1}); }) ==
          "Beam.halvings = -1: must be in [0, 10]");
    CHECK(message_of([&] { (void)beam(section, steel, {.length = 2, .halvings = 60}); }) ==
          "Beam.halvings = 60: must be in [0, 10]");
    const Rectangle<double> millimetres({.width = 64, .height = 4});
    CHECK(message_of([&] { (void)beam(millimetres, steel, {.length = 2}); }) ==
          "Beam.length = 2 m: must be more than its section's radius of gyration, 18.5 m");
    CHECK(message_of([&] { (void)beam(millimetres, steel, {.length = 5000}); }) ==
          "Beam.length = 5000 m: must be in (0, 1000] m: lengths are metres");
    CHECK(
        message_of([&] { (void)beam(millimetres, steel, {.length = 500}); }) ==
        "Beam.mass_per_length = 2009600 kg/m: must be in (0, 200000] kg/m: a section's dimensions "
        "are metres");
}

TEST_CASE("in a blow the section nearest to it opens, in a step the worst", "[member]") {
    const Member member = strip(4);
    const auto at_end = [](double impulse) {
        return std::vector<MemberLoad>{
            {.segment = 4, .point = {0, 0, 1}, .impulse = {0, impulse, 0}}};
    };
    const auto worst = [&](double impulse) {
        return worst_section(member, straight(member), of_whole(member, {}, at_end(impulse)), 1);
    };
    CHECK(worst(200) == 0);
    // a moment that is just what it can carry is no violation
    CHECK(worst(100) == no_section);

    MemberCourse course(member);
    const MemberStrike strike{.energy = 3e4, .speed = 300, .segment = 4}; // 200 N s stopped
    std::vector<PieceStep> steps(1);
    course.begin_blow();
    CHECK(course.struck(steps, at_end(200), strike) == 3);
    const std::vector<int> opened{3};
    const std::vector<PlacedPiece> whole{{&course.pieces().front(), {}, {}}};
    const auto pieces = course.open(opened, whole);
    REQUIRE(pieces.size() == 2);
    CHECK(course.piece_of(3) == 0);
    CHECK(course.piece_of(4) == 1);
    CHECK(pieces[1].pose.origin[2] == Approx(0.875));
    // what segments that are not quite lumped leave over opens none
    steps.resize(2);
    const std::vector<MemberLoad> rest{{.segment = 3, .point = {0, 0, 0.75}, .impulse = {0, 1, 0}}};
    CHECK(course.struck(steps, rest, strike) == no_section);
    // one that holds closes after three steps
    CHECK(course.held(Closing::after_step).empty());
    CHECK(course.held(Closing::after_step).empty());
    CHECK(course.held(Closing::after_step) == opened);
    CHECK(course.close(opened, pieces).size() == 1);
    CHECK(course.whole());
}

TEST_CASE("what a section takes of a blow is half its moment times the turn it gives", "[member]") {
    // a body that is held turns the other about their section, two alike turn about their centres
    for (const bool clamped : {true, false}) {
        MemberParameters p;
        p.segments = lumped_segments(2, 6, 2, {1e-3, 1e-3, 2e-3});
        if (clamped) p.segments[0] = {.length = 0, .mass = 0, .held = true};
        p.sections.assign(1, UsualAxisJoint(Perfect<double>({.strength = 100})));
        const Member of(p);
        const MemberPiece whole = make_piece(of, straight(of), {0, 1});
        const double inertia = of.segment(1).inertia[0];
        const double turn = clamped ? 1 / (inertia + 3 * 0.25) : 2 / inertia;
        CHECK(opening_energy(of, whole, {.section = 0, .bending = -4}) == Approx(8 * turn));
    }
}

TEST_CASE("before a blow sections that do not move close, whenever they were opened", "[member]") {
    MemberCourse course(strip(4));
    std::vector<PlacedPiece> pieces{{&course.pieces().front(), {}, {}}};
    const std::vector<int> opened{1, 2, 3};
    pieces = course.open(opened, pieces);
    course.section(1).joint.flowing = course.section(3).joint.flowing = true;
    course.section(1).joint.velocity = 1e-6;
    course.section(2).joint.broken = true;
    CHECK(course.held(Closing::before_blow) ==
          std::vector<int>{3}); // at its bound, as many shares of loads are
}

TEST_CASE("what a member cannot be is said", "[member]") {
    const auto message = [](const auto& change) {
        MemberParameters p;
        p.segments = lumped_segments(1, 2, 3, {1e-6, 1e-6, 2e-6});
        p.sections.assign(2, UsualAxisJoint(Perfect<double>({.strength = 1})));
        change(p);
        return message_of([&] { Member member(p); });
    };
    CHECK(message([](auto& p) { p.segments.clear(); }) == "Member.segments = 0: must be 2 or more");
    CHECK(message([](auto& p) { p.sections.pop_back(); }) ==
          "Member.sections = 1: must be 2, one less than segments");
    CHECK(message([](auto& p) { p.segments[1].mass = -1; }) ==
          "Member.segments[1].mass = -1 kg: must be finite and > 0");
    CHECK(message([](auto& p) { p.segments[2].held = true; }) ==
          "Member.segments[2].held = 1: must be 0: only the first may be held");
    CHECK(message([](auto& p) {
              p.sections[1] =
                  UsualAxisJoint(Perfect<double>({.strength = 1}), {}, {.stiffness = 5});
          }) ==
          "Member.sections[1].stiffness = 5 N m/rad: must be infinite: a section that closes "
          "would lose what it stores");
    CHECK(message([](auto& p) { p.bending_stiffness = 0; }) ==
          "Member.bending_stiffness = 0 N m^2: must be > 0 (infinity: no limit)");
}
