// SPDX-License-Identifier: MIT
//
// P24. A column that leans or falls (P-Δ): critical speed, static push, and the same with an
// elastic hinge.
#include <catch2/catch.hpp>

#include <cmath>

#include "reference/expect.hpp"
#include "reference/problems/pendulum.hpp"

using namespace ductile::reference;

namespace {

/// Column at rest at `theta`, its hinge having flowed there, under a horizontal push at its top.
double rate_under_push(double theta, double force) {
    const Column column;
    World<double> world;
    auto joint = column.hinge();
    const int base = world.add_degree(column.inertia());
    world.add_row({{base}}, joint);
    world.displacement()[base] = theta;
    auto state = joint.state();
    state.plastic_offset = theta;
    joint.restore(state);
    const double moment = force * column.length * std::cos(theta) + column.weight_moment(theta);
    for (int i = 0; i < 20; ++i) world.step(1e-3, Vector<double>::Constant(1, moment));
    return world.velocity()[base];
}

} // namespace

TEST_CASE("P24a the critical state is where the weight's moment is the hinge's",
          "[reference][P24]") {
    const Column column;
    CHECK(column.weight_moment(0.205313002) == Approx(column.plastic_moment).epsilon(1e-8));
    const double energy = column.plastic_moment * 0.205313002 - column.mass * column.gravity *
                                                                    column.length *
                                                                    (1 - std::cos(0.205313002));
    CHECK(std::sqrt(2 * energy / column.inertia()) == Approx(critical_speed).epsilon(1e-8));
}

TEST_CASE("P24a below the critical speed the column stops and leans", "[reference][P24]") {
    expect_trends("P24a, 0.9",
                  [](double dt) { return p24_stops(0.9, 0.115589856, 0.8174509, dt); });
    expect_trends("P24a, 0.99",
                  [](double dt) { return p24_stops(0.99, 0.176223625, 1.472913, dt); });
    // engine figures at 1/240 s
    CHECK(swing({}, 0.9 * critical_speed, 1.0 / 240).angle == Approx(0.1140096).epsilon(4e-7));
    CHECK(swing({}, 0.99 * critical_speed, 1.0 / 240).angle == Approx(0.1712185).epsilon(4e-7));
}

TEST_CASE("P24a above the critical speed the column falls", "[reference][P24]") {
    expect_trends("P24a, 1.01", [](double dt) { return p24_falls(1.01, 2.1412003, 4.061807, dt); });
    expect_trends("P24a, 1.1", [](double dt) { return p24_falls(1.1, 2.14724, 2.773873, dt); });
}

TEST_CASE("P24a a leaning column holds against a push up to its static limit", "[reference][P24]") {
    // F = (M_p - W L sin θ)/(L cos θ)
    for (const auto& [theta, force] :
         {std::pair{0.05, 1511.593}, std::pair{0.1, 1025.759}, std::pair{0.2, 52.09224}}) {
        INFO("θ = " << theta);
        CHECK(std::abs(rate_under_push(theta, 0.999 * force)) < 1e-12);
        CHECK(rate_under_push(theta, 1.001 * force) > 1e-7);
    }
}

TEST_CASE("P24b with an elastic hinge the column stops earlier and springs back",
          "[reference][P24]") {
    expect_trends("P24b", p24_elastic);
    const Column column{.stiffness = 150e3};
    CHECK(swing(column, 0.999 * 0.331248878, 1e-3).angle < 0.2);
    CHECK(swing(column, 1.001 * 0.331248878, 1e-3).angle > 1.5);
}

TEST_CASE("P24b damped, the column comes to rest in its final lean", "[reference][P24]") {
    // k (θ - θ_p) = m g L sin θ with the plastic rotation of the first swing
    const Column column{.stiffness = 150e3};
    World<double> world;
    auto joint = column.hinge();
    const int base = world.add_degree(column.inertia());
    world.add_row({{base}}, joint);
    world.velocity()[base] = 0.9 * 0.331248878;
    const double dt = 1e-3, damping = 20e3; // [N m s/rad], from the first turn on
    bool turned = false;
    for (int i = 0; i < 20000; ++i) {
        const double rate = world.velocity()[base];
        turned = turned || rate < 0;
        const double moment =
            column.weight_moment(world.displacement()[base]) - (turned ? damping * rate : 0.0);
        world.step(dt, Vector<double>::Constant(1, moment));
    }
    CHECK(world.displacement()[base] == Approx(0.10547248).epsilon(1e-4));
    CHECK(std::abs(world.velocity()[base]) < 1e-9);
}

TEST_CASE("P24b the static push peaks where the hinge yields", "[reference][P24]") {
    // driven slowly: F = (M - W L sin θ)/(L cos θ), peak 1608.992 N at M_p/k = 0.04 rad
    const Column column{.stiffness = 150e3};
    World<double> world;
    auto joint = column.hinge();
    const int base = world.add_degree(column.inertia());
    const std::size_t hinge = world.add_row({{base}}, joint);
    const double dt = 1e-3, rate = 0.1;
    world.drive(world.add_rigid_row({{base}}), rate);
    double peak = 0, at = 0;
    for (int i = 0; i < 1000; ++i) {
        const double theta = world.displacement()[base]; // where a resolved spring takes its force
        world.step(dt);
        const double force = (-world.reaction(hinge).force - column.weight_moment(theta)) /
                             (column.length * std::cos(theta));
        if (force > peak) {
            peak = force;
            at = theta;
        }
    }
    CHECK(at == Approx(0.04).epsilon(1e-9));
    CHECK(peak == Approx(1608.992).epsilon(1e-6));
}
