// SPDX-License-Identifier: MIT
#include "ductile/world/leapfrog.hpp"

#include <catch2/catch.hpp>

#include <array>

using namespace ductile;

TEST_CASE("a constant force moves a body at rest by a t^2/2 in steps of any length", "[world]") {
    Leapfrog leapfrog;
    double x = 0, v = 0, t = 0;
    for (const double dt : {0.1, 0.01, 0.02, 0.5, 0.5, 1e-4}) {
        v += 3 * leapfrog.next(dt).value * dt;
        x += v * dt;
        t += dt;
        CHECK(x == Approx(1.5 * t * t).epsilon(1e-14));
    }
}

TEST_CASE("equal steps differ in the first one only, and after a restart", "[world]") {
    Leapfrog leapfrog;
    const std::array<double, 3> shares{leapfrog.next(0.1).value, leapfrog.next(0.1).value,
                                       leapfrog.next(0.1).value};
    CHECK(shares == std::array<double, 3>{0.5, 1, 1});
    leapfrog.restart();
    CHECK(leapfrog.next(0.1).value == 0.5);
    CHECK(leapfrog.next(0.1).value == 1);
}
