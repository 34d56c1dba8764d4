// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <numbers>

#include "core/fidelity/oscillator.hpp"
#include "ductile/fidelity/rehearsal.hpp"
#include "support/property.hpp"
#include "support/throws.hpp"

using namespace ductile;
using ductile::test::elastic_plastic_peak;
using ductile::test::message_of;
using ductile::test::rigid_plastic_peak;

namespace {
constexpr double infinity = std::numeric_limits<double>::infinity();
const AxisSystem<double> rotor{.mass = 2, .strength = 40};
const AxisSystem<double> oscillator{.mass = 100, .stiffness = 4e4, .strength = 2000};
} // namespace

TEST_CASE("a hit stops half a step short, as P01 says", "[rehearsal]") {
    // 10 rad/s at 20 rad/s²: 0.5 s, 2.5 rad; exactly ω₀ dt/2 short where 0.5 s is a number of steps
    for (const double dt : {1.0 / 60, 1.0 / 240, 1e-3}) {
        const auto r = rehearse(rotor, {.speed = 10}, dt);
        CHECK(r.displacement == Approx(2.5 - 10 * dt / 2).epsilon(1e-12));
        CHECK(r.speed == 0);
    }
}

TEST_CASE("a break leaves the right speed at any step", "[rehearsal]") {
    AxisSystem<double> brittle = rotor;
    brittle.limit = 1.3;
    const auto exact = peak_response(brittle, {.speed = 10});
    for (const double dt : {0.05, 1.0 / 60, 1.0 / 240, 1e-3}) {
        const auto r = rehearse(brittle, {.speed = 10}, dt);
        CHECK(r.speed == Approx(6.92820323).epsilon(2e-9)); // printed digits
        CHECK(response_error(exact, r) < 1e-9);
    }
}

TEST_CASE("a contact costs up to a step of flow more", "[rehearsal]") {
    // v dt/2 of the engine and v dt of the contact, to second order
    for (const double dt : {1e-3, 1e-4}) {
        const auto r = rehearse(rotor, {.speed = 10, .own_mass = 0.1}, dt);
        CHECK(r.displacement == Approx(2.5 - 10 * dt * 1.5).margin(20 * dt * dt));
    }
}

TEST_CASE("an elastic row under a contact is as stiff as its own bodies make it", "[rehearsal]") {
    // T = 0.314 s with all of the mass: resolved by 50 steps, so no force acts before it moves
    const AxisEvent<double> hit{.speed = 3};
    const double dt = 2 * std::numbers::pi / 20 / 50;
    AxisEvent<double> contact = hit;
    contact.own_mass = 100;
    CHECK(rehearse(oscillator, contact, dt).displacement ==
          Approx(rehearse(oscillator, hit, dt).displacement).epsilon(1e-12));
    // 0.01 of it: k dt²/m = 1.6, the row is nearly rigid and loses the step that a rigid one does
    contact.own_mass = 1;
    AxisSystem<double> rigid = oscillator;
    rigid.stiffness = infinity;
    const double lost = 3 * dt;
    CHECK(rehearse(oscillator, contact, dt).displacement <
          rehearse(oscillator, hit, dt).displacement - 0.5 * lost);
    CHECK(rehearse(rigid, contact, dt).displacement <
          rehearse(rigid, hit, dt).displacement - 0.9 * lost);
}

TEST_CASE("under a load that stays an axis comes to rest at any step", "[rehearsal]") {
    // 100 kg at 10 m/s on 5 kN, pulled by 4 kN: 5 m; round-off must not keep it creeping
    const AxisSystem<double> bar{.mass = 100, .strength = 5000};
    for (double dt = 1.0 / 60; dt > 1e-3; dt *= 0.97) {
        CHECK(rehearse(bar, {.speed = 10, .load = 4000}, dt).displacement ==
              Approx(5 - 10 * dt / 2).margin(20 * dt * dt));
    }
}

TEST_CASE("an axis alone is stepped as the oscillators of the other tests are", "[rehearsal]") {
    test::prop("any hit and load below the strength", [] {
        const AxisEvent<double> event{.speed = *rc::gen::inRange(24, 100) / 20.0,
                                      .load = *rc::gen::inRange(0, 40) * 40.0};
        const double dt = *rc::gen::inRange(1, 40) * 1e-3 / 20;
        RC_ASSERT(rehearse(oscillator, event, dt).displacement ==
                  Approx(elastic_plastic_peak(oscillator, event, dt)).epsilon(1e-9));
        AxisSystem<double> rigid = oscillator;
        rigid.stiffness = infinity;
        RC_ASSERT(rehearse(rigid, event, dt).displacement ==
                  Approx(rigid_plastic_peak(rigid, event, dt)).epsilon(1e-9));
    });
}

TEST_CASE("what is held from before is not part of the answer", "[rehearsal]") {
    const AxisEvent<double> held{.speed = 2, .held = 500};
    const auto exact = peak_response(oscillator, held);
    CHECK(rehearse(oscillator, held, 1e-5).displacement ==
          Approx(exact.displacement).epsilon(1e-4));
    AxisSystem<double> rigid = oscillator;
    rigid.stiffness = infinity;
    CHECK(rehearse(rigid, held, 1e-5).displacement ==
          Approx(peak_response(rigid, held).displacement).epsilon(1e-4));
    CHECK(rehearse(rigid, {.load = 100, .held = 500}, 1e-3).displacement == 0);
    CHECK(rehearse(rigid, {.held = 2500}, 1e-3).displacement == infinity);
    CHECK(rehearse(rigid, {.load = 2500}, 1e-2).displacement == infinity); // never stops
}

TEST_CASE("the step chosen is the longest whose error stays within the target", "[rehearsal]") {
    // rigid-plastic: v dt/2 of v t/2, so dt = target × t = target × 0.5 s
    const auto exact = peak_response(rotor, {.speed = 10});
    for (const double target : {0.1, 0.03, 0.01}) {
        const auto fit = choose_step(rotor, {.speed = 10}, exact, target, 1.0);
        CHECK(fit.dt <= 0.5 * target * 1.2); // steps that do not divide the time are short by less
        CHECK(fit.dt >= 0.5 * target * 0.96);
        CHECK(fit.error <= target);
    }
    CHECK(choose_step(rotor, {.speed = 10}, exact, 0.1, 1e-3).dt == 1e-3);
    CHECK(choose_step(rotor, {.speed = 10}, exact, 0.1, 1e-3).error == Approx(2e-3).epsilon(1e-9));
    // another model's error does not go away with the step
    AxisSystem<double> strong = rotor;
    strong.strength = 50;
    CHECK(choose_step(strong, {.speed = 10}, exact, 0.1, 1e-2).dt == 0);
    test::prop("every finer step keeps it too", [] {
        const AxisEvent<double> event{.speed = *rc::gen::inRange(24, 100) / 20.0,
                                      .load = *rc::gen::inRange(0, 40) * 40.0};
        const double target = *rc::gen::element(0.1, 0.03, 0.01);
        const auto answer = peak_response(oscillator, event);
        const auto fit = choose_step(oscillator, event, answer, target, 1.0 / 60);
        RC_PRE(fit.dt > 0);
        const double dt = fit.dt * std::pow(0.97, *rc::gen::inRange(0, 45));
        RC_ASSERT(response_error(answer, rehearse(oscillator, event, dt)) <= target * (1 + 1e-9));
    });
}

TEST_CASE("under a contact an elastic axis gets a shorter step than without", "[rehearsal]") {
    AxisEvent<double> hit{.speed = 3};
    const auto exact = peak_response(oscillator, hit);
    const double alone = choose_step(oscillator, hit, exact, 0.02, 1.0 / 60).dt;
    hit.own_mass = 100;
    const auto fit = choose_step(oscillator, hit, exact, 0.02, 1.0 / 60);
    CHECK(fit.dt < 0.9 * alone);
    CHECK(fit.error >= response_error(exact, rehearse(oscillator, hit, fit.dt)) +
                           0.5 * 3 * fit.dt / exact.displacement - 1e-12);
}

TEST_CASE("errors are of the speed where an axis breaks, of the peak where it does not",
          "[rehearsal]") {
    using R = PeakResponse<double>;
    CHECK(response_error(R{.displacement = 2}, R{.displacement = 1.9}) == Approx(0.05));
    CHECK(response_error(R{.displacement = 2, .speed = 4}, R{.displacement = 1.9, .speed = 3}) ==
          Approx(0.25));
    CHECK(response_error(R{.displacement = 2, .speed = 4}, R{.displacement = 2}) == 1);
    CHECK(response_error(R{.displacement = 2}, R{.displacement = 2, .speed = 4}) == 1);
    CHECK(response_error(R{}, R{}) == 0);
    CHECK(response_error(R{}, R{.displacement = 1}) == 1);
    CHECK(response_error(R{.displacement = infinity}, R{.displacement = infinity}) == 0);
    CHECK(response_error(R{.displacement = infinity}, R{.displacement = 1}) == 1);
}

TEST_CASE("a rehearsal refuses a step that is none, by name", "[rehearsal]") {
    CHECK(message_of([] { (void)rehearse(rotor, {.speed = 1}, 0.0); }) ==
          "rehearse.dt = 0 s: must be finite and > 0");
    CHECK(message_of([] { (void)choose_step(rotor, {.speed = 1}, {}, 0.1, -1.0); }) ==
          "choose_step.longest = -1 s: must be finite and > 0");
}
