// SPDX-License-Identifier: MIT
//
// A member that opens its sections just in time against the one that has them always open, and
// against Parkes.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "core/member/chain_world.hpp"
#include "core/member/strips.hpp"
#include "ductile/fidelity/struck_cantilever.hpp"

using namespace ductile;
using ductile::test::ChainWorld;
using ductile::test::Lumping;
using ductile::test::strip;
using Sections = ductile::test::ChainWorld::Sections;

namespace {

struct Pair {
    Pair(const Member& member, const ductile::test::Striker& striker)
        : always(member, Sections::always_open, striker),
          in_time(member, Sections::just_in_time, striker),
          sections(member.sections()) {}

    void go(double time, double dt) {
        const int count = int(std::lround(time / dt));
        for (int i = 0; i < count; ++i) {
            always.step(dt);
            in_time.step(dt);
            open += in_time.open();
        }
        steps += count;
    }
    [[nodiscard]] double worst_bend() const {
        double worst = 0;
        for (int i = 0; i < sections; ++i) {
            worst = std::max(worst, std::abs(always.bend(i) - in_time.bend(i)));
        }
        return worst;
    }
    [[nodiscard]] double mean_open() const { return open / steps; }

    ChainWorld always, in_time;
    int sections;
    double open = 0, steps = 0;
};

} // namespace

TEST_CASE("just in time a struck cantilever moves as one whose sections are always open",
          "[member]") {
    for (const int segments : {5, 20}) {
        for (const double dt : {1e-3, 1e-4, 1e-5}) {
            const Lumping lumping = segments == 5 ? Lumping::rods : Lumping::ends;
            const Member member = strip(segments, true, lumping);
            Pair pair(member, {1, {0, 4, 0}, segments});
            pair.go(0.06, dt);
            CAPTURE(segments, dt, pair.always.plastic_work(), pair.in_time.plastic_work());
            CHECK(pair.in_time.plastic_work() == Approx(pair.always.plastic_work()).epsilon(1e-5));
            CHECK(pair.worst_bend() < 1e-6);
            CHECK(pair.mean_open() < 2);
            CHECK(pair.in_time.open() == 0);
            CHECK(pair.in_time.left_over() < 1e-9);
            CHECK(pair.in_time.solved());
        }
    }
}

TEST_CASE("a second and a third hit go on where the first one left it", "[member]") {
    const Member member = strip(10);
    Pair pair(member, {1, {0, 4, 0}, 10});
    for (const double speed : {4.0, -4.0, 4.0}) {
        pair.always.strike({0, speed, 0});
        pair.in_time.strike({0, speed, 0});
        pair.go(0.06, 1e-4);
        CHECK(pair.in_time.open() == 0);
    }
    CHECK(pair.in_time.plastic_work() == Approx(pair.always.plastic_work()).epsilon(1e-5));
    CHECK(pair.worst_bend() < 1e-6);
}

TEST_CASE("a free bar struck in its middle keeps its momentum through all openings and closings",
          "[member]") {
    const Member member = strip(10, false);
    Pair pair(member, {1, {0.3, 12, 0}, 4});
    const Vector6<double> before = pair.in_time.momentum();
    pair.go(0.1, 1e-4);
    CHECK(pair.in_time.changes() > 4);
    CHECK(pair.in_time.plastic_work() > 1);
    CHECK(pair.in_time.plastic_work() == Approx(pair.always.plastic_work()).epsilon(1e-5));
    CHECK(pair.in_time.kinetic_energy() == Approx(pair.always.kinetic_energy()).epsilon(1e-6));
    CHECK(pair.worst_bend() < 1e-5);
    CHECK((linear(pair.in_time.momentum()) - linear(before)).norm() < 1e-12 * 12);
    // the integrator's own drift is as large where nothing is opened
    const double drift = (angular(pair.always.momentum()) - angular(before)).norm();
    CHECK((angular(pair.in_time.momentum()) - angular(before)).norm() < 2 * drift);
    CHECK(pair.in_time.left_over() < 1e-9);
}

TEST_CASE("with 32 segments it takes the shape that Parkes gives", "[member]") {
    const StruckCantilever<double> exact{
        .length = 1, .mass_per_length = 2, .plastic_moment = 100, .tip_mass = 1, .speed = 4};
    const Member member = strip(32);
    ChainWorld world(member, Sections::just_in_time, {1, {0, 4, 0}, 32});
    for (int i = 0; i < 5000; ++i) world.step(1e-5);
    CHECK(world.open() == 0);
    CHECK(world.end_of(32)[1] == Approx(continuum_deflection(exact)).epsilon(0.005));
    CHECK(world.bend(0) == Approx(-1.0 / 30).epsilon(0.01).scale(0)); // the root's of P13a
}

TEST_CASE("a cantilever bears 0.99 of its collapse load whole and falls at 1.001", "[member]") {
    const Member member = strip(8);
    const double own = 2 * 9.81 * 0.5, dt = 1e-3; // its weight's moment about the root
    for (const double share : {0.99, 1.001}) {
        ChainWorld world(member, Sections::just_in_time, {}, {0, -9.81, 0});
        world.push({0, -(share * 100 - own) * dt, 0});
        for (int i = 0; i < 10000 && std::abs(world.bend(0)) < 0.3; ++i) world.step(dt);
        if (share < 1) {
            CHECK(world.plastic_work() == 0);
            CHECK(world.open() == 0);
            CHECK(world.changes() == 0);
        } else {
            CHECK(world.plastic_work() > 5); // until it hangs low enough
        }
    }
}
