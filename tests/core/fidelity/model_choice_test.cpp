// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <optional>

#include "core/fidelity/oscillator.hpp"
#include "ductile/fidelity/model_choice.hpp"
#include "support/property.hpp"
#include "support/throws.hpp"

using namespace ductile;
using Catch::Matchers::Contains;
using ductile::test::elastic_plastic_peak;
using ductile::test::message_of;
using ductile::test::rigid_plastic_peak;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::size_t mx = 3;

/// A joint where only Mx has anything to do.
JointDetailParameters<double> only_bending(const AxisSystem<double>& system,
                                           const std::optional<AxisEvent<double>>& event,
                                           double tolerance) {
    JointDetailParameters<double> p;
    p.capacity.capacity.fill(1e6);
    p.capacity.stiffness.fill(1e9);
    p.mass.fill(1);
    p.event.fill(AxisEvent<double>{});
    p.dt = 1.0 / 60;
    p.tolerance = tolerance;
    p.capacity.capacity[mx] = system.strength;
    p.capacity.stiffness[mx] = system.stiffness;
    p.mass[mx] = system.mass;
    p.limit[mx] = system.limit;
    p.event[mx] = event;
    return p;
}

} // namespace

TEST_CASE("what does not yield is rigid at the longest step", "[model_choice]") {
    const auto model = choose_model(only_bending({.mass = 100, .stiffness = 4e4, .strength = 2000},
                                                 AxisEvent<double>{.held = 1500}, 0.01));
    CHECK(model.joint.detail() == AxisDetail::rigid);
    CHECK(model.dt == 1.0 / 60);
    CHECK(model.error == 0);
}

TEST_CASE("the step of a hard hit follows the tolerance", "[model_choice]") {
    // rigid: v dt/2 of the travel, here 0.5 s × 95 % of the tolerance
    for (const double tolerance : {0.03, 0.01}) {
        const auto model = choose_model(
            only_bending({.mass = 2, .strength = 40}, AxisEvent<double>{.speed = 10}, tolerance));
        CHECK(model.joint.axis[mx].detail == AxisDetail::rigid_plastic);
        CHECK(model.dt == Approx(0.5 * 0.95 * tolerance).epsilon(0.04));
        CHECK(model.error <= 0.95 * tolerance);
    }
    // a twentieth of it is left unused unless asked otherwise
    const auto all = choose_model(
        only_bending({.mass = 2, .strength = 40}, AxisEvent<double>{.speed = 10}, 0.01),
        {.reserve = 0.0});
    CHECK(all.dt == Approx(0.5 * 0.01).epsilon(0.04));
}

TEST_CASE("a joint that breaks needs no small step", "[model_choice]") {
    const auto model =
        choose_model(only_bending({.mass = 2, .stiffness = 1e4, .strength = 40, .limit = 1.3},
                                  AxisEvent<double>{.speed = 10}, 0.01));
    CHECK(model.joint.axis[mx].detail == AxisDetail::rigid_plastic);
    CHECK(model.dt == 1.0 / 60);
    // U_y = 0.08 J of 48 J that are left: half as much of the speed
    CHECK(model.error == Approx(0.08 / 48 / 2).epsilon(0.01));
}

TEST_CASE("the detail chosen keeps the tolerance and nothing cheaper does", "[model_choice]") {
    test::prop("any stiffness, hit and load", [] {
        const AxisSystem<double> system{.mass = 100,
                                        .stiffness = 4e4 * std::pow(10.0, *rc::gen::inRange(0, 3)),
                                        .strength = 2000};
        AxisSystem<double> rigid = system;
        rigid.stiffness = infinity;
        const AxisEvent<double> event{.speed = *rc::gen::inRange(24, 100) / 20.0,
                                      .load = *rc::gen::inRange(0, 36) * 40.0};
        const double tolerance = *rc::gen::element(0.1, 0.03, 0.01);
        const auto model = choose_model(only_bending(system, event, tolerance));
        const auto exact = peak_response(system, event);
        const auto error = [&](bool elastic, double dt) {
            const double peak = elastic ? elastic_plastic_peak(system, event, dt)
                                        : rigid_plastic_peak(rigid, event, dt);
            return std::abs(peak / exact.displacement - 1);
        };
        const bool elastic = model.joint.axis[mx].detail == AxisDetail::elastic_plastic;
        RC_ASSERT(model.joint.axis[mx].detail != AxisDetail::rigid);
        RC_ASSERT(error(elastic, model.dt) <= 0.95 * tolerance * (1 + 1e-9));
        RC_ASSERT(model.error <= 0.95 * tolerance);
        // the next longer step looked at does not keep it, or does not resolve the period
        const double longer = model.dt / 0.97;
        const double period = 2 * std::acos(-1.0) * std::sqrt(100 / system.stiffness);
        RC_ASSERT(longer > 1.0 / 60 || (elastic && period / longer < 12) ||
                  error(elastic, longer) > 0.95 * tolerance * (1 - 1e-9));
        // nor would the other detail bear so much longer a step that it is cheaper
        const auto other = choose_step(elastic ? rigid : system, event, exact, 0.95 * tolerance,
                                       std::min(1.0 / 60, elastic ? infinity : period / 12));
        RC_ASSERT((elastic ? model.dt > 1.3 * other.dt : model.dt * 1.3 >= other.dt));
    });
}

TEST_CASE("elasticity is left out once another axis asks for the shorter step", "[model_choice]") {
    // U_y/(E + U_y) = 2.4 %; to 10 % either detail will do, and the longer step goes with
    // elasticity
    const AxisSystem<double> soft{.mass = 0.5, .stiffness = 200, .strength = 10};
    auto p = only_bending(soft, AxisEvent<double>{.speed = std::sqrt(40.0)}, 0.05);
    p.dt = 0.1;
    CHECK(choose_model(p).joint.axis[mx].detail == AxisDetail::elastic_plastic);
    // a second axis stops in 0.02 s and needs dt < 1 ms
    p.capacity.capacity[4] = 100;
    p.capacity.stiffness[4] = infinity;
    p.mass[4] = 0.2;
    p.event[4] = AxisEvent<double>{.speed = 10};
    const auto both = choose_model(p);
    CHECK(both.dt == Approx(0.02 * 0.0475).epsilon(0.04));
    CHECK(both.joint.axis[mx].detail == AxisDetail::rigid_plastic);
    // and the step's own share of the 0.316 s that the first takes to stop
    CHECK(both.joint.axis[mx].error == Approx(0.25 / 10.25 + both.dt / 0.316).epsilon(0.02));
    CHECK_THAT(both.reason(),
               Contains("Mx rigid-plastic: elasticity changes the answer by 2.44 %"));
}

TEST_CASE("an event that is not known leaves the step and the error open", "[model_choice]") {
    const auto model =
        choose_model(only_bending({.mass = 0.5, .stiffness = 200, .strength = 10}, {}, 0.05));
    CHECK(model.dt == 1.0 / 60);
    CHECK(model.error == infinity);
}

TEST_CASE("a model choice refuses what it cannot decide on, by name", "[model_choice]") {
    auto p = only_bending({.mass = 1, .stiffness = 1, .strength = 1}, {}, 0.01);
    CHECK(message_of([&] { (void)choose_model(p, {.reserve = 1}); }) ==
          "Model.reserve = 1: must be in (0, 1)");
    CHECK(message_of([&] { (void)choose_model(p, {.elastic_cost = 0.5}); }) ==
          "Model.elastic_cost = 0.5: must be >= 1");
    p.limit[2] = 0;
    CHECK(message_of([&] { (void)choose_model(p); }) ==
          "JointDetail.Fz.limit = 0 m or rad: must be > 0 (infinity: no limit)");
}
