// SPDX-License-Identifier: MIT
//
// The Charpy test of every engine build against the mechanics of its one-degree-of-freedom mechanism.
// Frictionless; the hammer's inertia is 22.804 kg m², so expected: 122.016 J plastic, 122.716 J lost.
#include <catch2/catch.hpp>

#include <algorithm>
#include <string>
#include <vector>

#include "drive.hpp"
#include "reference.hpp"

#ifdef CHARPY_ODE
#include "ode_scene.hpp"
using Scene = charpy::OdeScene;
static const std::vector<std::string> solvers{"direct", "quick"};
#else
#include "bullet_scene.hpp"
using Scene = charpy::BulletScene;
static const std::vector<std::string> solvers{"mlcp", "si"};
#endif

using namespace charpy;

namespace {

constexpr bool single = Scene::precision == "float";

/// In single precision Bullet's direct solver gives up on many steps and falls back to its iterative
/// one: energies are then off by some per cent, and the certificate says so, which a test below asks
/// for. Bounds meant for a converged solve do not apply to it.
constexpr bool converges = !single;

Result run(const Scenario& scenario, const std::string& solver,
           Method method = Method::plastic_hinge) {
    return drive<Scene>(scenario, method, solver);
}

Scenario fixed(double dt) {
    Scenario s;
    s.adaptive = false;
    s.dt = dt;
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

TEST_CASE("with adaptive steps the energies are right in fewer than 1500 steps", "[charpy]") {
    const std::string solver = GENERATE(from_range(solvers));
    INFO(solver);
    const Scenario scenario;
    const Result r = run(scenario, solver);
    const Reference expected = reference(scenario);
    CHECK(r.strike_speed == Approx(expected.strike_speed).epsilon(1e-3));
    CHECK(r.plastic_work == Approx(expected.plastic_work).epsilon(0.01));
    CHECK(r.hammer_loss == Approx(expected.hammer_loss).epsilon(0.02));
    CHECK(r.steps < 1500);
    CHECK_FALSE(r.broken);
    CHECK(std::abs(r.unexplained) < (single ? 1e-2 : 1e-3));
    if (solver == solvers.front() && converges) CHECK(r.unreliable_steps == 0);
}

TEST_CASE("what is wrong is never silent", "[charpy]") {
    const double dt = GENERATE(2e-4, 1e-4, 0.99e-4, 0.8e-4, 0.5e-4);
    const int parts = GENERATE(2, 4);
    const std::string solver = GENERATE(from_range(solvers));
    INFO(solver << ", dt = " << dt << ", parts " << parts);
    Scenario scenario = fixed(dt);
    scenario.parts = parts;
    const Result r = run(scenario, solver);
    INFO("plastic work " << r.plastic_work << ", steps not converged " << r.unreliable_steps);
    const bool wrong = std::abs(r.plastic_work / 122.016 - 1) > 0.02;
    CHECK((!wrong || r.unreliable_steps > 0));
}

TEST_CASE("plastic work does not scatter over the seed's five steps", "[charpy]") {
    if (!converges) return;
    // where the seed's own energies were 100, 110, 90, 130 and 150 J
    std::vector<double> work;
    for (const double dt : {1.001e-4, 1e-4, 0.99e-4, 0.8e-4, 0.5e-4}) {
        const Result r = run(fixed(dt), solvers.front());
        work.push_back(r.plastic_work);
        CHECK(r.plastic_work == Approx(122.016).epsilon(0.02));
    }
    const auto [low, high] = std::minmax_element(work.begin(), work.end());
    CHECK(*high - *low < 0.015 * 122.016);
}

TEST_CASE("at small steps the hammer loses what hinge and halves take", "[charpy]") {
    const double dt = GENERATE(2e-5, 1e-5);
    const Result r = run(fixed(dt), solvers.front());
    INFO("dt = " << dt);
    CHECK(r.hammer_loss == Approx(r.plastic_work + r.specimen_kinetic).epsilon(0.01));
}

TEST_CASE("a break at 1.5 rad takes 96 J at every step", "[charpy]") {
    const double longest = converges ? 1e-3 : 5e-4;
    Scenario scenario = fixed(GENERATE(2e-5, 5e-5, 1e-4, 2e-4, 5e-4, 1e-3));
    if (scenario.dt > longest) return;
    scenario.max_plastic_rotation = 1.5;
    const Result r = run(scenario, solvers.front());
    INFO("dt = " << scenario.dt);
    CHECK(r.broken);
    CHECK(r.plastic_work == Approx(96).epsilon(0.005));
    CHECK(r.plastic_rotation == Approx(1.5));
}

TEST_CASE("friction takes more and is booked as friction", "[charpy]") {
    Scenario scenario;
    const Result without = run(scenario, solvers.front());
    scenario.friction = 0.3;
    const Result with = run(scenario, solvers.front());
    CHECK(with.friction_work > 10);
    const double work = converges ? 0.01 : 0.02, share = converges ? 0.05 : 0.1;
    CHECK(with.plastic_work == Approx(without.plastic_work).epsilon(work));
    CHECK(with.hammer_loss - without.hammer_loss == Approx(with.friction_work).epsilon(share));
}

TEST_CASE("a specimen without a hinge stops the hammer", "[charpy]") {
    const Result r = run(Scenario{}, solvers.front(), Method::rigid);
    CHECK(r.hammer_loss == Approx(291.0995).epsilon(0.005));
    CHECK(r.contact_work == Approx(291.0995).epsilon(0.005));
}

TEST_CASE("twice the yield stress takes twice the energy", "[charpy]") {
    Scenario scenario;
    scenario.yield_stress = 800e6;
    const Result r = run(scenario, solvers.front());
    CHECK(r.plastic_work == Approx(reference(scenario).plastic_work).epsilon(0.01));
    CHECK(r.hammer_loss == Approx(reference(scenario).hammer_loss).epsilon(0.02));
}

TEST_CASE("an engine refuses a solver it does not have", "[charpy]") {
    CHECK_THROWS_WITH(run(Scenario{}, "jacobi"), Catch::StartsWith("--solver = jacobi: must be "));
}
