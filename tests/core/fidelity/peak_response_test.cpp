// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <numbers>

#include "core/fidelity/oscillator.hpp"
#include "ductile/fidelity/peak_response.hpp"
#include "support/property.hpp"
#include "support/throws.hpp"

using namespace ductile;
using ductile::test::elastic_plastic_peak;
using ductile::test::message_of;
using ductile::test::rigid_plastic_peak;

namespace {
constexpr double infinity = std::numeric_limits<double>::infinity();
}

TEST_CASE("a free oscillator past yield stops where its energy is used up", "[peak_response]") {
    // θ_max = θ_y + (E0 - k θ_y²/2)/M_y = 0.25 rad
    const auto r =
        peak_response<double>({.mass = 0.5, .stiffness = 200, .strength = 10}, {.speed = 3});
    CHECK(r.displacement == Approx(0.25).epsilon(1e-14));
    CHECK(r.plastic == Approx(0.2).epsilon(1e-14));
    CHECK(r.force == 10);
}

TEST_CASE("a load put on at once and held", "[peak_response]") {
    // u_max/u_y = 1/(2 (1 - F/R)) past F/R = 1/2; below it the elastic 2 F/k; beyond 1 no end
    const AxisSystem<double> system{.mass = 100, .stiffness = 4e4, .strength = 2000};
    for (const auto& [share, peak] :
         {std::pair{0.6, 0.0625}, std::pair{0.8, 0.125}, std::pair{0.9, 0.25}}) {
        const auto r = peak_response(system, {.load = share * 2000});
        INFO("F/R = " << share);
        CHECK(r.displacement == Approx(peak).epsilon(1e-13));
        CHECK(r.plastic == Approx(peak - 0.05).epsilon(1e-12));
    }
    const auto elastic = peak_response(system, {.load = 0.4 * 2000});
    CHECK(elastic.displacement == Approx(0.04).epsilon(1e-14));
    CHECK(elastic.force == Approx(1600).epsilon(1e-14));
    CHECK(elastic.plastic == 0);
    CHECK(peak_response(system, {.load = 1.2 * 2000}).displacement == infinity);
    CHECK(peak_response(system, {.load = 2000}).displacement == infinity);
}

TEST_CASE("the chart of Biggs for rectangular pulses", "[peak_response]") {
    // u_max/u_y by t_d/T and R/F, five decimals (Biggs 1964, section 2.7, by exact integration)
    constexpr double r_over_f[] = {0.3, 0.5, 0.8, 1.0, 1.2, 1.5};
    constexpr double duration[] = {0.1, 0.2, 0.5, 1.0, 2.0, 5.0};
    constexpr double chart[6][6] = {
        {2.62203, 1.26393, 0.77254, 0.61803, 0.51503, 0.41202},
        {8.32055, 3.26938, 1.57966, 1.19098, 0.97964, 0.78371},
        {43.85707, 14.14169, 4.95375, 3.07080, 2.13488, 1.44789},
        {164.49548, 48.05356, 13.04525, 6.21239, 2.98955, 1.50000},
        {636.06308, 175.09493, 38.48100, 12.49557, 3.00000, 1.50000},
        {3893.09202, 1029.96006, 188.81027, 31.34513, 3.00000, 1.50000}};
    const AxisSystem<double> system{.mass = 3, .stiffness = 700, .strength = 21};
    const double period = 2 * std::numbers::pi * std::sqrt(3.0 / 700);
    for (int i = 0; i < 6; ++i) {
        for (int j = 0; j < 6; ++j) {
            const auto r =
                peak_response(system, {.load = 21 / r_over_f[j], .duration = duration[i] * period});
            INFO("t_d/T = " << duration[i] << ", R/F = " << r_over_f[j]);
            CHECK(r.displacement / (21.0 / 700) == Approx(chart[i][j]).margin(6e-6));
        }
    }
}

TEST_CASE("a short strong pulse is the impact of its impulse", "[peak_response]") {
    const AxisSystem<double> system{.mass = 2, .stiffness = 800, .strength = 10};
    const double hit = peak_response(system, {.speed = 3}).displacement;
    for (const double duration : {1e-4, 1e-5}) {
        const double pulse =
            peak_response(system, {.load = 6 / duration, .duration = duration}).displacement;
        CHECK(pulse == Approx(hit).epsilon(20 * duration)); // first order in t_d/T
    }
}

TEST_CASE("a held load takes its share of the strength", "[peak_response]") {
    // R - G left: the same motion as a weaker axis without it
    const AxisSystem<double> system{.mass = 2, .stiffness = 800, .strength = 10};
    const AxisSystem<double> weaker{.mass = 2, .stiffness = 800, .strength = 6};
    const auto held = peak_response(system, {.speed = 3, .load = 2, .duration = 0.1, .held = 4});
    const auto alone = peak_response(weaker, {.speed = 3, .load = 2, .duration = 0.1});
    CHECK(held.displacement == alone.displacement);
    CHECK(held.force == 10);
    CHECK(alone.force == 6);
    CHECK(peak_response(system, {.held = 10}).displacement == infinity); // collapses at rest
}

TEST_CASE("the rigid axis is the limit of a stiff one", "[peak_response]") {
    test::prop("any event, with an error that falls at least as 1/√k", [] {
        AxisSystem<double> rigid{.mass = *rc::gen::inRange(1, 100) / 10.0,
                                 .stiffness = infinity,
                                 .strength = *rc::gen::inRange(1, 100) / 1.0};
        // away from F = R, where the limit is slow
        const double share = *rc::gen::element(0.0, 0.3, 1.5, 4.0);
        const AxisEvent<double> event{.speed = *rc::gen::inRange(1, 50) / 10.0,
                                      .load = share * rigid.strength,
                                      .duration = *rc::gen::inRange(1, 50) / 10.0};
        const double expected = peak_response(rigid, event).displacement;
        const auto error = [&](double k) {
            AxisSystem<double> stiff = rigid;
            stiff.stiffness = k;
            return std::abs(peak_response(stiff, event).displacement - expected);
        };
        // the time to yield is of order 1/√k with a load, the energy of order 1/k without
        const double round_off = 1e-12 * expected;
        RC_ASSERT(error(1e12) <= error(1e8) / 50 + round_off);
        RC_ASSERT(error(1e8) < 0.1 * expected);
    });
}

TEST_CASE("the closed forms are those of the oscillator stepped in time", "[peak_response]") {
    test::prop("any system and event", [] {
        const AxisSystem<double> system{.mass = *rc::gen::inRange(1, 100) / 10.0,
                                        .stiffness = *rc::gen::inRange(1, 1000) * 1.0,
                                        .strength = *rc::gen::inRange(1, 100) * 1.0};
        const double omega = std::sqrt(system.stiffness / system.mass);
        const AxisEvent<double> event{
            .speed = *rc::gen::inRange(0, 40) / 10.0 * system.strength / system.stiffness * omega,
            .load = *rc::gen::inRange(0, 30) / 10.0 * system.strength,
            .duration = *rc::gen::inRange(1, 60) / 10.0 / omega,
            .held = *rc::gen::inRange(0, 8) / 10.0 * system.strength};
        RC_PRE(event.speed > 0 || event.load > 0);
        const double exact = peak_response(system, event).displacement;
        const double dt = 1e-3 / omega;
        // first order in ω dt where the load starts and stops, and at the stop
        RC_ASSERT(std::abs(elastic_plastic_peak(system, event, dt) - exact) < 3e-3 * exact);
        AxisSystem<double> rigid = system;
        rigid.stiffness = infinity;
        const double plastic = peak_response(rigid, event).displacement;
        RC_ASSERT(std::abs(rigid_plastic_peak(system, event, dt) - plastic) <
                  3e-3 * (plastic + exact));
    });
}

TEST_CASE("float gives the answer of double to its round-off", "[peak_response]") {
    const AxisSystem<double> system{.mass = 2, .stiffness = 800, .strength = 10};
    const AxisSystem<float> single{.mass = 2, .stiffness = 800, .strength = 10};
    for (const double share : {0.2, 0.6, 0.8, 1.5}) {
        for (const double duration : {0.01, 0.06, 0.5}) {
            const double expected =
                peak_response(system, {.speed = 0.3, .load = 10 * share, .duration = duration})
                    .displacement;
            const float value =
                peak_response(
                    single, {.speed = 0.3f, .load = float(10 * share), .duration = float(duration)})
                    .displacement;
            CHECK(double(value) == Approx(expected).epsilon(1e-5)); // some 50 roundings of 6e-8
        }
    }
}

TEST_CASE("a response refuses numbers that make no oscillator, by name", "[peak_response]") {
    const AxisSystem<double> good{.mass = 1, .stiffness = 1, .strength = 1};
    CHECK(message_of([] { (void)peak_response<double>({}, {}); }) ==
          "AxisSystem.mass = nan kg or kg m^2: must be finite and > 0");
    CHECK(message_of([] { (void)peak_response<double>({.mass = 1, .stiffness = 0}, {}); }) ==
          "AxisSystem.stiffness = 0 N/m or N m/rad: must be > 0 (infinity: no limit)");
    CHECK(message_of([] { (void)peak_response<double>({.mass = 1}, {}); }) ==
          "AxisSystem.strength = nan N or N m: must be > 0 (infinity: no limit)");
    CHECK(message_of([&] { (void)peak_response(good, {.speed = -1}); }) ==
          "AxisEvent.speed = -1 m/s or rad/s: must be finite and >= 0");
    CHECK(message_of([&] { (void)peak_response(good, {.load = infinity}); }) ==
          "AxisEvent.load = inf N or N m: must be finite and >= 0");
    CHECK(message_of([&] { (void)peak_response(good, {.duration = 0}); }) ==
          "AxisEvent.duration = 0 s: must be > 0 (infinity: no limit)");
    CHECK(message_of([&] { (void)peak_response(good, {.held = -1}); }) ==
          "AxisEvent.held = -1 N or N m: must be finite and >= 0");
}

TEST_CASE("a break takes its energy and leaves the rest of the motion", "[peak_response]") {
    // P02 a, b: ω_res² = ω₀² - 2 (M_p/I) θ_max
    for (const auto& [limit, left] : {std::pair{1.6, 6.0}, std::pair{1.3, 6.92820323}}) {
        const auto r =
            peak_response<double>({.mass = 2, .strength = 40, .limit = limit}, {.speed = 10});
        CHECK(r.speed == Approx(left).epsilon(2e-9)); // printed digits
        CHECK(r.plastic == limit);
        CHECK(r.displacement == limit);
    }
    // what is stored is lost too: m v²/2 = R (limit + u_y/2) + m v_res²/2
    const AxisSystem<double> soft{.mass = 2, .stiffness = 400, .strength = 40, .limit = 1.3};
    const auto r = peak_response(soft, {.speed = 10});
    CHECK(r.speed == Approx(std::sqrt(100 - 40 * (1.3 + 0.05))).epsilon(1e-12));
    CHECK(r.displacement == Approx(1.4).epsilon(1e-14));
    // one that stops before does not break
    CHECK(peak_response(soft, {.speed = 5}).speed == 0);
    CHECK(peak_response<double>({.mass = 2, .strength = 40, .limit = 1.3}, {.speed = 5}).speed ==
          0);
}

TEST_CASE("a load that ends before the break, or after it, or keeps pulling", "[peak_response]") {
    // rigid-plastic, m = 2, R = 40, hit at 10: accelerated by F for t_d, then braked by R
    const AxisSystem<double> bar{.mass = 2, .strength = 40, .limit = 5};
    const auto speed = [&](double load, double duration) {
        return peak_response(bar, {.speed = 10, .load = load, .duration = duration}).speed;
    };
    // F = R: moves on at 10 until 0.1 s, 1 m; then 4 m at -20 m/s²: 100 - 160 < 0, it stops
    CHECK(speed(40, 0.1) == 0);
    // F = R until 0.4 s: 4 m at 10, then 1 m: 100 - 40
    CHECK(speed(40, 0.4) == Approx(std::sqrt(60)).epsilon(1e-14));
    CHECK(speed(40, 2) == Approx(10).epsilon(1e-14));
    CHECK(speed(40, infinity) == Approx(10).epsilon(1e-14));
    // F = 60 for ever: +10 m/s² over 5 m
    CHECK(speed(60, infinity) == Approx(std::sqrt(200)).epsilon(1e-14));
    // F = 20 for ever: -10 m/s²: 100 - 100 at 5 m, just stops
    CHECK(speed(20, infinity) == 0);
    CHECK(speed(22, infinity) == Approx(std::sqrt(10)).epsilon(1e-13));
    CHECK(message_of([] {
              (void)peak_response<double>({.mass = 1, .strength = 1, .limit = 0}, {});
          }) == "AxisSystem.limit = 0 m or rad: must be > 0 (infinity: no limit)");
}
