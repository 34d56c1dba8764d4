// SPDX-License-Identifier: MIT
//
// The Charpy test of every engine build against the mechanics of its one-degree-of-freedom
// mechanism. Frictionless; the hammer's inertia is 22.804 kg m², so expected: 122.016 J plastic,
// 122.716 J lost.
#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "reference.hpp"
#include "simulation.hpp"

#ifdef CHARPY_ODE
static const std::vector<std::string> solvers{"direct", "quick"};
static const std::string rebounding = "direct";
#else
static const std::vector<std::string> solvers{"mlcp", "si"};
/// Bullet's own: with restitution and a bar against its anvils Dantzig makes energy, sweeps lose
/// the rebound.
static const std::string rebounding = "island";
#endif
static const std::vector<charpy::Method> elastic_methods{charpy::Method::elastic_plastic,
                                                         charpy::Method::elastic_plastic_2};

using namespace charpy;

namespace {

#if defined(CHARPY_ODE) || defined(BT_USE_DOUBLE_PRECISION)
constexpr bool single = false;
#else
constexpr bool single = true;
#endif

/// Of frames, 1e-5 of what the hammer has [J].
constexpr double unexplained = single ? 1e-2 : 3e-3;
constexpr std::array frames{1.0 / 240, 1.0 / 120, 1.0 / 60, 1.0 / 30}; // [s]
/// The seed's, where its own energies were 100, 110, 90, 130 and 150 J [s].
constexpr std::array seed_steps{1.001e-4, 1e-4, 0.99e-4, 0.8e-4, 0.5e-4};

Result run(const Scenario& scenario, const std::string& solver = solvers.front(),
           Method method = Method::plastic_hinge) {
    return charpy::run(scenario, method, solver);
}

Scenario in_frames(double frame) {
    Scenario s;
    s.frame = frame;
    return s;
}

} // namespace

TEST_CASE("the mechanics of the test agree with the published figures", "[charpy]") {
    const Reference r = reference(Scenario{});
    CHECK(Scenario{}.hammer_inertia() == Approx(22.80448).epsilon(1e-6));
    CHECK(Scenario{}.notched_moment() == Approx(64).epsilon(1e-12));
    CHECK(r.rotation == Approx(1.906501022).epsilon(1e-9));
    CHECK(r.plastic_work == Approx(122.01607).epsilon(1e-7));
    CHECK(r.strike_speed == Approx(5.052725).epsilon(1e-6));
    CHECK(r.contact_loss == Approx(0.16740028).epsilon(1e-6));
    CHECK(r.hammer_loss == Approx(122.71605).epsilon(1e-7));
    CHECK(r.specimen_kinetic == Approx(0.53258152).epsilon(1e-6));
}

TEST_CASE("whatever the frame, the energies are right and believed", "[charpy]") {
    const double frame = GENERATE(from_range(frames));
    const std::string solver = GENERATE(from_range(solvers));
    INFO(solver << ", frame " << frame);
    const Scenario scenario = in_frames(frame);
    const Result r = run(scenario, solver);
    const Reference expected = reference(scenario);
    CHECK(r.believed);
    CHECK(r.plastic_work == Approx(expected.plastic_work).epsilon(0.005));
    CHECK(r.hammer_loss == Approx(expected.hammer_loss).epsilon(0.015));
    CHECK(std::abs(r.unexplained) < unexplained);
    CHECK(r.solves < 250);
    CHECK_FALSE(r.broken);
}

TEST_CASE("what is off by more than a joint allows is never silent", "[charpy]") {
    const double frame = GENERATE(from_range(frames));
    const double more = GENERATE(0.0, 2e-4, 1e-4, 0.5e-4); // the blow at another place in the frame
    const int parts = GENERATE(2, 4);
    const std::string solver = GENERATE(from_range(solvers));
    INFO(solver << ", frame " << frame << " + " << more << ", parts " << parts);
    Scenario scenario = in_frames(frame + more);
    scenario.parts = parts;
    const Result r = run(scenario, solver);
    INFO("plastic work " << r.plastic_work << ", left " << r.left);
    const double allowed = ductile::OneAxisParameters<double>{}.allowed_step_error;
    const bool wrong = !(std::abs(r.plastic_work / 122.016 - 1) <= allowed);
    CHECK((!wrong || !r.believed));
}

TEST_CASE("plastic work does not scatter over the seed's five steps", "[charpy]") {
    std::vector<double> work;
    for (const double step : seed_steps) {
        const Result r = run(in_frames(step));
        work.push_back(r.plastic_work);
        CHECK(r.plastic_work == Approx(122.016).epsilon(0.01));
    }
    const auto [low, high] = std::minmax_element(work.begin(), work.end());
    CHECK(*high - *low < 0.01 * 122.016);
}

TEST_CASE("in small frames the hammer loses what hinge and halves take", "[charpy]") {
    const double frame = GENERATE(2e-5, 1e-5);
    const Result r = run(in_frames(frame));
    INFO("frame " << frame);
    CHECK(r.hammer_loss == Approx(r.plastic_work + r.specimen_kinetic).epsilon(0.01));
}

TEST_CASE("a break at 1.5 rad takes 96 J in every frame", "[charpy]") {
    Scenario scenario = in_frames(GENERATE(2e-5, 1e-4, 1e-3, 1.0 / 240, 1.0 / 60, 1.0 / 30));
    scenario.max_plastic_rotation = 1.5;
    const Result r = run(scenario);
    INFO("frame " << scenario.frame);
    CHECK(r.broken);
    CHECK(r.plastic_work == Approx(96).epsilon(0.005));
    CHECK(r.plastic_rotation == Approx(1.5));
    CHECK(r.hammer_loss == Approx(reference(scenario).hammer_loss).epsilon(0.02));
}

TEST_CASE("friction takes more and is booked as friction", "[charpy]") {
    Scenario scenario = in_frames(GENERATE(from_range(frames)));
    const Result without = run(scenario);
    scenario.friction = 0.3;
    const Result with = run(scenario);
    CHECK(with.friction_work > 10);
    CHECK(with.plastic_work == Approx(without.plastic_work).epsilon(0.01));
    CHECK(with.hammer_loss - without.hammer_loss == Approx(with.friction_work).epsilon(0.05));
}

TEST_CASE("a specimen without a hinge stops the hammer", "[charpy]") {
    const Result r = run(Scenario{}, solvers.front(), Method::rigid);
    CHECK(r.hammer_loss == Approx(291.0995).epsilon(0.005));
    CHECK(r.contact_work == Approx(291.0995).epsilon(0.005));
}

TEST_CASE("a hammer rebounds from a rigid bar with the restitution's share of its speed",
          "[charpy]") {
    Scenario scenario;
    scenario.restitution = GENERATE(0.3, 0.5, 0.9, 1.0);
    INFO("restitution " << scenario.restitution);
    const Result r = run(scenario, rebounding, Method::rigid);
    // the bar lies against its anvils before and after: the nose keeps -e of its speed, the hammer
    // e² of 291.1 J
    const double kept = scenario.restitution * scenario.restitution;
    CHECK(r.hammer_loss == Approx(291.0995 * (1 - kept)).margin(0.005 * 291.0995));
    CHECK(std::abs(r.unexplained) < (single ? 1e-2 : 1e-3));
}

TEST_CASE("a bar that is struck off the hammer takes the same plastic work", "[charpy]") {
    Scenario scenario = in_frames(GENERATE(from_range(frames)));
    scenario.restitution = GENERATE(0.2, 0.5);
    INFO("restitution " << scenario.restitution << ", frame " << scenario.frame);
    const Result r = run(scenario);
    CHECK(r.plastic_work == Approx(reference(scenario).plastic_work).epsilon(0.01));
}

TEST_CASE("twice the yield stress takes twice the energy", "[charpy]") {
    // in float a single run scatters by 1 % with its round-off, so the mean of neighbours is looked
    // at too
    Scenario scenario = in_frames(GENERATE(from_range(frames)));
    double work = 0, loss = 0;
    constexpr std::array yields{796e6, 798e6, 800e6, 802e6, 804e6};
    for (const double yield : yields) {
        scenario.yield_stress = yield;
        INFO("yield stress " << yield << ", frame " << scenario.frame);
        const Result r = run(scenario);
        const Reference expected = reference(scenario);
        CHECK(r.plastic_work == Approx(expected.plastic_work).epsilon(0.02));
        work += r.plastic_work / expected.plastic_work / double(yields.size());
        loss += r.hammer_loss / expected.hammer_loss / double(yields.size());
    }
    CHECK(work == Approx(1).epsilon(0.01));
    CHECK(loss == Approx(1).epsilon(0.02));
}

TEST_CASE("an elastic-plastic joint flows for the turn that its spring leaves", "[charpy]") {
    const Method method = GENERATE(from_range(elastic_methods));
    Scenario scenario = in_frames(GENERATE(from_range(frames)));
    const Reference expected = reference(scenario, method);
    INFO(to_string(method) << ", frame " << scenario.frame);
    // M_p²/2k = 64²/(2 · 200e9 · 10 · 8³/12 mm⁴/27.5 mm)
    CHECK(expected.stored == Approx(0.66).epsilon(1e-9));
    CHECK(expected.plastic_work == Approx(122.01607 - 1.32).epsilon(1e-7));
    const Result r = run(scenario, solvers.front(), method);
    CHECK(r.plastic_work == Approx(expected.plastic_work).epsilon(0.01));
    CHECK(r.hammer_loss == Approx(expected.hammer_loss).epsilon(0.015));
    // what it stored has sprung back, and at most swings in it, or it says so
    CHECK((r.stored < expected.stored || !r.believed));
    CHECK(r.solves < 400);
    CHECK_FALSE(r.broken);
    CHECK(std::abs(r.unexplained) < unexplained);
}

TEST_CASE("a softer steel stores more and flows less", "[charpy]") {
    // moduli at which the rows are soft: ODE's direct solver ends the process where such rows are
    // handed to it as they are
    const Method method = GENERATE(from_range(elastic_methods));
    const double modulus = GENERATE(40e9, 70e9, 100e9, 150e9);
    INFO(to_string(method) << ", E = " << modulus << " Pa");
    Scenario scenario;
    scenario.youngs_modulus = modulus;
    const Reference expected = reference(scenario, method);
    CHECK(expected.plastic_work == Approx(122.01607 - 200e9 / modulus * 1.32).epsilon(1e-7));
    const Result r = run(scenario, solvers.front(), method);
    CHECK(r.plastic_work == Approx(expected.plastic_work).epsilon(0.01));
}

TEST_CASE("elastic-plastic work does not scatter over the seed's five steps", "[charpy]") {
    const Method method = GENERATE(from_range(elastic_methods));
    INFO(to_string(method));
    const Reference expected = reference(Scenario{}, method);
    for (const double step : seed_steps) {
        const Result r = run(in_frames(step), solvers.front(), method);
        INFO("step " << step);
        CHECK(r.plastic_work == Approx(expected.plastic_work).epsilon(0.02));
    }
}

TEST_CASE("an elastic-plastic joint breaks at its rotation too", "[charpy]") {
    const Method method = GENERATE(from_range(elastic_methods));
    Scenario scenario;
    scenario.max_plastic_rotation = 1.5;
    const Result r = run(scenario, solvers.front(), method);
    INFO(to_string(method));
    CHECK(r.broken);
    CHECK(r.plastic_work == Approx(96).epsilon(0.005));
}

TEST_CASE("every method of the seed runs by name", "[charpy]") {
    for (const auto& [method, name] : method_names) {
        INFO(name);
        const Result r = run(Scenario{}, solvers.front(), method_of(name));
        CHECK(r.method == name);
        CHECK(std::isfinite(r.hammer_loss));
        CHECK(r.broken == (method == Method::zero_limits));
    }
    CHECK_THROWS_WITH(method_of("rubber"), Catch::Contains("rubber"));
}

TEST_CASE("the hammer's taper acts where the draft is short", "[charpy]") {
    // the edges behind the nose meet the bar where (thickness - nose)/2 tan φ > draft
    Scenario longer = in_frames(1e-4), shorter = longer, none = longer;
    shorter.nose_length = 0.004;
    none.nose_length = 0;
    Scenario thin = shorter;
    thin.hammer_thickness = 0.006;
    const Result a = run(longer, solvers.front()), b = run(shorter, solvers.front()),
                 c = run(none, solvers.front()), d = run(thin, solvers.front());
    for (const Result& r : {a, b, c, d}) {
        CHECK(r.plastic_work == Approx(122.016).epsilon(0.02));
    }
    // a wide flat is nearer the anvils: it turns the bar faster
    const auto time_to = [](const Result& r, double rotation) {
        for (const Sample& s : r.history) {
            if (std::abs(s.rotation) > rotation) return s.time;
        }
        return 1.0;
    };
    CHECK(time_to(c, 1.8) < 0.9 * time_to(a, 1.8));
    CHECK(time_to(b, 1.8) < 0.99 * time_to(a, 1.8));
    CHECK(time_to(d, 1.8) == Approx(time_to(a, 1.8)).epsilon(0.01));
}

TEST_CASE("a wider gap, a shallower notch and a thicker bar follow the mechanics", "[charpy]") {
    Scenario wide, shallow, narrow;
    wide.anvil_gap = 0.044;
    shallow.notch = 0.001;
    narrow.anvil_gap = 0.036;
    for (const Scenario& scenario : {wide, shallow, narrow}) {
        const Reference expected = reference(scenario);
        INFO("gap " << scenario.anvil_gap << ", notch " << scenario.notch);
        const Result r = run(scenario, solvers.front());
        CHECK(r.plastic_work == Approx(expected.plastic_work).epsilon(0.01));
    }
}

TEST_CASE("an engine refuses a solver it does not have", "[charpy]") {
    CHECK_THROWS_WITH(run(Scenario{}, "jacobi"), Catch::StartsWith("--solver = jacobi: must be "));
}
