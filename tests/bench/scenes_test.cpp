// SPDX-License-Identifier: MIT
//
// The bench's scenes: their expected values are the reference's, their start is the problem's, and
// in every engine the right method comes to the known answer while wrong ones do not.
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <string>

#include "engines/run_scene.hpp"
#include "engines/world.hpp"
#include "methods/names.hpp"
#include "scenes/all.hpp"

using namespace bench;

namespace {

constexpr bool single = World::precision == "float";
/// A direct solver; where it gives up, a well converged iterative one.
const std::string direct = World::engine == "ode" ? "direct" : "si";
constexpr int fallback = 200;

double expected(const Scene& scene, const std::string& quantity) {
    for (const Quantity& q : scene.quantities) {
        if (q.name == quantity) return q.expected;
    }
    FAIL("no such quantity: " << quantity);
    return 0;
}

double error(const Scene& scene, const std::string& quantity, const Settings& settings) {
    const RunResult run = observe<World>(scene, settings);
    for (const Quantity& q : scene.quantities) {
        if (q.name == quantity) return relative_error(q, run).value();
    }
    FAIL("no such quantity: " << quantity);
    return 0;
}

Settings with(const std::string& method, double dt) {
    return {.solver = direct, .iterations = fallback, .method = method, .dt = dt};
}

double kinetic_at_start(const Scene& scene) {
    double sum = 0;
    for (const BodySpec& body : scene.bodies) sum += kinetic(body, body.start);
    return sum;
}

} // namespace

TEST_CASE("expected values are those of the reference problems", "[bench]") {
    // the reference prints nine or ten digits
    const auto same = [](double value, double reference, double tolerance = 2e-9) {
        CHECK(value == Approx(reference).epsilon(tolerance));
    };
    same(expected(breaking_hinge(), "residual_speed"), 6.92820323);
    same(expected(breaking_hinge(), "absorbed_energy"), 52);
    same(expected(rotors_in_series(), "rotation_2"), 1.309091, 1e-6); // seven digits
    same(expected(rotors_in_series(), "rotation_1"), 3.927273, 1e-6);
    same(expected(rotors_in_series(), "absorbed_energy"), 144);
    same(expected(oscillator(), "peak_travel"), 0.125);
    same(expected(oscillator({.load = 0.9}), "peak_travel"), 0.25);
    same(expected(dropped_mass(), "crush"), 0.362461412);
    same(expected(dropped_mass(), "absorbed_energy"), 10873.8424, 1e-8);
    same(expected(charpy_blow(), "hammer_loss"), 122.71605, 1e-7); // eight digits
    same(expected(charpy_blow(), "absorbed_energy"), 122.01607, 1e-7);
}

TEST_CASE("the struck cantilever starts with the energy that the impulse leaves", "[bench]") {
    for (const ChainAnswer& answer : struck_chain_answers) {
        const Scene scene = struck_cantilever({.segments = answer.segments});
        INFO(answer.segments << " segments");
        CHECK(kinetic_at_start(scene) == Approx(answer.energy).epsilon(1e-8)); // printed digits
        CHECK(scene.joints.size() == std::size_t(answer.segments));
    }
    CHECK_THROWS_AS(struck_cantilever({.segments = 7}), std::invalid_argument);
}

TEST_CASE("the lamp-post's rotation is that of its equation of motion", "[bench]") {
    // θ'' (m h²/cos⁴θ + I) + 2 m h² θ'² tan θ/cos⁴θ = W sin θ - M_p, from the speed after the
    // impact
    const LampPostParameters p;
    const double inertia = p.post_mass * p.post_length * p.post_length / 3;
    const double lever = p.vehicle * p.bumper * p.bumper;
    const double weight = p.post_mass * p.gravity * p.post_length / 2;
    double angle = 0, rate = p.vehicle * p.speed * p.bumper / (lever + inertia);
    const auto acceleration = [&](double theta, double speed) {
        const double stretched = lever / std::pow(std::cos(theta), 4);
        return (weight * std::sin(theta) - p.plastic_moment -
                2 * stretched * speed * speed * std::tan(theta)) /
               (stretched + inertia);
    };
    const double dt = 1e-5;
    while (rate > 0) { // midpoint rule
        const double middle = rate + acceleration(angle, rate) * dt / 2;
        const double halfway = angle + rate * dt / 2;
        angle += middle * dt;
        rate += acceleration(halfway, middle) * dt;
    }
    // the last step goes past the stop by at most one step of vanishing speed
    CHECK(expected(lamp_post(p), "rotation") == Approx(angle).epsilon(1e-7));
    CHECK_THROWS_AS(lamp_post({.plastic_moment = 2e3}), std::invalid_argument);
}

TEST_CASE("the right method comes to every known answer", "[bench]") {
    // errors at these steps are of first order in the step but for the breaking hinge, which is
    // exact; bounds are twice what ODE's direct solver leaves
    struct Case {
        Scene scene;
        const char* method;
        double dt, bound;
    };
    const Case cases[] = {
        {breaking_hinge(), "plastic-hinge", 1.0 / 60, single ? 2e-4 : 1e-9},
        {rotors_in_series(), "plastic-hinge", 1e-3, 1e-2},
        {oscillator(), "explicit-clamp", 1.0 / 240, 2e-3},
        {oscillator(), "elastic-plastic", 1.0 / 240, 2e-3},
        // its springs are implicit in a step that flows
        {oscillator(), "plastic-joint", 1.0 / 240, 4.3e-3},
        {breaking_hinge(), "plastic-joint", 1.0 / 60, single ? 2e-4 : 1e-8},
        {rotors_in_series(), "plastic-joint", 1e-3, 1e-2},
        {struck_cantilever(), "plastic-joint", 1e-4, 1e-2},
        {dropped_mass(), "plastic-joint", 1e-3, 2e-2},
        {struck_cantilever(), "plastic-hinge", 1e-4, 1e-2},
        {dropped_mass(), "plastic-hinge", 1e-3, 2e-2},
        {lamp_post(), "plastic-hinge", 1e-3, 1e-2},
        {charpy_blow(), "plastic-hinge", 2e-5, single ? 5e-2 : 1e-2},
    };
    for (const Case& c : cases) {
        INFO(c.scene.name);
        CHECK(error(c.scene, c.scene.quantities[0].name, with(c.method, c.dt)) < c.bound);
    }
}

TEST_CASE("frames with a tolerance come to the answers, and are believed", "[bench]") {
    if (!World::has_frames) return;
    for (const Scene& scene : all_scenes()) {
        for (const double frame : {1.0 / 30, 1.0 / 240}) {
            CAPTURE(scene.name, frame);
            Settings settings = with("elastic-plastic", frame);
            settings.tolerance = 0.01;
            const RunResult run = observe<World>(scene, settings);
            const bool blow =
                scene.name == "charpy"; // first order in the edges' turning; 5.5 % at 1/30
            CHECK(relative_error(scene.quantities[0], run).value() < (blow ? 0.06 : 0.01));
            CHECK(run.frames.believed());
            CHECK(run.energy_highest < run.energy_start + (single ? 1e-2 : 1e-6));
        }
    }
}

TEST_CASE("a guide holds an axis whose error is exactly zero", "[bench]") {
    const Scene scene = lamp_post(); // its vehicle would fall for one step
    World world(scene, with("plastic-hinge", 1.0 / 30));
    world.step(1.0 / 30);
    CHECK(std::abs(world.state(0).position.y() - scene.bodies[0].start.position.y()) <
          1e-6); // a fall would be of g dt², 11 mm
}

TEST_CASE("methods that keep no account of energy have no such quantity", "[bench]") {
    const Scene scene = breaking_hinge();
    for (const MethodName& method : method_names) {
        if (!World::has(method.name)) continue;
        INFO(method.name);
        const RunResult run = observe<World>(scene, with(std::string(method.name), 1e-3));
        const bool accounts =
            method.ours || method.name == "seed-account" || method.name == "explicit-clamp";
        CHECK(run.end.absorbed.has_value() == accounts);
        CHECK(run.finite);
    }
    // a motor without an account never breaks
    CHECK(error(scene, "residual_speed", with("hinge-motor", 1e-3)) > 0.4);
}

TEST_CASE("the timed run is the observed one", "[bench]") {
    Scene scene = rotors_in_series();
    scene.duration = 0.1; // in mid-motion, where a step more or less shows
    const Settings settings = with("plastic-hinge", 1.0 / 240);
    const RunResult seen = observe<World>(scene, settings);
    World world(scene, settings);
    Stepping stepping(scene, settings);
    bench_steps(world, stepping, seen.steps);
    CHECK(world.state(1).rotation == seen.end.bodies[1].rotation);
    CHECK(world.state(1).spin == seen.end.bodies[1].spin);
    const Cost spent = cost_of<World>(scene, settings, seen.steps, 1, 0);
    CHECK(spent.cpu > 0);
    CHECK(spent.yardstick > 0);
}

TEST_CASE("a method or solver that is not there is refused", "[bench]") {
    CHECK_THROWS_AS(World(breaking_hinge(), with("wishful", 1e-3)), std::invalid_argument);
    Settings settings = with("plastic-hinge", 1e-3);
    settings.solver = "wishful";
    CHECK_THROWS_AS(World(breaking_hinge(), settings), std::invalid_argument);
}
