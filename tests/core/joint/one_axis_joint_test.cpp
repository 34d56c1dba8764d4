// SPDX-License-Identifier: MIT
//
// The one-axis joint on a body that only it acts on: the row is solved exactly by clamping, so
// every difference from the closed form is the joint's own.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "ductile/joint/one_axis_joint.hpp"
#include "support/property.hpp"
#include "support/throws.hpp"

using namespace ductile;
using ductile::test::message_of;

namespace {

/// A mass on one plastic row, stepped by v' = v + dt (f + λ)/m, x' = x + dt v'.
template <class S>
struct Mass {
    Mass(S mass_, S strength, S limit = std::numeric_limits<S>::infinity())
        : mass(mass_),
          joint(Perfect<S>({.strength = strength}), TravelLimit<S>({.limit = limit})) {}

    Step<S> step(S dt, S load = 0) {
        const RowLimits<S> row = joint.prepare({position, velocity}, dt);
        const S free = velocity + dt * load / mass;
        const S impulse = std::clamp(mass * (row.bias - free), row.lower * dt, row.upper * dt);
        const S after = free + impulse / mass;
        position += after * dt;
        const Step<S> step = joint.commit({impulse / dt, after, position}, dt);
        velocity = std::copysign(std::sqrt(after * after + 2 * step.release / mass), after);
        return step;
    }

    S mass;
    OneAxisJoint<Perfect<S>> joint;
    S position = 0;
    S velocity = 0;
};

constexpr double steps_per_second[] = {15, 60, 240, 1000};

} // namespace

TEST_CASE("a rotor stops on its plastic hinge with exactly its kinetic energy dissipated",
          "[one_axis_joint]") {
    // I = 2 kg m², M_p = 40 N m, ω₀ = 10 rad/s: 2.5 rad, 100 J; the offset is short by ω₀ dt/2
    for (const double rate : {60.0, 240.0, 1000.0}) {
        const double dt = 1 / rate;
        Mass<double> rotor(2, 40);
        rotor.velocity = 10;
        while (rotor.velocity > 0) rotor.step(dt);
        INFO("dt = 1/" << rate);
        CHECK(rotor.joint.state().plastic_work == Approx(100).epsilon(1e-12));
        CHECK(rotor.joint.state().plastic_travel == Approx(2.5).epsilon(1e-12));
        CHECK(rotor.joint.state().plastic_offset == Approx(2.5 - 10 * dt / 2).epsilon(1e-9));
    }
}

TEST_CASE("energy is exact also where the stop ends inside a step", "[one_axis_joint]") {
    test::prop("any step, mass, strength and speed", [] {
        const double dt = *rc::gen::inRange(1, 500) / 1e3;
        const double mass = *rc::gen::inRange(1, 1000) / 10.0;
        const double strength = *rc::gen::inRange(1, 1000) / 1.0;
        const double speed = *rc::gen::inRange(1, 1000) / 10.0;
        Mass<double> body(mass, strength);
        body.velocity = speed;
        for (int i = 0; i < 1000000 && body.velocity > 0; ++i) body.step(dt);
        const double energy = mass * speed * speed / 2;
        RC_ASSERT(std::abs(body.joint.state().plastic_work - energy) < 1e-10 * energy);
    });
}

TEST_CASE("the residual speed after a break is exact at every step", "[one_axis_joint]") {
    // the same rotor with p_max = 1.6 and 1.3 rad: √(ω₀² - 2 α p_max)
    for (const double rate : steps_per_second) {
        for (const auto& [limit, residual] : {std::pair{1.6, 6.0}, std::pair{1.3, 6.92820323028}}) {
            Mass<double> rotor(2, 40, limit);
            rotor.velocity = 10;
            for (int i = 0; i < 10000 && !rotor.joint.state().broken; ++i) rotor.step(1 / rate);
            INFO("dt = 1/" << rate << ", limit " << limit);
            CHECK(rotor.velocity == Approx(residual).epsilon(1e-10));
            CHECK(rotor.joint.state().plastic_work == Approx(40 * limit).epsilon(1e-12));
            CHECK(rotor.joint.state().plastic_travel == Approx(limit).epsilon(1e-12));
        }
    }
}

TEST_CASE("a break takes the same energy at any step", "[one_axis_joint]") {
    test::prop("any limit and step", [] {
        const double dt = *rc::gen::inRange(1, 1000) / 1e4;
        const double limit = *rc::gen::inRange(1, 2400) / 1e3;
        Mass<double> rotor(2, 40, limit);
        rotor.velocity = 10;
        for (int i = 0; i < 100000 && !rotor.joint.state().broken; ++i) rotor.step(dt);
        const double residual = std::sqrt(100 - 2 * 20 * limit);
        RC_ASSERT(std::abs(rotor.velocity - residual) < 1e-9);
        RC_ASSERT(rotor.joint.state().plastic_work == Approx(40 * limit).epsilon(1e-10));
    });
}

TEST_CASE("after the break nothing is asked for and nothing comes back", "[one_axis_joint]") {
    Mass<double> rotor(2, 40, 0.5);
    rotor.velocity = 10;
    while (!rotor.joint.state().broken) rotor.step(0.01);
    const auto broken = rotor.joint.state();
    rotor.velocity = -3;
    for (int i = 0; i < 100; ++i) CHECK(rotor.step(0.01).outcome == Outcome::broken);
    CHECK(rotor.velocity == -3);
    CHECK(rotor.joint.state() == broken);
}

TEST_CASE("the hanging block of the seed's table", "[one_axis_joint]") {
    // 6000 kg on an 80 kN bar, g = 10, dt = 1/60, the row acting from step 2 on
    Mass<double> block(6000, 80e3);
    block.velocity = -1.0 / 6;
    block.position = -1.0 / 360;
    auto state = block.joint.state();
    state.plastic_offset = block.position;
    block.joint.restore(state);
    const double y[] = {-1.0 / 216, -1.0 / 180, -1.0 / 180, -1.0 / 180};
    const double v[] = {-1.0 / 9, -1.0 / 18, 0, 0};
    for (int i = 0; i < 4; ++i) {
        const Step<double> step = block.step(1.0 / 60, -60e3);
        INFO("step " << i + 2);
        CHECK(block.position == Approx(y[i]).epsilon(1e-12));
        CHECK(block.velocity == Approx(v[i]).margin(1e-15));
        CHECK(step.outcome == (i < 3 ? Outcome::yielding : Outcome::elastic));
    }
    // geometric travel 1/360 m; the work-conjugate travel is that of the continuous problem
    CHECK(block.joint.state().plastic_offset + 1.0 / 360 == Approx(-1.0 / 360).epsilon(1e-12));
    CHECK(block.joint.state().plastic_travel == Approx(1.0 / 240).epsilon(1e-12));
}

TEST_CASE("load below yield never consumes life", "[one_axis_joint]") {
    test::prop("any load history below yield, with solver noise on the velocity", [] {
        OneAxisJoint joint(Perfect<double>({.strength = 10}));
        double position = 0, velocity = 0;
        const double dt = 0.01;
        for (int i = 0; i < 200; ++i) {
            (void)joint.prepare({position, velocity}, dt);
            const double force = *rc::gen::inRange(-999, 999) / 100.0;
            velocity = *rc::gen::inRange(-100, 100) * 1e-7; // jitter
            position += velocity * dt;
            joint.commit({force, velocity, position}, dt);
        }
        RC_ASSERT(joint.state().plastic_travel == 0);
        RC_ASSERT(joint.state().plastic_work == 0);
    });
}

TEST_CASE("random loads never create energy, turn to NaN or mend a break", "[one_axis_joint]") {
    Mass<double> body(3, 25, 4);
    unsigned seed = 1;
    double last = 0;
    bool broken = false;
    for (int i = 0; i < 100000; ++i) {
        seed = seed * 1664525u + 1013904223u;
        body.step(0.002, (double(seed >> 8) / double(1u << 24) - 0.5) * 400);
        const auto& state = body.joint.state();
        REQUIRE(std::isfinite(body.velocity));
        REQUIRE(state.plastic_work >= last);
        REQUIRE((!broken || state.broken));
        last = state.plastic_work;
        broken = state.broken;
        if (!broken)
            REQUIRE(state.plastic_work == Approx(25 * state.plastic_travel).epsilon(1e-12));
    }
    CHECK(broken);
}

TEST_CASE("a solver that leaves the row unsolved is called unreliable", "[one_axis_joint]") {
    OneAxisJoint joint(Perfect<double>({.strength = 10}));
    (void)joint.prepare({0, 0}, 0.01);
    // moves at 0.5 rad/s although its moment is inside the bounds
    CHECK(joint.commit({3, 0.5, 0.005}, 0.01).outcome == Outcome::unreliable);
    (void)joint.prepare({0, 0.5}, 0.01);
    // at the upper bound it may not run ahead of its target
    CHECK(joint.commit({10, 0.5, 0.01}, 0.01).residual == Approx(0.5));
    (void)joint.prepare({0, 0.5}, 0.01);
    // at the lower bound, resisting: that is flow
    const Step<double> flow = joint.commit({-10, 0.4, 0.014}, 0.01);
    CHECK(flow.outcome == Outcome::yielding);
    CHECK(flow.residual == 0);
    CHECK(joint.state().residual_max >= 0.49);
}

TEST_CASE("a holding row removes drift in its time, whatever the step", "[one_axis_joint]") {
    for (const double dt : {1e-5, 1e-4, 1e-3}) {
        OneAxisJoint joint(Perfect<double>({.strength = 10}), TravelLimit<double>{},
                           {.drift_time = 0.02});
        CHECK(joint.prepare({0.001, 0}, dt).bias == Approx(-0.001 / 0.02));
    }
    OneAxisJoint joint(Perfect<double>({.strength = 10}));
    CHECK(joint.prepare({0.001, 0}, 0.1).bias == Approx(-0.001 / 0.5)); // five long steps
}

TEMPLATE_TEST_CASE("the answer does not depend on the units", "[one_axis_joint]", float, double) {
    // m, kg, s against mm, t, s: lengths × 1000, masses / 1000, forces the same in N
    Mass<TestType> si(TestType(500), TestType(30e3), TestType(0.3));
    Mass<TestType> mm(TestType(0.5), TestType(30e3), TestType(300));
    si.velocity = TestType(-6);
    mm.velocity = TestType(-6000);
    for (int i = 0; i < 50; ++i) {
        si.step(TestType(0.005), TestType(-4905));
        mm.step(TestType(0.005), TestType(-4905));
    }
    const double rounding = std::is_same_v<TestType, float> ? 2e-5 : 1e-12;
    CHECK(double(mm.position) == Approx(1000 * double(si.position)).epsilon(rounding));
    CHECK(double(mm.joint.state().plastic_work) ==
          Approx(1000 * double(si.joint.state().plastic_work)).epsilon(rounding));
    CHECK(mm.joint.state().broken == si.joint.state().broken);
}

TEST_CASE("a saved and restored joint goes on bit for bit", "[one_axis_joint]") {
    Mass<double> a(2, 40, 2.4);
    a.velocity = 10;
    for (int i = 0; i < 7; ++i) a.step(0.011);
    Mass<double> b(2, 40, 2.4);
    b.velocity = a.velocity;
    b.position = a.position;
    b.joint.restore(a.joint.state());
    for (int i = 0; i < 60; ++i) {
        a.step(0.011);
        b.step(0.011);
        REQUIRE(a.joint.state() == b.joint.state());
        REQUIRE(a.velocity == b.velocity);
    }
}

TEST_CASE("a joint refuses parameters that make none, by name", "[one_axis_joint]") {
    const Perfect<double> law({.strength = 1});
    CHECK(message_of([&] { OneAxisJoint(law, TravelLimit<double>{}, {.drift_time = 0}); }) ==
          "OneAxisJoint.drift_time = 0 s: must be finite and > 0");
    CHECK(message_of([&] {
              OneAxisJoint(law, TravelLimit<double>{}, {.absolute_residual = -1});
          }) == "OneAxisJoint.absolute_residual = -1 m/s or rad/s: must be finite and > 0");
    CHECK(message_of([&] { OneAxisJoint(law, TravelLimit<double>{}, {.relative_residual = 2}); }) ==
          "OneAxisJoint.relative_residual = 2: must be in [0, 1]");
    CHECK(message_of([] { Perfect<double>({}); }) ==
          "Perfect.strength = nan N or N m: must be finite and > 0");
}
