// SPDX-License-Identifier: MIT
//
// The certificate of the step: a joint on a body that only it acts on, where what a step misplaces
// is known in closed form.
#include "ductile/joint/step_error.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ductile/joint/coupled_joint.hpp"
#include "ductile/joint/one_axis_joint.hpp"
#include "ductile/law/perfect.hpp"
#include "ductile/surface/ellipsoid.hpp"
#include "ductile/surface/independent_axes.hpp"
#include "support/property.hpp"
#include "support/throws.hpp"

using namespace ductile;
using ductile::test::message_of;

namespace {

constexpr double rigid = std::numeric_limits<double>::infinity();

/// A mass on one row, rigid or elastic, under a load; velocity and position as an engine moves
/// them.
struct Body {
    double mass;
    OneAxisJoint<Perfect<double>> joint;
    double velocity = 0, position = 0;

    Body(double m, double strength, double stiffness = rigid, double limit = rigid)
        : mass(m),
          joint(Perfect<double>({.strength = strength}), TravelLimit<double>({.limit = limit}),
                {.stiffness = stiffness}) {}

    Step<double> step(double dt, double load = 0) {
        const auto row = joint.prepare({position, velocity, mass}, dt);
        const double free = velocity + dt * load / mass;
        const double impulse = std::clamp((row.bias - free) / (1 / mass + row.compliance),
                                          row.lower * dt, row.upper * dt);
        velocity = free + impulse / mass;
        position += velocity * dt;
        return joint.commit({impulse / dt, velocity, position}, dt);
    }
};

struct Stop {
    bool coarse = false;
    int steps = 0, coarse_before_end = 0;
    double error = 0;     ///< as the joint estimates it
    double misplaced = 0; ///< of the rest position, relative to v²m/(2R)
};

Stop stop(double mass, double strength, double speed, double dt) {
    Body body(mass, strength);
    body.velocity = speed;
    Stop result;
    while (body.velocity > 0) {
        const auto step = body.step(dt);
        result.coarse = result.coarse || step.coarse;
        result.coarse_before_end += step.coarse && body.velocity > 1e-9;
        result.error = step.step_error;
        ++result.steps;
    }
    // a flow that came to rest right at its bound has ended when the next step holds
    result.coarse = body.step(dt).coarse || result.coarse;
    const double exact = mass * speed * speed / (2 * strength);
    result.misplaced = std::abs(body.position / exact - 1);
    return result;
}

} // namespace

TEST_CASE("a stop in n steps is off by one part in n, and the joint says so", "[step_error]") {
    // 2 kg at 10 m/s against 40 N stops in 0.5 s after 2.5 m; an engine leaves it v dt/2 short
    for (const int n : {5, 10, 20, 40, 100, 1000}) {
        const Stop s = stop(2, 40, 10, 0.5 / n);
        INFO("n = " << n);
        CHECK(s.misplaced == Approx(1.0 / n).epsilon(1e-6));
        CHECK(s.error == Approx(s.misplaced).epsilon(2e-3)); // least_travel is 0.0008 of it
        CHECK(s.coarse == (n < 25));
        CHECK(s.coarse_before_end == 0);
    }
}

TEST_CASE("a rest position more than a twentieth off is never left unsaid", "[step_error]") {
    test::prop("any mass, strength, speed and step", [] {
        const double mass = *rc::gen::inRange(1, 1000) / 10.0;
        const double strength = *rc::gen::inRange(1, 1000) / 1.0;
        const double speed = *rc::gen::inRange(10, 1000) / 10.0;
        const double dt = *rc::gen::inRange(1, 500) / 1e4;
        const Stop s = stop(mass, strength, speed, dt);
        const double travel = mass * speed * speed / (2 * strength);
        if (travel < 0.05) return; // small against what does not matter
        RC_ASSERT(s.coarse || s.misplaced < 0.05);
        RC_ASSERT(!s.coarse || s.misplaced > 0.03 || s.steps < 40); // and not said idly
    });
}

TEST_CASE("travel too small to matter raises no alarm", "[step_error]") {
    CHECK_FALSE(stop(1, 1000, 0.05, 1e-2).coarse); // 1.25 µm in a single step
    CHECK(stop(1, 1000, 2, 1e-2).coarse);          // 2 mm in a single step
}

TEST_CASE("a steady flow misplaces nothing", "[step_error]") {
    Body body(3, 50);
    body.velocity = 2;
    Step<double> last;
    for (int i = 0; i < 100; ++i) last = body.step(0.05, 50);
    CHECK(body.joint.state().plastic_travel == Approx(10));
    CHECK(last.step_error < 1e-9);
}

TEST_CASE("a flow that begins within a step is as uncertain as that step", "[step_error]") {
    // what a contact does: from rest to 1 m/s within the solve, then on at that speed
    Body body(1, 50);
    const double dt = 0.01;
    body.step(dt, 50 + 1 / dt);
    CHECK(body.velocity == Approx(1));
    CHECK(body.joint.state().misplaced == Approx(dt / 2));
    for (int i = 0; i < 9; ++i) CHECK_FALSE(body.step(dt, 50).coarse);
    CHECK(body.joint.state().plastic_travel == Approx(9.5 * dt));
    CHECK(body.joint.state().misplaced == Approx(dt / 2)); // at once, not again when it goes on
    body.velocity = 0;
    CHECK(body.step(dt).coarse); // 5 mm in 95
}

TEST_CASE("a spring that the step damps is told where it would have yielded", "[step_error]") {
    // k = 4e6 N/m, m = 100 kg: ω = 200 rad/s; a load F at once should swing to 2 F/k
    const double strength = 2000, k = 4e6;
    const auto sudden = [&](double share, double dt) {
        Body body(100, strength, k);
        bool coarse = false;
        for (int i = 0; i < 20; ++i) coarse = body.step(dt, share * strength).coarse || coarse;
        return coarse;
    };
    CHECK(sudden(0.8, 1.0 / 60)); // a = 11: comes to rest at 0.8 of yield, and should have yielded
    CHECK(sudden(0.8, 1.0 / 30));
    CHECK(sudden(0.6, 1.0 / 60));
    CHECK(sudden(0.6, 1.0 / 30));
    CHECK_FALSE(sudden(0.45, 1.0 / 60)); // swings to 0.9 of yield only
    CHECK_FALSE(sudden(0.3, 1.0 / 60));
    CHECK_FALSE(sudden(0.8, 2e-4)); // a = 0.0016: it swings

    // ten times as stiff: it moves at a millimetre a second, and the first step says it
    Body stiff(100, strength, 4e7);
    CHECK(stiff.step(1.0 / 30, 0.8 * strength).coarse);
}

TEST_CASE("slow loading of a stiff spring raises no alarm", "[step_error]") {
    Body body(100, 2000, 4e6);
    const double dt = 1.0 / 60;
    for (int i = 0; i < 600; ++i) {
        CHECK_FALSE(body.step(dt, 1990.0 * i / 600).coarse);
    }
    CHECK(body.joint.state().plastic_work == 0);
}

TEST_CASE("vibration below yield adds up to nothing", "[step_error]") {
    Body body(100, 2000, 4e6);
    const double dt = 1.0 / 60;
    for (int i = 0; i < 20000; ++i) {
        CHECK_FALSE(body.step(dt, i % 7 < 3 ? 300.0 : -300.0).coarse);
    }
    CHECK(body.joint.state().misplaced == 0);
}

TEST_CASE("a joint of several axes judges its step as one axis does", "[step_error]") {
    using Surface = IndependentAxes<double, 2>;
    for (const int n : {5, 20, 40, 100}) {
        CoupledJoint joint(Surface({.capacity = {40, 1e6}}), Perfect<double>({.strength = 40}));
        const double dt = 0.5 / n, mass = 2;
        double velocity = 10, position = 0;
        CoupledStep<double, 2> last;
        bool coarse = false;
        for (bool moving = true; moving; moving = velocity > 0 || last.plastic_work > 0) {
            const auto rows = joint.prepare({.position = {position, 0},
                                             .velocity = {velocity, 0},
                                             .mass = mass * Eigen::Matrix2d::Identity()},
                                            dt);
            const double impulse = std::clamp(mass * (rows[0].bias - velocity), rows[0].lower * dt,
                                              rows[0].upper * dt);
            velocity += impulse / mass;
            position += velocity * dt;
            last = joint.commit(
                {.force = {impulse / dt, 0}, .velocity = {velocity, 0}, .position = {position, 0}},
                dt);
            coarse = coarse || last.coarse;
        }
        INFO("n = " << n);
        CHECK(last.step_error == Approx(1.0 / n).epsilon(2e-3));
        CHECK(coarse == (n < 25));
    }
}

TEST_CASE("a flow that leaves the normal of the surface is told", "[step_error]") {
    // told a mass that is too small by so much, the joint predicts the pushed row's force too low,
    // and that row gives way although the load on it is 3 % of its capacity
    const double told = GENERATE(4.0, 1.0, 0.25, 0.01);
    INFO("told mass " << told);
    constexpr double dt = 1e-3;
    using Axes = Eigen::Vector2d;
    CoupledJoint joint(Ellipsoid<double, 2>({.capacity = {1, 100}}),
                       Perfect<double>({.strength = 1}));
    Axes velocity(0.2, 0), position(0, 0);
    const Axes load(0, 3);
    bool coarse = false;
    for (int i = 0; i < 400; ++i) {
        const auto rows =
            joint.prepare({position, velocity, told * Eigen::Matrix2d::Identity()}, dt);
        Axes force;
        for (int axis = 0; axis < 2; ++axis) {
            const auto& row = rows[std::size_t(axis)];
            const double free = velocity[axis] + load[axis] * dt;
            force[axis] = std::clamp((row.bias - free) / dt, row.lower, row.upper);
            velocity[axis] = free + force[axis] * dt;
        }
        position += velocity * dt;
        coarse = coarse || joint.commit({force, velocity, position}, dt).coarse;
    }
    CHECK(position[0] == Approx(0.02).epsilon(0.01));
    // alone, the first row would flow by 0.2²/2
    const double excess = joint.state().plastic_travel / 0.02 - 1;
    CHECK((excess > 0.05) == (told < 0.1));
    CHECK(coarse == (told < 0.1));
}

TEST_CASE("parameters of the step's certificate are checked", "[step_error]") {
    CHECK(message_of([] {
              OneAxisParameters<double> p;
              p.allowed_step_error = 0;
              p.validate();
          }).find("OneAxisJoint.allowed_step_error = 0") != std::string::npos);
    CHECK(message_of([] {
              CoupledParameters<double, 2> p;
              p.least_travel = -1;
              p.validate();
          }).find("CoupledJoint.least_travel = -1 m or rad") != std::string::npos);
}
