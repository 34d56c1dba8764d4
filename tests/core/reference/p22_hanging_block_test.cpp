// SPDX-License-Identifier: MIT
//
// P22. The seed's block of 6000 kg on a yielding bar of 80 kN, g = 10, dt = 1/60. In its table the
// bar acts from step 2 on; velocities are downwards positive here.
//
// Source: Nikula (2017), Handling of plasticity in physics engine, table of the hanging block.
#include <catch2/catch.hpp>

#include "reference/problems/rotors.hpp"

using namespace ductile;
using namespace ductile::reference;

namespace {

constexpr double dt = 1.0 / 60;

} // namespace

TEST_CASE("P22 the hanging block follows the seed's table", "[reference][P22]") {
    // step 1 is free fall: 1/6 m/s, 1/360 m
    World<double> world;
    PerfectJoint<double> bar = perfect_joint(80e3);
    const int block = world.add_degree(6000);
    const std::size_t row = world.add_row({{block}}, bar);
    world.velocity()[block] = 1.0 / 6;
    const Vector<double> weight = Vector<double>::Constant(1, 60e3);
    const double fall[] = {1.0 / 216, 1.0 / 180, 1.0 / 180, 1.0 / 180};
    const double speed[] = {1.0 / 9, 1.0 / 18, 0, 0};
    const double impulse[] = {4000.0 / 3, 4000.0 / 3, 4000.0 / 3, 1000};
    for (int i = 0; i < 4; ++i) {
        INFO("step " << i + 2);
        world.step(dt, weight);
        CHECK(1.0 / 360 + world.displacement()[block] == Approx(fall[i]).epsilon(1e-9));
        CHECK(world.velocity()[block] == Approx(speed[i]).margin(1e-12));
        CHECK(-world.reaction(row).force * dt == Approx(impulse[i]).epsilon(1e-9));
    }
    CHECK(bar.state().plastic_offset == Approx(1.0 / 360).epsilon(1e-9));
    // the continuous problem from 1/6 m/s: v²/(2a) = 1/240 m
    CHECK(bar.state().plastic_travel == Approx(1.0 / 240).epsilon(1e-9));
    // kinetic energy and the weight's work went into the bar, to the last bit or two
    const double supplied = 6000.0 / 2 / 36 + world.supplied();
    CHECK(bar.state().plastic_work + bar.state().other_work == Approx(supplied).epsilon(1e-12));
}

TEST_CASE("P22 held from the first step on, the block never moves", "[reference][P22]") {
    World<double> world;
    PerfectJoint<double> bar = perfect_joint(80e3);
    const int block = world.add_degree(6000);
    const std::size_t row = world.add_row({{block}}, bar);
    for (int i = 0; i < 100; ++i) {
        world.step(dt, Vector<double>::Constant(1, 60e3));
        CHECK(-world.reaction(row).force * dt == Approx(1000).epsilon(1e-9));
    }
    CHECK(world.displacement()[block] == 0);
    CHECK(bar.state().plastic_travel == 0);
}

TEST_CASE("P22 from 1 m/s the block stops in 18 steps, short by half a step", "[reference][P22]") {
    const WeightEnd end = crush({.mass = 6000, .strength = 80e3, .gravity = 10, .speed = 1}, dt);
    CHECK(end.steps == 18);
    CHECK(end.fall == Approx(0.15 - dt / 2).epsilon(1e-9));
    CHECK(end.joint.plastic_travel == Approx(0.15).epsilon(1e-9));
}
