// SPDX-License-Identifier: MIT
//
// What hangs on a whole member by a joint of the engine's and is given a velocity by hand: a blow,
// as one of contacts, whatever the frame. Compiled for every engine and precision, as
// members_test.cpp.
#include RIG_HEADER

#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <memory>
#include <vector>

using namespace ductile;
using namespace ductile::test;
using namespace RIG;

namespace {

void go(Struck& scene, double time, double frame) {
    for (int i = 0; i < int(std::lround(time / frame)); ++i) scene.world.step(frame);
}

/// Of the energy of 1 kg at a speed [m/s], once it has taken along half of the last segment [J].
double left_by_blow(const Member& of, double speed) {
    return speed * speed / 2 / (1 + of.segment(of.segments() - 1).mass / 2);
}

/// P13, elastic [N m²].
Member elastic_strip(double bending_stiffness) {
    MemberParameters p;
    p.segments = lumped_segments(1, 2, most_segments, {1e-6, 1e-6, 2e-6});
    p.segments.insert(p.segments.begin(), {.length = 0, .mass = 0, .held = true});
    p.sections.assign(std::size_t(most_segments),
                      UsualAxisJoint(Perfect<double>({.strength = 100})));
    p.bending_stiffness = bending_stiffness;
    return Member(p);
}

} // namespace

TEST_CASE("what hangs on a member, or on a chain of joints, and is thrown by hand yields it",
          "[member]") {
    const Member of = strip(most_segments);
    for (const double speed : {1.0, 2.5, 8.0}) { // mean force of a frame of 1/30 s: 30, 75, 240 N
        for (const double frame : {1.0 / 30, 1.0 / 60, 1.0 / 240}) {
            for (const bool just_in_time : {false, true}) {
                Struck thrown(of, just_in_time, 0.01);
                thrown.strike(speed);
                go(thrown, 0.2, frame);
                CAPTURE(speed, frame, just_in_time);
                CHECK(thrown.world.run().believed());
                CHECK(thrown.absorbed_energy() == Approx(left_by_blow(of, speed)).epsilon(0.01));
            }
        }
    }
}

TEST_CASE("what is thrown by hand a second time goes on where the first one left it", "[member]") {
    const Member of = strip(most_segments);
    for (const double frame : {1.0 / 30, 1.0 / 240}) {
        Struck thrown(of, true, 0.01);
        for (const double speed : {2.5, -2.5, 1.0}) {
            thrown.strike(speed);
            go(thrown, 0.2, frame);
        }
        CAPTURE(frame);
        CHECK(thrown.world.run().believed());
        CHECK(thrown.absorbed_energy() ==
              Approx(2 * left_by_blow(of, 2.5) + left_by_blow(of, 1)).epsilon(0.01));
    }
}

TEST_CASE("what strikes a body that hangs on a whole member strikes the member too", "[member]") {
    // 100 kg and 50 kg go on together, and take along half of the last segment
    constexpr double speed = 2, both = 150, together = 100 * speed / both;
    const Member of = heavy_post(10, 5000);
    const double tip = of.segment(of.segments() - 1).mass / 2;
    for (const double frame : {1.0 / 30, 1.0 / 60, 1.0 / 240}) {
        BallOnHung scene(of);
        scene.strike(scene.ball, speed);
        scene.go(0.3, frame);
        CAPTURE(frame);
        CHECK(scene.world.run().believed());
        CHECK(scene.post->absorbed_energy() ==
              Approx(both * together * together / 2 / (1 + tip / both)).epsilon(0.01));
    }
}

TEST_CASE("what hangs on a member and lies within it strikes no piece of it", "[member]") {
    constexpr double speed = 2, mass = 50;
    const Member of = heavy_post(10, 5000);
    const double tip = of.segment(of.segments() - 1).mass / 2;
    for (const double frame : {1.0 / 30, 1.0 / 240}) {
        BallOnHung scene(of, true);
        scene.strike(scene.hung, speed);
        scene.go(0.3, frame);
        CAPTURE(frame);
        CHECK(scene.world.run().believed());
        CHECK(scene.world.ledger().booked(Account::contact) == 0);
        CHECK(scene.post->absorbed_energy() ==
              Approx(mass * speed * speed / 2 / (1 + tip / mass)).epsilon(0.01));
    }
}

TEST_CASE("what hands let go of a member does not pull at it any more", "[member]") {
    const Member of = heavy_post(10, 5000);
    for (const double frame : {1.0 / 30, 1.0 / 240}) {
        BallOnHung scene(of);
        scene.strike(scene.hung, 2);
        scene.world.step(frame);
        CAPTURE(frame);
        CHECK_FALSE(scene.post->whole()); // by and by it is, of other bodies
        scene.let_go();
        scene.go(0.3, frame);
        CHECK(scene.post->whole());
        const double absorbed = scene.post->absorbed_energy();
        scene.strike(scene.hung, 2);
        scene.go(0.1, frame);
        CHECK(scene.post->absorbed_energy() == Approx(absorbed).epsilon(1e-6));
    }
}

TEST_CASE(
    "what a joint of the engine's brings in that hands switch on across a gap is not believed",
    "[member]") {
    for (const double frame : {1.0 / 30, 1.0 / 240}) {
        BallOnHung scene(heavy_post(10, 5000));
        scene.let_go();
        scene.strike(scene.hung, 2);
        scene.go(0.1, frame); // 0.2 m
        scene.strike(scene.hung, 0);
        scene.world.step(frame);
        CAPTURE(frame);
        CHECK(scene.world.run().brought_in < 1e-9);
        CHECK(scene.world.run().believed());
        scene.let_go(false);
        scene.go(0.3, frame);
        CHECK(scene.world.run().brought_in > 30); // 1.2 m/s in a frame of 1/30 s: 36 J
        CHECK_FALSE(scene.world.run().believed());
    }
}

TEST_CASE("what a joint brought in does not hang on where its successors lie", "[member]") {
    constexpr double frame = 1.0 / 240;
    const auto brought_in = [](std::size_t taken) {
        std::vector<std::unique_ptr<char[]>> room; // of the heap, in pieces of all sizes
        for (std::size_t i = 0; i < taken; ++i) {
            room.push_back(std::make_unique<char[]>(16 + 16 * (i % 64)));
        }
        for (std::size_t i = 0; i < taken; i += 3) room[i].reset();
        BallOnHung scene(heavy_post(10, 5000));
        scene.let_go();
        scene.strike(scene.hung, 2);
        scene.go(0.1, frame);
        scene.strike(scene.hung, 0);
        scene.let_go(false);
        scene.go(0.3, frame);
        return scene.world.run().brought_in;
    };
    const double usual = brought_in(0);
    for (const std::size_t taken : {100u, 1000u, 5000u, 20000u}) {
        CAPTURE(taken);
        CHECK(brought_in(taken) == usual);
    }
}

TEST_CASE("a clamped member that hands set in motion is refused", "[member]") {
    BallOnHung scene(heavy_post());
    scene.strike(scene.post->pieces().front(), 3);
    CHECK_THROWS_WITH(scene.world.step(1.0 / 60),
                      "Member.body: must not move where the member is clamped");
}

TEST_CASE("what an elastic member bears of a throw by hand leaves it whole, whatever the frame",
          "[member]") {
    // E = 0.125 J of the U_y = M_p² l/(6 EI) = 1 J; its wave carries 29 N m, its profile 35 N m
    const Member of = elastic_strip(100 * 100 / 6.0);
    for (const double frame : {1.0 / 30, 1.0 / 60, 1.0 / 240, 1.0 / 1000}) {
        Struck thrown(of, true, 0.01);
        thrown.strike(0.5);
        go(thrown, 0.2, frame);
        CAPTURE(frame);
        CHECK(thrown.member->whole());
        CHECK(thrown.absorbed_energy() == 0);
        CHECK(thrown.world.run().believed());
    }
}
