// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ductile/vocabulary/symmetric_row.hpp"
#include "support/property.hpp"

using namespace ductile;

namespace {

double number(int lo, int hi) { return *rc::gen::inRange(lo * 1000, hi * 1000) / 1000.0; }

struct Solved {
    double force, velocity; // λ/dt and u'
};

/// The core's row on a mass m at speed u with nothing else: u' = u + λ/m.
Solved solve(const RowLimits<double>& row, double mass, double u, double dt) {
    const double free = (row.bias - u) / (1 / mass + row.compliance);
    const double impulse = std::clamp(free, row.lower * dt, row.upper * dt);
    return {impulse / dt, u + impulse / mass};
}

/// The engine's, with the centre applied from outside.
Solved solve(const SymmetricRow& row, double mass, double u, double dt) {
    const double pushed = u + row.centre * dt / mass;
    const double free = (row.velocity - pushed) / (dt / mass + row.cfm);
    const double force = std::clamp(free, -row.strength, row.strength);
    return {force + row.centre, pushed + force * dt / mass};
}

} // namespace

TEST_CASE("a symmetric row and its centre do what the core's row does", "[symmetric_row]") {
    test::prop("any bounds, target, compliance, mass, speed and step", [] {
        const double one = number(-50, 50), other = number(-50, 50);
        const RowLimits<double> row{.lower = std::min(one, other),
                                    .upper = std::max(one, other),
                                    .bias = number(-3, 3),
                                    .compliance = *rc::gen::element(0.0, number(0, 5))};
        const double mass = number(1, 20), u = number(-10, 10), dt = 1 / number(10, 1000);
        const Solved wanted = solve(row, mass, u, dt);
        const Solved got = solve(symmetric_row(row, dt), mass, u, dt);
        RC_ASSERT(std::abs(got.force - wanted.force) < 1e-10 * (1 + std::abs(wanted.force)));
        RC_ASSERT(std::abs(got.velocity - wanted.velocity) <
                  1e-12 * (1 + std::abs(wanted.velocity)));
    });
}

TEST_CASE("a row without bounds has no centre and any strength", "[symmetric_row]") {
    const SymmetricRow row = symmetric_row({.bias = 2, .compliance = 3}, 0.1);
    CHECK(row.centre == 0);
    CHECK(row.strength == std::numeric_limits<double>::infinity());
    CHECK(row.velocity == 2);
    CHECK(row.cfm == Approx(0.3));
    // nor has one that is bounded one way only: a symmetric row cannot say that bound
    CHECK(symmetric_row({.lower = -5}, 0.1).centre == 0);
}

TEST_CASE("bounds that are equal leave a given force and no row", "[symmetric_row]") {
    const SymmetricRow row = symmetric_row({.lower = 7, .upper = 7}, 0.1);
    CHECK(row.centre == 7);
    CHECK(row.strength == 0);
}

TEST_CASE("equal strength both ways needs no force from outside", "[symmetric_row]") {
    const SymmetricRow row = symmetric_row({.lower = -7, .upper = 7, .bias = 1}, 0.1);
    CHECK(row.centre == 0);
    CHECK(row.strength == 7);
    CHECK(row.velocity == 1);
}
