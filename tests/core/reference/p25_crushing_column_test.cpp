// SPDX-License-Identifier: MIT
//
// P25. A mass dropped on a crushing column, from the speed it shares with the column's head:
// crushed to rest, and broken on the way.
#include <catch2/catch.hpp>

#include <cmath>

#include "reference/expect.hpp"
#include "reference/problems/rotors.hpp"

using namespace ductile::reference;

TEST_CASE("P25a a dropped mass is stopped by the crushing column", "[reference][P25]") {
    expect_trends("P25a", p25_crush);
    const std::vector<Quantity> q = p25_crush(1.0 / 240);
    CHECK(q[0].exact == Approx(0.362461412).epsilon(1e-8));
    CHECK(q[2].exact == Approx(10873.8424).epsilon(1e-8));
    CHECK(q[3].exact == Approx(0.12729752).epsilon(1e-7));
}

TEST_CASE("P25a the crush is the exact discrete one at any step", "[reference][P25]") {
    const Weight weight = dropped();
    CHECK(weight.speed == Approx(5.69471264).epsilon(1e-8));
    for (const double dt : {1.0 / 30, 1.0 / 240, 1e-3}) {
        const double a = weight.deceleration(), n = std::floor(weight.speed / (a * dt));
        const double crushed = dt * (n * weight.speed - a * dt * n * (n + 1) / 2);
        CHECK(crush(weight, dt).fall == Approx(crushed).epsilon(1e-9));
    }
    CHECK(crush(weight, 1.0 / 240).fall == Approx(0.3506935).epsilon(3e-7));
}

TEST_CASE("P25a the ledger closes to round-off at any step", "[reference][P25]") {
    const Weight weight = dropped();
    for (const double dt : {1.0 / 15, 1.0 / 60, 1e-3}) {
        const WeightEnd end = crush(weight, dt);
        const double given = weight.mass * weight.speed * weight.speed / 2 + end.supplied;
        CHECK(end.joint.plastic_work + end.joint.other_work == Approx(given).epsilon(1e-12));
    }
}

TEST_CASE("P25b the column breaks at 0.3 m with the work of 0.3 m", "[reference][P25]") {
    expect_trends("P25b", p25_break);
    const std::vector<Quantity> q = p25_break(1e-4);
    CHECK(q[0].exact == Approx(2.36399648).epsilon(1e-8));
    CHECK(q[2].exact == Approx(0.07445361).epsilon(1e-6));
}
