// SPDX-License-Identifier: MIT
//
// Travel limit, energy limit, brittle force and softening damage.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "core/fracture/specimens.hpp"
#include "support/throws.hpp"

using namespace ductile;
using namespace ductile::test;

namespace {
template <class S>
constexpr S infinity = std::numeric_limits<S>::infinity();
}

TEMPLATE_TEST_CASE("a travel limit leaves what has not been used", "[fracture]", float, double) {
    const TravelLimit<TestType> limit({.limit = TestType(1.6)});
    CHECK(limit.remaining(TestType(0.6)) == TestType(1.6) - TestType(0.6));
    CHECK(limit.remaining(TestType(2)) == 0);
    CHECK(limit.remaining({.travel = TestType(0.6)}, 40) == limit.remaining(TestType(0.6)));
    CHECK(limit.damage({.travel = TestType(0.4)}) == Approx(0.25));
    CHECK(limit.force_cap(typename TravelLimit<TestType>::State{}) == infinity<TestType>);
    CHECK(limit.strength_factor(typename TravelLimit<TestType>::State{}) == 1);
    const TravelLimit<TestType> none;
    CHECK(none.remaining(TestType(1e30)) == infinity<TestType>);
    CHECK(none.damage({.travel = TestType(1e30)}) == 0);
    CHECK_FALSE(none.broken({.travel = TestType(1e30)}));
    // flow in both directions counts: 0.9 there and 0.7 back
    Row row(limit);
    CHECK(row.flow(TestType(0.9), 40));
    CHECK_FALSE(row.flow(TestType(-0.7), 40));
}

TEMPLATE_TEST_CASE("an energy limit is met exactly, at any and at changing strength", "[fracture]",
                   float, double) {
    const EnergyLimit<TestType> limit({.limit = 64});
    for (const TestType step : {TestType(5), TestType(0.3), TestType(0.001)}) {
        Row row(limit);
        TestType strength = 20;
        while (row.flow(step, strength)) strength += TestType(0.25) * step;
        CHECK(row.state.work.value() == Approx(64).epsilon(32 * exhausted_share<TestType>));
    }
    CHECK(limit.remaining({}, 40) == TestType(64) / 40);
    CHECK(limit.remaining({}, 0) == infinity<TestType>);
    CHECK(EnergyLimit<TestType>({.limit = infinity<TestType>}).remaining({}, 40) ==
          infinity<TestType>);
}

TEMPLATE_TEST_CASE("a brittle joint breaks at its force, without flow, and not below", "[fracture]",
                   float, double) {
    const BrittleForce<TestType> weld({.limit = 500});
    typename BrittleForce<TestType>::State state;
    CHECK(weld.force_cap(state) == 500);
    CHECK(weld.remaining(state, 100) == infinity<TestType>);
    for (int i = 0; i < 1000; ++i) weld.update(state, {.force = i % 2 ? TestType(499) : -499});
    CHECK(state == decltype(state){});
    weld.update(state, {.force = -500});
    CHECK(weld.broken(state));
    CHECK(weld.damage(state) == 1);
    CHECK(weld.force_cap(state) == 0);
    CHECK(weld.remaining(state, 100) == 0);
    weld.update(state, {.force = 0});
    CHECK(weld.broken(state));
}

TEST_CASE("a brittle joint may break under one sign of the force only", "[fracture]") {
    const BrittleForce<double> weld({.limit = 500, .sign = BreakingSign::negative});
    CHECK(weld.force_cap({}, -1) == 500);
    CHECK(weld.force_cap({}, 1) == infinity<double>);
    CHECK(weld.force_cap({}) == 500);
    BrittleForce<double>::State state;
    weld.update(state, {.force = 1e9});
    CHECK_FALSE(weld.broken(state));
    weld.update(state, {.force = -500 * (1 - 1e-6)}); // round-off of λ/dt in float
    CHECK(weld.broken(state));
}

TEMPLATE_TEST_CASE("linear softening takes the strength from onset to failure to nothing",
                   "[fracture]", float, double) {
    const SofteningDamage<TestType> damage({.onset = TestType(0.5), .failure = TestType(1.5)});
    const double eps = std::numeric_limits<TestType>::epsilon();
    CHECK(damage.strength_factor({}) == 1);
    CHECK(damage.strength_factor({.travel = TestType(0.5)}) == 1);
    CHECK(damage.strength_factor({.travel = TestType(0.75)}) == Approx(0.75).epsilon(4 * eps));
    CHECK(damage.strength_factor({.travel = TestType(0.5)}, TestType(0.25)) ==
          Approx(0.75).epsilon(4 * eps));
    CHECK(damage.strength_factor({.travel = TestType(1.5)}) == 0);
    CHECK(damage.strength_factor({.travel = TestType(3)}) == 0);
    CHECK(damage.remaining({.travel = TestType(0.5)}, 40) == 1);
    // R (p_onset + p_failure)/2 = 40 J, exact with midpoint steps that meet the onset
    for (const int n : {2, 10, 1000}) {
        Row row(damage);
        const TestType step = 1 / TestType(n);
        bool intact = true;
        while (intact) {
            intact = row.flow(step, 40 * damage.strength_factor(row.state, step / 2));
        }
        CHECK(row.work == Approx(40).epsilon(8 * n * eps));
    }
}

TEST_CASE("softening runs straight between given pairs", "[fracture]") {
    const std::array<DamagePoint<double>, 4> pairs{{{1, 0}, {2, 0.5}, {4, 0.5}, {5, 1}}};
    const SofteningDamage<double> damage{std::span<const DamagePoint<double>>(pairs)};
    CHECK(damage.onset() == 1);
    CHECK(damage.failure() == 5);
    const double expected[][2] = {{0, 0},   {1, 0},      {1.5, 0.25}, {2, 0.5}, {3, 0.5},
                                  {4, 0.5}, {4.5, 0.75}, {5, 1},      {9, 1}};
    for (const auto& [travel, d] : expected) {
        CHECK(damage.damage_at(travel) == d);
        CHECK(damage.strength_factor({.travel = travel}) == 1 - d);
    }
    // two pairs are the linear form
    const std::array<DamagePoint<double>, 2> two{{{0.5, 0}, {1.5, 1}}};
    const SofteningDamage<double> by_pairs{std::span<const DamagePoint<double>>(two)};
    const SofteningDamage<double> linear({.onset = 0.5, .failure = 1.5});
    for (double p = 0; p < 2; p += 0.01) CHECK(by_pairs.damage_at(p) == linear.damage_at(p));
}

TEST_CASE("limits name the parameter that is missing or out of range", "[fracture]") {
    CHECK(message_of([] { TravelLimit<double>(TravelLimitParameters<double>{}); }) ==
          "TravelLimit.limit = nan m or rad: must be > 0 (infinity: no limit)");
    CHECK(message_of([] { EnergyLimit<double>({}); }) ==
          "EnergyLimit.limit = nan J: must be > 0 (infinity: no limit)");
    CHECK(message_of([] { EnergyLimit<double>({.limit = -3}); }) ==
          "EnergyLimit.limit = -3 J: must be > 0 (infinity: no limit)");
    CHECK(message_of([] { BrittleForce<double>({.limit = 0}); }) ==
          "BrittleForce.limit = 0 N or N m: must be > 0 (infinity: no limit)");
    CHECK(message_of([] { SofteningDamage<double>({.failure = 1}); }) ==
          "SofteningDamage.onset = nan m or rad: must be finite and >= 0");
    CHECK(message_of([] { SofteningDamage<double>({.onset = 1}); }) ==
          "SofteningDamage.failure = nan m or rad: must be finite and > 0");
    CHECK(message_of([] { SofteningDamage<double>({.onset = 1, .failure = 1}); }) ==
          "SofteningDamage.failure = 1 m or rad: must be greater than onset");
    using Points = std::vector<DamagePoint<double>>;
    const auto message = [](const Points& points) {
        return message_of(
            [&] { SofteningDamage<double>{std::span<const DamagePoint<double>>(points)}; });
    };
    CHECK(message({{1, 0}}) == "SofteningDamage.points = 1 pairs: must be in [2, 8] pairs");
    CHECK(message(Points(9)) == "SofteningDamage.points = 9 pairs: must be in [2, 8] pairs");
    CHECK(message({{-1, 0}, {2, 1}}) ==
          "SofteningDamage.points[0].travel = -1 m or rad: must be finite and >= 0");
    CHECK(
        message({{1, 0}, {1, 1}}) ==
        "SofteningDamage.points[1].travel = 1 m or rad: must be greater than the travel before it");
    CHECK(message({{1, 0.1}, {2, 1}}) ==
          "SofteningDamage.points[0].damage = 0.1: must be 0 at the onset");
    CHECK(message({{1, 0}, {2, 0.9}}) ==
          "SofteningDamage.points[1].damage = 0.9: must be 1 at the failure");
    CHECK(message({{1, 0}, {2, 0.5}, {3, 0.4}, {4, 1}}) ==
          "SofteningDamage.points[2].damage = 0.4: must be at least the damage before it and < 1");
    CHECK(message({{1, 0}, {2, 1}, {3, 1}}) ==
          "SofteningDamage.points[1].damage = 1: must be at least the damage before it and < 1");
}
