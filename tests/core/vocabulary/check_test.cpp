// SPDX-License-Identifier: MIT
#include "ductile/vocabulary/check.hpp"

#include <catch2/catch.hpp>
#include <limits>
#include <sstream>
#include <string>

#include "ductile/vocabulary/number_text.hpp"

using namespace ductile;

TEMPLATE_TEST_CASE("a number reads as a stream writes it", "[check]", float, double, long double) {
    using Limits = std::numeric_limits<TestType>;
    const TestType numbers[] = {0,
                                TestType(-0.0),
                                1,
                                -2,
                                TestType(0.1),
                                TestType(1) / 3,
                                TestType(12345.678),
                                TestType(1e6),
                                TestType(1e-5),
                                TestType(1e20),
                                Limits::max(),
                                Limits::min(),
                                Limits::denorm_min(),
                                Limits::infinity(),
                                -Limits::infinity(),
                                Limits::quiet_NaN()};
    for (const int digits : {1, 3, Limits::digits10, Limits::max_digits10}) {
        for (const TestType number : numbers) {
            std::ostringstream text;
            text.precision(digits);
            text << number;
            CHECK(number_text(number, digits) == text.str());
        }
    }
}

TEST_CASE("a parameter out of range is named with its value, unit and range", "[check]") {
    CHECK_THROWS_WITH(check::positive("Law.strength", -0.1, "N m"),
                      "Law.strength = -0.1 N m: must be finite and > 0");
    CHECK_THROWS_WITH(check::positive("Law.strength", -0.1f, "N m"),
                      "Law.strength = -0.1 N m: must be finite and > 0");
    CHECK_THROWS_WITH(check::non_negative("Law.slope", std::numeric_limits<double>::infinity(), ""),
                      "Law.slope = inf: must be finite and >= 0");
    CHECK_THROWS_WITH(check::positive_or_infinite("Limit.travel", 0.0, "rad"),
                      "Limit.travel = 0 rad: must be > 0 (infinity: no limit)");
    // finite, but its square is none
    CHECK_THROWS_WITH(check::positive("Law.strength", 1e160, "N m"),
                      "Law.strength = 1e+160 N m: must be at most 1e+100 in size");
    CHECK_THROWS_WITH(check::positive("Law.strength", 1e-300, "N m"),
                      "Law.strength = 1e-300 N m: must be at least 1e-100");
    CHECK_THROWS_WITH(check::positive("Law.strength", 1e35f, "N m"),
                      "Law.strength = 1e+35 N m: must be at most 1e+30 in size");
    CHECK_THROWS_WITH(check::non_negative("Law.slope", 1e300, ""),
                      "Law.slope = 1e+300: must be at most 1e+100 in size");
    CHECK_THROWS_WITH(check::positive_or_infinite("Limit.travel", 1e300, "rad"),
                      "Limit.travel = 1e+300 rad: must be at most 1e+100 in size");
    CHECK_THROWS_WITH(check::finite("Hand.place", -1e300, "m"),
                      "Hand.place = -1e+300 m: must be at most 1e+100 in size");
    CHECK_THROWS_WITH(check::finite("Hand.place", std::numeric_limits<double>::quiet_NaN(), "m"),
                      "Hand.place = nan m: must be finite");
    CHECK_THROWS_WITH(check::between("Law.share", 1.5, 0.0, 1.0, "", true),
                      "Law.share = 1.5: must be in [0, 1]");
    CHECK_THROWS_WITH(check::between("Tube.inner_radius", 2.0, 0.0, 1e-3, "m"),
                      "Tube.inner_radius = 2 m: must be in (0, 0.001) m");
}

TEST_CASE("a parameter within its range is handed on", "[check]") {
    const double infinity = std::numeric_limits<double>::infinity();
    CHECK(check::positive("a", 2.0, "m") == 2);
    CHECK(check::positive("a", 1e100, "m") == 1e100);
    CHECK(check::positive("a", 1e-100, "m") == 1e-100);
    CHECK(check::non_negative("a", 0.0, "m") == 0);
    CHECK(check::finite("a", -2.0, "m") == -2);
    CHECK(check::positive_or_infinite("a", infinity, "m") == infinity);
    CHECK(check::between("a", 0.5, 0.0, 1.0, "") == 0.5);
    CHECK(check::between("a", 1.0, 0.0, 1.0, "", true) == 1);
}
