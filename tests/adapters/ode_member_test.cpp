// SPDX-License-Identifier: MIT
//
// Members in ODE: one body until a section yields, against the same segments with a hinge between
// each and the next, and against energies that do not depend on the step.
#include "adapters/ode_member_rig.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "support/throws.hpp"

using namespace ductile;
using namespace ductile::test;
using namespace ductile::test::in_ode;
using ode::World;
using ode::WorldParameters;

TEST_CASE("just in time a struck cantilever moves as one whose sections are always open",
          "[ode][member]") {
    for (const int segments : {5, 10}) {
        for (const double dt : {1e-3, 1e-4}) {
            const Member of = strip(segments, true, segments == 5 ? Lumping::rods : Lumping::ends);
            Struck always(of, false), in_time(of, true);
            double open = 0, steps = 0;
            for (Struck* scene : {&always, &in_time}) scene->strike(4);
            for (int i = 0; i < int(0.06 / dt); ++i, ++steps) {
                always.world.step(dt);
                in_time.world.step(dt);
                open += in_time.member->open_sections();
            }
            double worst = 0;
            for (int i = 0; i < segments; ++i) {
                worst = std::max(worst, std::abs(always.bend(i) - in_time.bend(i)));
            }
            CAPTURE(segments, dt, worst, open / steps, always.absorbed_energy(),
                    in_time.absorbed_energy(), in_time.member->left_over(),
                    in_time.world.ledger().unexplained(),
                    in_time.world.ledger().booked(Account::members));
            CHECK(in_time.absorbed_energy() == Approx(always.absorbed_energy()).epsilon(2e-5));
            CHECK(worst < 1e-6);
            CHECK(open / steps < 2);
            CHECK(in_time.member->whole());
            CHECK(in_time.member->left_over() < 1e-8);
            CHECK(std::abs(in_time.world.ledger().unexplained()) < 1e-9);
            // what closing takes, and the drift of its joints
            CHECK(std::abs(in_time.world.ledger().booked(Account::members)) < 3e-5);
        }
    }
}

TEST_CASE("what a blow leaves in a post does not depend on the frame", "[ode][member]") {
    const Member of = heavy_post();
    std::vector<double> absorbed;
    for (const double frame : {1.0 / 30, 1.0 / 60, 1.0 / 240, 1.0 / 1000}) {
        BallOnPost scene(of, 100, 1);
        scene.go(2, frame);
        absorbed.push_back(scene.post->absorbed_energy());
        CAPTURE(frame, absorbed.back());
        CHECK(scene.post->whole());
        CHECK(scene.world.run().believed());
        CHECK(std::abs(scene.world.ledger().unexplained()) < 1e-9);
    }
    // what the first segment takes of the blow, x = μ s/(2 G), and what the ball keeps
    CHECK(absorbed[0] == Approx(50 / (1 + 24.0 / 20 / 100)).epsilon(0.01));
    for (const double energy : absorbed) CHECK(energy == Approx(absorbed[0]).epsilon(0.002));
}
