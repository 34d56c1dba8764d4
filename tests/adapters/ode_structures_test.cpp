// SPDX-License-Identifier: MIT
//
// Structures in ODE as it comes: dWorldStep, default World, 1/60 s.
#include <catch2/catch.hpp>
#include <cmath>

#include "adapters/ode_frame.hpp"

using ductile::test::FrameSettings;
using ductile::test::OdeFrame;

namespace {

constexpr double dt = 1.0 / 60;

} // namespace

TEST_CASE("The frame of P29 stands, sags as the elastic frame does, and falls asleep",
          "[ode][structures]") {
    FrameSettings settings;
    SECTION("elastic") {}
    SECTION("rigid") { settings.elastic = false; }
    OdeFrame frame(settings);
    REQUIRE(frame.joints() == 36);
    REQUIRE(frame.mass() == Approx(41359.8).epsilon(1e-5));
    frame.run(60, dt);
    CHECK(frame.absorbed() == 0);
    CHECK(frame.events() == 0);
    CHECK(frame.lines().empty());
    CHECK(frame.utilisation_of("column 00") == Approx(0.0379667).epsilon(0.01));
    CHECK(frame.utilisation_of("column 10") == Approx(0.0253290).epsilon(0.01));
    CHECK(frame.utilisation_of("beam 00a") == Approx(0.0365513).epsilon(0.01));
    CHECK(frame.utilisation_of("beam 01b") == Approx(0.0360772).epsilon(0.01));
    if (settings.elastic) {
        CHECK(frame.stored() == Approx(9.31068).epsilon(0.01));
        const double sag = 3 * OdeFrame::storey - 0.16 - frame.beam(2, 0).z();
        CHECK(sag == Approx(0.0534951e-3).epsilon(0.01));
    }
    frame.let_sleep();
    frame.run(1, dt);
    CHECK(frame.asleep());
    CHECK(frame.absorbed() == 0);
    CHECK(frame.lines().empty());
}

TEST_CASE("A frame that loses a column or a foot comes to rest where P29 says",
          "[ode][structures]") {
    FrameSettings settings;
    double removed = 0.508898, cut = 0.555534;
    SECTION("elastic") {}
    SECTION("rigid") {
        settings.elastic = false;
        removed = 0.505759;
        cut = 0.547503;
    }
    for (const bool whole_column : {true, false}) {
        OdeFrame frame(settings);
        frame.run(1, dt);
        frame.damp(2);
        whole_column ? frame.remove_column() : frame.cut_foot();
        frame.run(40, dt);
        CHECK(frame.speed() < 1e-6);
        CHECK(frame.absorbed() == 0);
        CHECK(frame.lines().empty());
        CHECK(frame.utilisation() == Approx(whole_column ? removed : cut).epsilon(0.005));
        CHECK(frame.most_used() == (whole_column ? "beam 13a" : "column 03"));
        if (!settings.elastic) CHECK(frame.sway() < 1e-6);
    }
}

TEST_CASE("The frame without a column swings until it rests, then sleeps", "[ode][structures]") {
    OdeFrame frame(FrameSettings{});
    frame.run(1, dt);
    frame.let_sleep();
    frame.remove_column();
    double slept = 0;
    for (; !frame.asleep() && slept < 15; slept += 0.25) frame.run(0.25, dt);
    CHECK(slept > 1.5);
    CHECK(slept < 15);
    CHECK(frame.absorbed() == 0);
    CHECK(frame.utilisation() == Approx(0.508898).epsilon(0.005));
    CHECK(frame.lines().empty());
}

TEST_CASE("The frame without a column stands at 0.999 of P30's collapse load and falls at 1.001",
          "[ode][structures]") {
    constexpr double collapse = 2.2772731;
    for (const double factor : {0.999, 1.001}) {
        FrameSettings settings;
        settings.elastic = false;
        settings.weights = factor * collapse;
        OdeFrame frame(settings);
        frame.run(0.5, dt);
        frame.remove_column();
        frame.run(2, dt);
        if (factor < 1) {
            CHECK(frame.speed() < 1e-9);
            CHECK(frame.absorbed() < 0.1);
        } else {
            CHECK(frame.speed() > 0.02);
            CHECK(frame.utilisation_of("beam 00b") == Approx(1).epsilon(1e-5));
        }
    }
}

TEST_CASE("The frame stands on loose footings, under another frame and under crates",
          "[ode][structures]") {
    FrameSettings settings;
    double used = 0.0379667;
    SECTION("loose footings") { settings.loose = true; }
    SECTION("two frames") {
        settings.frames = 2;
        used = 0.0759;
    }
    SECTION("two crates of a tonne on every beam") {
        settings.crates = 2;
        used = 0.0600;
    }
    for (const bool elastic : {true, false}) {
        settings.elastic = elastic;
        OdeFrame frame(settings);
        frame.run(10, dt);
        const double before = frame.sway();
        frame.run(10, dt);
        CHECK(frame.absorbed() == 0);
        CHECK(frame.events() == 0);
        CHECK(frame.lines().empty());
        CHECK(frame.utilisation() == Approx(used).epsilon(0.02));
        CHECK(std::abs(frame.sway() - before) < 1e-7);
    }
}
