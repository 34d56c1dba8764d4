// SPDX-License-Identifier: MIT
#include "ductile/world/effort.hpp"

#include <catch2/catch.hpp>

#include "support/throws.hpp"

using namespace ductile;

TEST_CASE("effort doubles while a step is unreliable and is lowered when all is calm", "[world]") {
    EffortControl control(
        {.action = OnUnconverged::raise_iterations, .most_iterations = 6, .calm_steps = 3});
    CHECK(control.effort() == Effort{});
    CHECK(control.next(false).iterations == 2);
    CHECK(control.next(false).iterations == 4);
    CHECK(control.next(false).iterations == 6);
    CHECK(control.next(true).iterations == 6);
    CHECK(control.next(true).iterations == 6);
    CHECK(control.next(true).iterations == 3);
    CHECK(control.next(false).iterations == 6);
    CHECK(control.effort().parts == 1);
    CHECK_FALSE(control.effort().direct);
}

TEST_CASE("an effort is raised only in the way that the user chose", "[world]") {
    EffortControl none;
    CHECK(none.next(false) == Effort{});
    EffortControl parts({.action = OnUnconverged::split_step, .most_parts = 4});
    CHECK(parts.next(false) == Effort{.parts = 2});
    EffortControl direct({.action = OnUnconverged::direct_solver, .calm_steps = 1});
    CHECK(direct.next(false) == Effort{.direct = true});
    CHECK(direct.next(true) == Effort{});
}

TEST_CASE("an effort control names what is out of range", "[world]") {
    CHECK(test::message_of([] { EffortControl({.most_parts = 0}); }) ==
          "Effort.most_parts = 0: must be >= 1");
    CHECK(test::message_of([] { EffortControl({.calm_steps = -1}); }) ==
          "Effort.calm_steps = -1: must be >= 1");
    CHECK(test::message_of([] { EffortControl({.most_iterations = 0}); }) ==
          "Effort.most_iterations = 0: must be >= 1");
}
