// SPDX-License-Identifier: MIT
#include "ductile/joint/remaining_travel.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

#include "ductile/fracture/energy_limit.hpp"
#include "ductile/fracture/softening_damage.hpp"

using namespace ductile;

TEST_CASE("the time to run a distance is that of constant deceleration", "[joint][break]") {
    // u = 3, at full strength d = 4: x(τ) = 3 τ - 2 τ²; the step ends at u' = u - s d dt
    const double dt = 0.5;
    for (const double share : {1.0, 0.25}) {
        const double end = 3 - share * 4 * dt;
        for (const double at : {0.01, 0.2, 0.4}) {
            const double distance = 3 * at - 2 * at * at;
            CHECK(time_to_run(distance, 3.0, end, share, dt) == Approx(at).epsilon(1e-14));
        }
    }
    // limit cases: at once, at constant speed, never within the step
    CHECK(time_to_run(0.0, 3.0, 1.0, 1.0, dt) == 0);
    CHECK(time_to_run(-1.0, 3.0, 1.0, 1.0, dt) == 0);
    CHECK(time_to_run(0.6, 3.0, 3.0, 1.0, dt) == Approx(0.2).epsilon(1e-14));
    CHECK(time_to_run(10.0, 3.0, 1.0, 1.0, dt) == dt);
}

TEST_CASE("a step that would use up more than is left gets the share that uses it up",
          "[joint][break]") {
    const double dt = 0.1;
    // not flowing: predicted with a stop within the step, 2 m/s × dt/2
    CHECK(travel_ahead(2.0, 2.0, 2.0, false, dt) == Approx(0.1).epsilon(1e-14));
    // flowing: with the deceleration of the last step, from 2 to 1.5 m/s
    CHECK(travel_ahead(2.0, 2.5, 2.0, true, dt) == Approx(0.175).epsilon(1e-14));
    // driven: the last step took 0.5 m/s, and somebody gave them back
    CHECK(travel_ahead(2.0, 2.0, 1.5, true, dt) == Approx(0.175).epsilon(1e-14));
    // one that stops in this step for all that is known, from 2 to 0
    CHECK(travel_ahead(2.0, 9.0, 2.0, true, dt) == Approx(0.1).epsilon(1e-14));

    CHECK(unspent_share(0.025, 0.1) == Approx(0.25).epsilon(1e-14));
    CHECK(unspent_share(0.1, 0.1) == 1);
    CHECK(unspent_share(0.2, 0.1) == 1);
}

TEST_CASE("what is left of an energy is the way that takes it, at a strength that grows on it",
          "[joint][break]") {
    // R = 10 + 30 p takes 8 J after 10 p + 15 p² = 8
    const EnergyLimit<double> limit({.limit = 8});
    const auto mean = [](double way) { return 10 + 15 * way; };
    const double way = (-10 + std::sqrt(100.0 + 4 * 15 * 8)) / 30;
    for (const double ahead : {1.2 * way, 3 * way}) {
        CHECK(travel_to_break(limit, {}, ahead, 1.0, mean) == Approx(way).epsilon(1e-7));
    }
    // what is beyond the step is told from all of the step
    CHECK(travel_to_break(limit, {}, way / 2, 1.0, mean) == Approx(8 / mean(way / 2)));
}

TEST_CASE("the way that takes a work is told from that at the strength foretold",
          "[joint][break]") {
    // R = 10 + 30 p, and 10 - 30 p until nothing is left of it
    for (const double slope : {30.0, -30.0}) {
        const double left = slope < 0 ? -10 / slope : std::numeric_limits<double>::infinity();
        const auto took = [&](double way) { return 10 * way + slope * way * way / 2; };
        const auto at = [&](double way) { return 10 + slope * way; };
        for (const double first : {0.05, 0.1, 0.15}) {
            CHECK(travel_of_work(took(0.1), first, left, took, at) == Approx(0.1).epsilon(1e-8));
        }
    }
    // more than there is ends it
    const auto took = [](double way) { return 10 * way; };
    const auto at = [](double) { return 10.0; };
    CHECK(travel_of_work(2.0, 0.05, 0.1, took, at) == 0.1);
}

TEST_CASE("the mean of a strength that damage takes is that of the way", "[joint][break]") {
    const SofteningDamage<double> damage({.onset = 1, .failure = 3});
    const auto mean = [&](double from, double travel) {
        return mean_factor(damage, {.travel = from}, travel, [](double) { return 7.0; });
    };
    CHECK(mean(0, 0.8) == 1);
    CHECK(mean(2, 0) == 0.5);
    CHECK(mean(1, 0.5) == Approx(0.875).epsilon(1e-14));
    CHECK(mean(1, 8) == Approx(1.0 / 8).epsilon(1e-3)); // nothing is left after 2
    // over the onset: 1 - 0.5²/(2 × 2)
    CHECK(mean(0.5, 1) == Approx(1 - 0.0625).epsilon(2e-4));
}

TEST_CASE("the mean of what damage leaves is weighted by the strength", "[joint][break]") {
    // both fall by the same way: ∫(1 - x)² over ∫(1 - x)
    const SofteningDamage<double> damage({.onset = 1, .failure = 3});
    const auto falls = [](double way) { return 2 - way; };
    CHECK(mean_factor(damage, {.travel = 1}, 2.0, falls) == Approx(2.0 / 3).epsilon(1e-14));
    const auto none = [](double) { return 0.0; };
    CHECK(mean_factor(damage, {.travel = 1}, 2.0, none) == 0);
}
