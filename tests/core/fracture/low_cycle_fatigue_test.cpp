// SPDX-License-Identifier: MIT
//
// Reference: P21g of tests/reference, and closed forms written out here.
#include <catch2/catch.hpp>
#include <cmath>
#include <rapidcheck/catch.h>
#include <vector>

#include "core/fracture/specimens.hpp"
#include "ductile/fracture/hinge_strain.hpp"
#include "support/throws.hpp"

using namespace ductile;
using namespace ductile::test;

namespace {

template <class S>
const CoffinManson<S> steel({.ductility_coefficient = 1, .ductility_exponent = S(-0.6)});

/// 1/2N_f of a half cycle with this range of strain.
double h(double range) { return std::pow(range / 2, 1 / 0.6); }
double range_of(double damage) { return 2 * std::pow(damage, 0.6); }

/// Reversals of constant amplitude in n steps each; the reversal that fails, from 1.
template <class C>
int failing_reversal(const C& criterion, double amplitude, int n) {
    using S = typename C::Scalar;
    Row row(criterion);
    for (int reversal = 1;; ++reversal) {
        const S sign = reversal % 2 ? S(1) : S(-1);
        for (int i = 0; i < n; ++i) {
            if (!row.flow(sign * S(2 * amplitude / n), S(40))) return reversal;
        }
    }
}

} // namespace

TEMPLATE_TEST_CASE("constant amplitude fails in the tabulated reversal, however the steps split",
                   "[fracture][P21]", float, double) {
    const LowCycleFatigue criterion(steel<TestType>, {.strain_per_travel = 1});
    for (const int n : {1, 7, 100}) {
        CHECK(failing_reversal(criterion, 0.2, n) == 15);
        CHECK(failing_reversal(criterion, 0.1, n) == 47);
        CHECK(failing_reversal(criterion, 0.05, n) == 148);
    }
    // the paperclip of P21b: 2N_f = 29.63 and 9.33
    const auto k =
        hinge_strain<TestType>({.height = TestType(1e-3), .hinge_length = TestType(3e-3)});
    const LowCycleFatigue paperclip(steel<TestType>, {.strain_per_travel = k});
    CHECK(failing_reversal(paperclip, std::acos(0.0) / 2, 5) == 30);
    CHECK(failing_reversal(paperclip, std::acos(0.0), 5) == 10);
}

TEST_CASE("the failing reversal breaks at the range its share of life allows", "[fracture]") {
    const LowCycleFatigue criterion(steel<double>, {.strain_per_travel = 0.5});
    for (const int n : {1, 3, 50}) {
        Row row(criterion);
        // range of travel 0.8 is a range of strain of 0.4
        for (int i = 0;; ++i) {
            const double sign = (i / n) % 2 ? -1 : 1;
            if (!row.flow(sign * 0.8 / n, 40)) break;
        }
        const double last = range_of(1 - 14 * h(0.4)) / 0.5;
        CHECK(row.travel == Approx(14 * 0.8 + last).epsilon(1e-12));
        CHECK(row.work == Approx(40 * row.travel).epsilon(1e-12));
    }
}

TEST_CASE("a monotonic overload breaks where its half cycle has a life of one reversal",
          "[fracture]") {
    const LowCycleFatigue criterion(steel<double>, {.strain_per_travel = 0.5});
    CHECK(criterion.first_range() == Approx(4).epsilon(1e-15));
    CHECK(criterion.remaining({}, 40) == criterion.first_range());
    CHECK(criterion.remaining({}, 40, -1) == criterion.first_range());
    Row row(criterion);
    while (row.flow(0.03, 40)) {
        CHECK(criterion.damage(row.state) == Approx(h(row.travel / 2)).epsilon(1e-13));
        CHECK(criterion.remaining(row.state, 40, 1) == Approx(4 - row.travel).margin(4e-13));
    }
    CHECK(row.travel == Approx(4).epsilon(1e-13));
}

TEST_CASE("what remains looks through the loops that close on the way", "[fracture]") {
    const LowCycleFatigue criterion(steel<double>, {.strain_per_travel = 1});
    Row row(criterion);
    for (const double step : {1.0, -0.3, 0.2, -0.1}) REQUIRE(row.flow(step, 40));
    // onwards and up: loops of 0.1 and 0.3 close, then the first half cycle runs on from 1
    const double up = range_of(1 - 2 * h(0.1) - 2 * h(0.3)) - 1 + 0.1 + 0.1;
    CHECK(criterion.remaining(row.state, 40, 1) == Approx(up).epsilon(1e-13));
    // and down: the loop of 0.2 closes, then the half cycle from 1 down passes 0.3 and the start
    // at a range of 1, where the half cycle of 1 is settled
    const double down = range_of(1 - 2 * h(0.2) - h(1)) - 0.2;
    CHECK(criterion.remaining(row.state, 40, -1) == Approx(down).epsilon(1e-13));
    CHECK(criterion.remaining(row.state, 40) == Approx(std::min(up, down)).epsilon(1e-13));
}

TEST_CASE("damage of a nested history is the sum over its loops", "[fracture]") {
    const LowCycleFatigue criterion(steel<double>, {.strain_per_travel = 1});
    Row row(criterion);
    for (const double step : {0.5, -0.3, 0.2, -0.1, 0.3, -0.3, 0.7, -1.0}) row.flow(step, 40);
    CHECK(criterion.damage(row.state) ==
          Approx(2 * h(0.1) + 2 * h(0.3) + 2 * h(0.3) + 2 * h(1)).epsilon(1e-13));
    // without the nested loops it would be a third less
    CHECK(2 * h(1) < criterion.damage(row.state) * 0.8);
}

TEMPLATE_TEST_CASE("damage does not fall by an ulp where a loop closes", "[fracture]", float,
                   double) {
    const LowCycleFatigue criterion(steel<TestType>, {.strain_per_travel = 1});
    Row row(criterion);
    row.flow(TestType(0.5), 40);
    TestType range = TestType(0.02);
    bool monotone = true;
    for (int i = 0; i < 3000; ++i) {
        range *= TestType(0.998);
        row.flow(-range, 40);
        row.flow(std::nextafter(range, TestType(0)), 40);
        const TestType before = criterion.damage(row.state);
        row.flow(range - std::nextafter(range, TestType(0)), 40);
        monotone = monotone && criterion.damage(row.state) >= before;
    }
    REQUIRE_FALSE(criterion.broken(row.state));
    CHECK(row.state.rainflow.depth() == 0); // every loop has closed
    CHECK(monotone);
}

TEST_CASE("a float joint counts a million small cycles", "[fracture]") {
    // amplitude 2.5e-4 lasts about a million reversals, each less than one ulp of the sum at its
    // end
    const LowCycleFatigue criterion(steel<float>, {.strain_per_travel = 1});
    const double life = steel<double>.reversals(2.5e-4);
    CHECK(life > 0.99e6);
    CHECK(failing_reversal(criterion, 2.5e-4, 1) == Approx(life).epsilon(2e-5));
}

TEST_CASE("damage does not depend on how an increment is split", "[fracture]") {
    rc::prop("any history, any split", [](const std::vector<signed char>& raw) {
        const LowCycleFatigue criterion(steel<double>, {.strain_per_travel = 1});
        const int n = *rc::gen::inRange(2, 9);
        Row whole(criterion);
        Row split(criterion);
        for (const signed char r : raw) {
            const double step = r / 1000.0;
            if (criterion.damage(whole.state) > 0.99) break;
            whole.flow(step, 40);
            for (int i = 0; i < n; ++i) split.flow(step / n, 40);
            RC_ASSERT(std::abs(criterion.damage(whole.state) - criterion.damage(split.state)) <
                      1e-12);
        }
    });
}

TEST_CASE("a full stack of open ranges is on the safe side", "[fracture]") {
    rc::prop("a criterion with a small stack breaks no later",
             [](const std::vector<signed char>& raw) {
                 const LowCycleFatigue<CoffinManson<double>, 2> shallow(steel<double>,
                                                                        {.strain_per_travel = 1});
                 const LowCycleFatigue<CoffinManson<double>, 200> deep(steel<double>,
                                                                       {.strain_per_travel = 1});
                 Row a(shallow);
                 Row b(deep);
                 for (const signed char step : raw) {
                     a.flow(step / 500.0, 40);
                     b.flow(step / 500.0, 40);
                     RC_ASSERT(shallow.damage(a.state) >= deep.damage(b.state) - 1e-12);
                 }
             });
}

TEST_CASE("a turn that a full stack cannot afford breaks with the first flow after it",
          "[fracture]") {
    const LowCycleFatigue<CoffinManson<double>, 2> criterion(steel<double>,
                                                             {.strain_per_travel = 1});
    Row row(criterion);
    for (const double step : {1.0, -0.95, 0.1}) REQUIRE(row.flow(step, 40));
    // one more turn settles the range of 0.95 as a whole cycle
    REQUIRE(h(1) + 2 * h(0.95) + h(0.85) > 1);
    CHECK(criterion.remaining(row.state, 40, 1) > 0.1);
    const double left = criterion.remaining(row.state, 40, -1);
    CHECK(left > 0);
    CHECK(left < 1e-14);
    CHECK_FALSE(row.flow(-0.1, 40));
}

TEST_CASE("low-cycle fatigue names the parameter that is missing or out of range", "[fracture]") {
    CHECK(message_of([] { LowCycleFatigue(steel<double>, {}); }) ==
          "LowCycleFatigue.strain_per_travel = nan 1/rad or 1/m: must be finite and > 0");
    CHECK(message_of([] { LowCycleFatigue(steel<float>, {.strain_per_travel = -2}); }) ==
          "LowCycleFatigue.strain_per_travel = -2 1/rad or 1/m: must be finite and > 0");
}
