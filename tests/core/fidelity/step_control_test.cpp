// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <rapidcheck/catch.h>

#include "ductile/fidelity/step_control.hpp"
#include "support/throws.hpp"

using namespace ductile;
using ductile::test::message_of;

namespace {
constexpr StepControlParameters<double> wide{.min_step = 1e-9, .max_step = 1, .growth = 1e9};
}

TEST_CASE("a step turns a plastic hinge no further than allowed", "[step_control]") {
    auto p = wide;
    p.plastic_rotation = 0.005;
    StepControl control(p);
    CHECK(control.next({.plastic_rotation_rate = 500}) == Approx(1e-5));
    CHECK(control.next({.plastic_rotation_rate = 0}) == 1);
}

TEST_CASE("parts that close stop in ever smaller steps, down to a share of the thickness",
          "[step_control]") {
    auto p = wide;
    p.closing_fraction = 0.01;
    p.gap_fraction = 0.5;
    StepControl control(p);
    CHECK(control.next({.closing_speed = 5, .gap = 0.1, .thickness = 0.01}) == Approx(0.01));
    CHECK(control.next({.closing_speed = 5, .gap = 0.001, .thickness = 0.01}) == Approx(1e-4));
    CHECK(control.next({.closing_speed = 5, .gap = 0, .thickness = 0.01}) == Approx(2e-5));
    CHECK(control.next({.closing_speed = -5, .gap = 0, .thickness = 0.01}) == 1); // parting
}

TEST_CASE("an elastic part gets its steps per period, a bar its elongation per step",
          "[step_control]") {
    auto p = wide;
    p.steps_per_period = 20;
    p.plastic_elongation = 0.002;
    StepControl control(p);
    CHECK(control.next({.elastic_frequency = 100}) == Approx(1.0 / 2000));
    CHECK(control.next({.plastic_elongation_rate = 4}) == Approx(0.0005));
}

TEST_CASE("growth and shrinking are limited, and never past what the user allows",
          "[step_control]") {
    rc::prop("any motion", [] {
        const double lo = *rc::gen::inRange(1, 100) * 1e-6, hi = lo * *rc::gen::inRange(1, 1000);
        StepControl control(StepControlParameters<double>{
            .min_step = lo, .max_step = hi, .growth = 1.5, .shrink = 0.25});
        double last = control.step();
        for (int i = 0; i < 30; ++i) {
            const double step = control.next(
                {.plastic_rotation_rate = *rc::gen::inRange(0, 100000) * 1.0,
                 .closing_speed = *rc::gen::inRange(-10, 10) * 1.0,
                 .gap = *rc::gen::inRange(-10, 100) * 1e-3,
                 .thickness = 0.01});
            RC_ASSERT(step >= lo && step <= hi);
            RC_ASSERT(step <= 1.5 * last * (1 + 1e-12));
            RC_ASSERT(step >= 0.25 * last * (1 - 1e-12));
            last = step;
        }
    });
}

TEST_CASE("a controller refuses limits that make none, by name", "[step_control]") {
    const auto with = [](auto&& change) {
        StepControlParameters<double> p;
        change(p);
        return message_of([&] { StepControl<double>{p}; });
    };
    CHECK(with([](auto& p) { p.min_step = 0; }) ==
          "StepControl.min_step = 0 s: must be finite and > 0");
    CHECK(with([](auto& p) { p.max_step = 1e-9; }) ==
          "StepControl.max_step = 1e-09 s: must be at least min_step");
    CHECK(with([](auto& p) { p.growth = 1; }) == "StepControl.growth = 1: must be > 1");
    CHECK(with([](auto& p) { p.shrink = 1; }) == "StepControl.shrink = 1: must be in [0, 1)");
    CHECK(with([](auto& p) { p.closing_fraction = 2; }) ==
          "StepControl.closing_fraction = 2: must be in (0, 1]");
    CHECK(with([](auto& p) { p.gap_fraction = 0; }) ==
          "StepControl.gap_fraction = 0: must be in (0, 1]");
    CHECK(with([](auto& p) { p.gap_fraction = NAN; }) ==
          "StepControl.gap_fraction = nan: must be in (0, 1]");
    CHECK_NOTHROW(StepControl<double>({.closing_fraction = 1, .gap_fraction = 1}));
    CHECK(with([](auto& p) { p.steps_per_period = 1; }) ==
          "StepControl.steps_per_period = 1: must be >= 2");
    CHECK(with([](auto& p) { p.plastic_rotation = NAN; }) ==
          "StepControl.plastic_rotation = nan rad: must be > 0 (infinity: no limit)");
}
