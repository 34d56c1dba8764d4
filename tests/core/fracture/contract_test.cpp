// SPDX-License-Identifier: MIT
//
// What every criterion must obey, run for each in float and double.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <type_traits>
#include <vector>

#include "core/fracture/specimens.hpp"
#include "ductile/fracture/event.hpp"

using namespace ductile;
using namespace ductile::test;

namespace {

struct NoCriterion {
    using Scalar = double;
    struct State {};
};
static_assert(!FractureCriterion<NoCriterion>);
static_assert(!FractureCriterion<double>);
static_assert(FractureCriterion<AnyOfAll<float>> && FractureCriterion<AnyOfAll<double>>);
static_assert(FractureCriterion<AnyOf<AnyOf<TravelLimit<double>>, EnergyLimit<double>>>);

template <class C>
using StateOf = typename C::State;

/// Increments over 15 decades, with turns, rests and forces; the strength stays at 40 N.
template <class C>
void feed_random(Row<C>& row, std::mt19937& random, double largest) {
    using S = typename C::Scalar;
    std::uniform_real_distribution<double> exponent(-15, std::log10(largest));
    std::uniform_int_distribution<int> die(0, 9);
    const int roll = die(random);
    const S size = roll == 0 ? S(0) : S(std::pow(10.0, exponent(random)));
    row.flow(roll % 2 == 0 ? size : -size, S(40), roll < 8);
}

} // namespace

#define EVERY_CRITERION                                                                 \
    TravelLimit<double>, TravelLimit<float>, EnergyLimit<double>, EnergyLimit<float>,   \
        BrittleForce<double>, BrittleForce<float>, SofteningDamage<double>,             \
        SofteningDamage<float>, LowCycleFatigue<CoffinManson<double>>,                  \
        LowCycleFatigue<CoffinManson<float>>, LowCycleFatigue<TotalStrainLife<double>>, \
        LowCycleFatigue<TotalStrainLife<float>>, AnyOfAll<double>, AnyOfAll<float>

TEMPLATE_TEST_CASE("a load below yield leaves the state of a criterion as it was, bit for bit",
                   "[fracture]", EVERY_CRITERION) {
    using S = typename TestType::Scalar;
    const auto criterion = Specimen<TestType>::make();
    Row row(criterion);
    row.flow(S(0.1), S(40));
    row.flow(S(-0.05), S(40));
    const auto before = row.state;
    for (int i = 0; i < 1000; ++i) {
        // work and travel of a row without flow are not its plastic ones: they must not count
        criterion.update(row.state, {.plastic = 0,
                                     .travel = row.travel + S(i),
                                     .force = S(i % 2 ? 39 : -39),
                                     .work = S(1),
                                     .dt = S(0.001)});
    }
    CHECK(std::memcmp(&before, &row.state, sizeof before) == 0);
    CHECK_FALSE(criterion.broken(row.state));
}

TEMPLATE_TEST_CASE("damage lies in [0, 1], never decreases and is never NaN over 10^5 random steps",
                   "[fracture]", EVERY_CRITERION) {
    using S = typename TestType::Scalar;
    // the first lives through the history, the others break in the course of it
    for (const double toughness : {1e6, 100.0, 1.0}) {
        const auto criterion = Specimen<TestType>::make({.toughness = toughness});
        Row row(criterion);
        std::mt19937 random(7);
        S before = 0;
        bool was_broken = false;
        bool sane = true;
        bool monotone = true;
        bool stays_broken = true;
        for (int i = 0; i < 100'000; ++i) {
            feed_random(row, random, 1.0);
            const S damage = criterion.damage(row.state);
            const S left = criterion.remaining(row.state, S(40), S(i % 3 - 1));
            sane = sane && damage >= 0 && damage <= 1 && left >= 0 &&
                   criterion.broken(row.state) == (damage == 1) &&
                   (left == 0) == criterion.broken(row.state);
            monotone = monotone && damage >= before;
            stays_broken = stays_broken && (!was_broken || criterion.broken(row.state));
            before = damage;
            was_broken = criterion.broken(row.state);
        }
        INFO("toughness " << toughness);
        CHECK(sane);
        CHECK(monotone);
        CHECK(stays_broken);
    }
}

TEMPLATE_TEST_CASE("increments that are not finite neither turn damage into NaN nor mend a break",
                   "[fracture]", EVERY_CRITERION) {
    using S = typename TestType::Scalar;
    const auto criterion = Specimen<TestType>::make();
    for (const S bad : {std::numeric_limits<S>::quiet_NaN(), std::numeric_limits<S>::infinity()}) {
        StateOf<TestType> state{};
        criterion.update(state, {.plastic = bad, .travel = bad, .force = 1, .work = bad});
        CHECK(criterion.damage(state) >= 0);
        CHECK(criterion.damage(state) <= 1);
        const bool broken = criterion.broken(state);
        CHECK((!broken || !std::isnan(bad)));
        criterion.update(state, {.plastic = S(-0.1), .travel = S(0.1), .force = 1, .work = S(4)});
        CHECK(criterion.broken(state) == broken);
        CHECK(criterion.remaining(state, S(40)) >= 0);
    }
}

TEMPLATE_TEST_CASE("a state that is saved and restored bit for bit goes on in the same way",
                   "[fracture]", EVERY_CRITERION) {
    static_assert(std::is_trivially_copyable_v<StateOf<TestType>>);
    const auto criterion = Specimen<TestType>::make({.toughness = 20});
    Row row(criterion);
    std::mt19937 random(11);
    for (int i = 0; i < 500; ++i) feed_random(row, random, 0.1);

    std::vector<std::byte> saved(sizeof row.state);
    std::memcpy(saved.data(), &row.state, saved.size());
    Row restored(criterion);
    std::memcpy(&restored.state, saved.data(), saved.size());
    restored.travel = row.travel;
    restored.work = row.work;
    REQUIRE(restored.state == row.state);

    std::mt19937 again = random;
    for (int i = 0; i < 2000; ++i) {
        feed_random(row, random, 0.5);
        feed_random(restored, again, 0.5);
    }
    CHECK(restored.state == row.state);
    CHECK(std::memcmp(&restored.state, &row.state, sizeof row.state) == 0);
    // brittle specimens apart, the history was long enough to matter
    CHECK((row.state != StateOf<TestType>{} || std::is_same_v<TestType, BrittleForce<double>> ||
           std::is_same_v<TestType, BrittleForce<float>>));
}

TEMPLATE_TEST_CASE("what remains is what breaks: an increment of just that uses up the life",
                   "[fracture]", TravelLimit<double>, TravelLimit<float>, EnergyLimit<double>,
                   EnergyLimit<float>, SofteningDamage<double>, SofteningDamage<float>,
                   LowCycleFatigue<CoffinManson<double>>, LowCycleFatigue<CoffinManson<float>>,
                   LowCycleFatigue<TotalStrainLife<double>>,
                   LowCycleFatigue<TotalStrainLife<float>>, AnyOfAll<double>, AnyOfAll<float>) {
    using S = typename TestType::Scalar;
    const auto criterion = Specimen<TestType>::make();
    std::mt19937 random(3);
    std::uniform_real_distribution<double> size(-0.2, 0.2);
    for (int run = 0; run < 200; ++run) {
        Row row(criterion);
        for (int i = 0; i < run % 7; ++i) row.flow(S(size(random)), S(40));
        if (criterion.broken(row.state)) continue;
        for (const S direction : {S(1), S(-1)}) {
            const S left = criterion.remaining(row.state, S(40), direction);
            REQUIRE(left > 0);
            Row early = row;
            // 1e-3 is far above round-off in float, far below any life left here
            CHECK(early.flow(direction * left * S(1 - 1e-3), S(40), false));
            Row exact = row;
            CHECK_FALSE(exact.flow(direction * left, S(40), false));
        }
        CHECK(criterion.remaining(row.state, S(40)) ==
              std::min(criterion.remaining(row.state, S(40), S(1)),
                       criterion.remaining(row.state, S(40), S(-1))));
    }
}

TEMPLATE_TEST_CASE("the break takes the same energy whatever the steps", "[fracture]",
                   TravelLimit<double>, TravelLimit<float>, EnergyLimit<double>, EnergyLimit<float>,
                   LowCycleFatigue<CoffinManson<double>>, LowCycleFatigue<CoffinManson<float>>,
                   LowCycleFatigue<TotalStrainLife<double>>,
                   LowCycleFatigue<TotalStrainLife<float>>) {
    using S = typename TestType::Scalar;
    const auto criterion = Specimen<TestType>::make();
    // reversals of ±0.35 cut into n steps each, until the break
    const auto energy = [&](int n) {
        Row row(criterion);
        S sign = 1;
        for (bool intact = true; intact; sign = -sign) {
            for (int i = 0; i < n && intact; ++i) intact = row.flow(sign * S(0.7) / S(n), S(40));
        }
        return row.work;
    };
    const S whole = energy(1);
    CHECK(whole > 40);
    // `work` itself is summed without compensation: n ulps
    for (const int n : {2, 3, 17, 1000}) {
        CHECK(energy(n) == Approx(whole).epsilon(S(4 * n) * std::numeric_limits<S>::epsilon()));
    }
}

TEMPLATE_TEST_CASE(
    "criteria give the same answer in metres and newtons as in millimetres and "
    "kilonewtons",
    "[fracture]", TravelLimit<double>, EnergyLimit<double>, BrittleForce<double>,
    SofteningDamage<double>, LowCycleFatigue<CoffinManson<double>>,
    LowCycleFatigue<TotalStrainLife<double>>, AnyOfAll<double>) {
    constexpr Units mm_kn{.length = 1e3, .force = 1e-3};
    const auto in_si = Specimen<TestType>::make();
    const auto in_mm = Specimen<TestType>::make(mm_kn);
    Row si(in_si);
    Row mm(in_mm);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> size(-0.1, 0.1);
    bool both = true;
    while (both && si.travel < 20) {
        const double step = size(random);
        const double a = in_si.damage(si.state);
        CHECK(in_mm.damage(mm.state) == Approx(a).epsilon(1e-12));
        const double left = in_si.remaining(si.state, 40, step);
        if (std::isfinite(left)) {
            CHECK(in_mm.remaining(mm.state, 40e-3, step) == Approx(left * 1e3).epsilon(1e-11));
        }
        const bool si_lives = si.flow(step, 40);
        both = mm.flow(step * 1e3, 40e-3);
        REQUIRE(both == si_lives);
    }
    CHECK(mm.travel == Approx(si.travel * 1e3).epsilon(1e-12));
    CHECK(in_mm.governing(mm.state) == in_si.governing(si.state));
}

TEMPLATE_TEST_CASE("criteria do not care for the sign of the history", "[fracture]",
                   EVERY_CRITERION) {
    using S = typename TestType::Scalar;
    const auto criterion = Specimen<TestType>::make({.toughness = 3});
    Row plus(criterion);
    Row minus(criterion);
    std::mt19937 random(9);
    std::uniform_real_distribution<double> size(-0.1, 0.1);
    for (int i = 0; i < 3000; ++i) {
        const S step = S(size(random));
        plus.flow(step, S(40));
        minus.flow(-step, S(40));
        REQUIRE(criterion.damage(plus.state) == criterion.damage(minus.state));
        REQUIRE(criterion.remaining(plus.state, S(40), S(1)) ==
                criterion.remaining(minus.state, S(40), S(-1)));
    }
}

TEST_CASE("an event carries what broke, by name", "[fracture]") {
    const FractureEvent<double> event{.axis = 4,
                                      .criterion = CriterionKind::low_cycle_fatigue,
                                      .time = 0.25,
                                      .plastic_travel = 1.6,
                                      .absorbed_energy = 64,
                                      .released_energy = 0.5,
                                      .force = -40};
    CHECK(event.name() == "low-cycle fatigue");
    CHECK(event == FractureEvent<double>(event));
    CHECK(event != FractureEvent<double>{});
    CHECK(FractureEvent<float>{}.name() == "none");
    CHECK(to_string(CriterionKind::plastic_travel) == "plastic travel");
    CHECK(to_string(CriterionKind::absorbed_energy) == "absorbed energy");
    CHECK(to_string(CriterionKind::brittle_force) == "brittle force");
    CHECK(to_string(CriterionKind::softening_damage) == "softening damage");
    CHECK(to_string(CriterionKind::count) == "unknown");
    static_assert(std::is_trivially_copyable_v<FractureEvent<double>>);
}
