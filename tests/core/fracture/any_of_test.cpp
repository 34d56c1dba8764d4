// SPDX-License-Identifier: MIT
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <rapidcheck/catch.h>
#include <string>
#include <tuple>
#include <vector>

#include "core/fracture/specimens.hpp"

using namespace ductile;
using namespace ductile::test;

namespace {

const CoffinManson<double> steel({.ductility_coefficient = 1, .ductility_exponent = -0.6});

} // namespace

TEST_CASE("any-of breaks with the earliest of its members and names it", "[fracture]") {
    rc::prop("any limits, any history, clipped or overshooting",
             [](const std::vector<signed char>& raw) {
                 const auto real = [](int low, int high) {
                     return *rc::gen::inRange(low, high) / 100.0;
                 };
                 const TravelLimit<double> travel({.limit = real(50, 400)});
                 const EnergyLimit<double> energy({.limit = 40 * real(50, 400)});
                 const LowCycleFatigue fatigue(steel, {.strain_per_travel = real(50, 200)});
                 const AnyOf any(travel, energy, fatigue);
                 const bool clip = *rc::gen::arbitrary<bool>();

                 Row together(any);
                 Row alone_travel(travel);
                 Row alone_energy(energy);
                 Row alone_fatigue(fatigue);
                 for (const signed char r : raw) {
                     const double step = r / 100.0;
                     const double least =
                         std::min({travel.remaining(alone_travel.state, 40, step),
                                   energy.remaining(alone_energy.state, 40, step),
                                   fatigue.remaining(alone_fatigue.state, 40, step)});
                     RC_ASSERT(any.remaining(together.state, 40, step) == least);
                     const double before[] = {travel.remaining(alone_travel.state, 40, step),
                                              energy.remaining(alone_energy.state, 40, step),
                                              fatigue.remaining(alone_fatigue.state, 40, step)};
                     const double fed =
                         clip ? std::copysign(std::min(std::abs(step), least), step) : step;
                     const bool lives = together.flow(fed, 40, false);
                     const bool all_live = int(alone_travel.flow(fed, 40, false)) +
                                               int(alone_energy.flow(fed, 40, false)) +
                                               int(alone_fatigue.flow(fed, 40, false)) ==
                                           3;
                     RC_ASSERT(lives == all_live);
                     RC_ASSERT(any.damage(together.state) ==
                               std::max({travel.damage(alone_travel.state),
                                         energy.damage(alone_energy.state),
                                         fatigue.damage(alone_fatigue.state)}));
                     if (!lives) {
                         const auto index = any.governing_index(together.state);
                         // equal up to round-off where two limits fall together
                         RC_ASSERT(before[index] <= least * (1 + 1e-12));
                         RC_ASSERT(any.remaining(together.state, 40, step) == 0.0);
                         return;
                     }
                 }
             });
}

TEST_CASE("any-of says which member governs", "[fracture]") {
    const AnyOf any(TravelLimit<double>({.limit = 2}), EnergyLimit<double>({.limit = 60}),
                    BrittleForce<double>({.limit = 100}));
    using State = decltype(any)::State;
    // weak: 2 rad at 20 N m is 40 J; strong: 60 J at 50 N m is 1.2 rad
    const auto broken_by = [&](double strength) {
        Row row(any);
        while (row.flow(0.07, strength)) {
        }
        return std::tuple(any.governing(row.state), row.travel, row.work);
    };
    {
        const auto [kind, travel, work] = broken_by(20);
        CHECK(kind == CriterionKind::plastic_travel);
        CHECK(travel == Approx(2).epsilon(1e-13));
    }
    {
        const auto [kind, travel, work] = broken_by(50);
        CHECK(kind == CriterionKind::absorbed_energy);
        CHECK(travel == Approx(1.2).epsilon(1e-13));
        CHECK(work == Approx(60).epsilon(1e-13));
    }
    State state;
    CHECK(any.force_cap(state) == 100);
    any.update(state, {.force = 100});
    CHECK(any.broken(state));
    CHECK(any.governing(state) == CriterionKind::brittle_force);
    CHECK(any.governing_index(state) == 2);
    CHECK(to_string(any.governing(state)) == "brittle force");
    CHECK(any.member_state<2>(state).broken);
    CHECK(any.criterion<1>().limit() == 60);
    // nothing that comes later changes the verdict, or anything else
    const State as_broken = state;
    any.update(state, {.plastic = 5, .travel = 5, .force = 100, .work = 500});
    CHECK(any.governing_index(state) == 2);
    CHECK(state == as_broken);
}

TEST_CASE("the force breaks before the flow of the same step", "[fracture]") {
    const AnyOf any(TravelLimit<double>({.limit = 1}), BrittleForce<double>({.limit = 100}));
    decltype(any)::State state;
    any.update(state, {.plastic = 2, .travel = 2, .force = -100, .work = 200});
    CHECK(any.governing(state) == CriterionKind::brittle_force);
}

TEST_CASE("before the break the member with most damage governs", "[fracture]") {
    const AnyOf any(TravelLimit<double>({.limit = 2}), EnergyLimit<double>({.limit = 60}));
    Row row(any);
    row.flow(0.5, 50);
    CHECK(any.damage(row.state) == Approx(25.0 / 60));
    CHECK(any.governing(row.state) == CriterionKind::absorbed_energy);
    row.flow(1.0, 5);
    CHECK(any.damage(row.state) == Approx(0.75));
    CHECK(any.governing(row.state) == CriterionKind::plastic_travel);
}

TEST_CASE("softening softens a combination too", "[fracture]") {
    const AnyOf any(SofteningDamage<double>({.onset = 0, .failure = 2}),
                    SofteningDamage<double>({.onset = 0.5, .failure = 1.5}),
                    TravelLimit<double>({.limit = 9}));
    Row row(any);
    row.flow(0.6, 40);
    CHECK(any.strength_factor(row.state) == Approx(0.7));
    CHECK(any.strength_factor(row.state, 0.8) == Approx(0.1));
    CHECK(any.remaining(row.state, 40) == Approx(0.9));
}

TEST_CASE("combinations nest", "[fracture]") {
    const AnyOf inner(TravelLimit<double>({.limit = 1}), EnergyLimit<double>({.limit = 1e3}));
    const AnyOf outer(EnergyLimit<double>({.limit = 1e3}), inner);
    Row row(outer);
    while (row.flow(0.3, 40)) {
    }
    CHECK(outer.governing_index(row.state) == 1);
    CHECK(outer.governing(row.state) == CriterionKind::plastic_travel);
    CHECK(row.travel == Approx(1).epsilon(1e-13));
}
