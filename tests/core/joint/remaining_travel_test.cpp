// SPDX-License-Identifier: MIT
#include "ductile/joint/remaining_travel.hpp"

#include <catch2/catch.hpp>

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
