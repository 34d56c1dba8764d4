// SPDX-License-Identifier: MIT
#include "ductile/member/redundant_forces.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/member/strips.hpp"

using namespace ductile;
using ductile::test::beam_to_hold;

namespace {

const int first = 0, second = 0; // joints, by their addresses

/// P11's beam of 4 m and M_p = 50 kN m, loaded across by `load` [N] at 2 m; what holds it says
/// nothing of itself but what it is given.
struct Beam {
    Member member = beam_to_hold(16);
    MemberState state = straight(member);
    MemberPiece whole = make_piece(member, state, {0, member.segments() - 1});
    RedundantForces redundant;

    [[nodiscard]] std::vector<MemberLoad> loads(double load, double pull, double moment,
                                                const void* joint = &first) const {
        const int last = member.segments() - 1;
        return {{.segment = 9, .point = {0, 0, 2}, .impulse = {0, -load, 0}},
                {.segment = last,
                 .point = {0, 0, 4},
                 .impulse = {0, pull, 0},
                 .moment = {moment, 0, 0},
                 .support = joint,
                 .held_at = {0, 0, 5e-7}}};
    }
    static std::vector<MemberSupport> supports(const Beam& of,
                                               const std::vector<MemberLoad>& loads) {
        std::vector<MemberSupport> result;
        const std::vector<PieceStep> steps(1);
        list_supports(of.member, std::span(&of.whole, 1), steps, loads, 1, result);
        return result;
    }
    void learn(double pull, double moment) {
        redundant.learn(supports(*this, loads(0, pull, moment)));
        redundant.become(member, whole);
    }
    /// While it is closed nothing is known of what holds its end.
    [[nodiscard]] bool bears(double load, const void* joint = &first) {
        const auto closed = loads(load, 0, 0, joint);
        InternalForces forces;
        internal_forces(member, whole, {}, closed, forces);
        return redundant.bear(member, state, forces, supports(*this, closed), 1);
    }
};

} // namespace

TEST_CASE("what holds a clamped beam bears its loads up to where theory says", "[member]") {
    // the root alone: M_p/a; a pin: 6 M_p/L; a clamp: 8 M_p/L
    Beam beam;
    CHECK_FALSE(beam.bears(1)); // nothing is known yet
    beam.learn(1000, 0);
    for (const double share : {0.5, 0.999, 0.99999}) CHECK(beam.bears(share * 75e3));
    CHECK_FALSE(beam.bears(75.01e3));
    CHECK_FALSE(beam.bears(1.001 * 75e3));
    beam.learn(1000, 500);
    for (const double share : {0.5, 0.999, 0.99999}) CHECK(beam.bears(share * 100e3));
    CHECK_FALSE(beam.bears(100.01e3));
    // whatever was found for one load serves the next, and the other way round
    CHECK(beam.bears(99e3));
    CHECK(beam.bears(10e3));
    CHECK(beam.bears(99e3));
}

TEST_CASE("what was seen to push to one side does not pull, and another joint is not known",
          "[member]") {
    Beam beam;
    beam.learn(1000, 500);
    CHECK_FALSE(beam.bears(-90e3));
    CHECK(beam.bears(-25e3)); // the root alone
    CHECK(beam.bears(90e3));
    CHECK_FALSE(beam.bears(90e3, &second));
    CHECK_FALSE(beam.bears(90e3, nullptr));
    beam.learn(-1000, -500);
    CHECK(beam.bears(-90e3));
    CHECK(beam.bears(90e3)); // seen before
}

TEST_CASE("no shares of what holds a free beam by two pins bear more than the one in balance",
          "[member]") {
    MemberParameters p;
    p.segments = lumped_segments(4, 400, 16, {1e-5, 1e-5, 1e-3});
    p.sections.assign(15, UsualAxisJoint(Perfect<double>({.strength = 50e3})));
    const Member of(p);
    const MemberState state = straight(of);
    const MemberPiece whole = make_piece(of, state, {0, 15});
    // three pins bear more, of which the closed beam's step uses two
    for (const bool three : {false, true}) {
        const auto loads = [&](double load, double at_ends, double in_middle) {
            std::vector<MemberLoad> all{
                {.segment = 4, .point = {0, 0, -1}, .impulse = {0, -load, 0}},
                {.segment = 11, .point = {0, 0, 1}, .impulse = {0, -load, 0}},
                {.segment = 0,
                 .point = {0, 0, -2},
                 .impulse = {0, at_ends, 0},
                 .support = &first,
                 .held_at = {0, 0, -0.125}},
                {.segment = 15,
                 .point = {0, 0, 2},
                 .impulse = {0, at_ends, 0},
                 .support = &second,
                 .held_at = {0, 0, 0.125}}};
            if (three) {
                all.push_back({.segment = 8,
                               .point = {0, 0, 0},
                               .impulse = {0, in_middle, 0},
                               .support = &of,
                               .held_at = {0, 0, -0.125}});
            }
            return all;
        };
        const std::vector<PieceStep> steps(1);
        std::vector<MemberSupport> supports;
        RedundantForces redundant;
        list_supports(of, std::span(&whole, 1), steps, loads(0, 100, 100), 1, supports);
        redundant.learn(supports);
        redundant.become(of, whole);
        const auto bears = [&](double load) {
            InternalForces forces;
            const auto all = loads(load, load, 0);
            internal_forces(of, whole, {}, all, forces);
            REQUIRE(forces.left_over() < 1e-12);
            list_supports(of, std::span(&whole, 1), steps, all, 1, supports);
            return redundant.bear(of, state, forces, supports, 1);
        };
        // one span 4 m, two loads at quarters: M_p/1 m; two spans of 2 m: 6 M_p/2 m
        const double limit = three ? 150e3 : 50e3;
        CAPTURE(three);
        CHECK(bears(0.999 * limit));
        CHECK_FALSE(bears(1.001 * limit));
    }
}

TEST_CASE("a beam on two pins carries a blow as it is in balance, however stiff it is",
          "[member]") {
    MemberParameters p;
    p.segments = lumped_segments(2, 24, 32, {1e-4, 1e-4, 2e-4});
    p.sections.assign(31, UsualAxisJoint(Perfect<double>({.strength = 500})));
    p.bending_stiffness = 1e5;
    const Member bar(p);
    const MemberPiece whole = make_piece(bar, straight(bar), {0, 31});
    // its frame is in its middle
    const auto load = [](int segment, double z, double across, const void* pin) {
        return MemberLoad{.segment = segment,
                          .point = {0, 0, z},
                          .impulse = {0, across, 0},
                          .support = pin,
                          .held_at = {0, 0, z > 0 ? 1.0 / 32 : -1.0 / 32},
                          .bears = {pin != nullptr, pin == &first, false}};
    };
    const std::vector<MemberLoad> loads{load(15, 0, 2, nullptr), load(0, -1, -1, &first),
                                        load(31, 1, -1, &second)};
    std::vector<MemberSupport> supports;
    list_supports(bar, std::span(&whole, 1), std::vector<PieceStep>(1), loads, 1, supports);
    RedundantForces redundant;
    redundant.learn(supports);
    redundant.become(bar, whole);
    InternalForces forces;
    internal_forces(bar, whole, {}, loads, forces);
    const InternalForces before = forces;
    REQUIRE(std::abs(before.sections[15].bending) == Approx(1));
    redundant.relax(bar, forces);
    for (std::size_t i = 0; i < 31; ++i) {
        CAPTURE(i);
        CHECK(forces.sections[i].bending == Approx(before.sections[i].bending).epsilon(1e-9));
    }
}
