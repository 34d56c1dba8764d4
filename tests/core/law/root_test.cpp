// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>

#include "ductile/law/root.hpp"

using namespace ductile;

TEST_CASE("Newton in a bracket finds the root of a line at once and of steep and kinked functions",
          "[law][root]") {
    int calls = 0;
    const auto line = [&](double x) {
        ++calls;
        return ValueAndSlope<double>{3 - 4 * x, -4};
    };
    CHECK(newton_root(0.0, 100.0, 1.0, line) == 0.75);
    CHECK(calls == 2);
    const auto steep = [](double x) {
        return ValueAndSlope<double>{1e-30 - std::pow(x, 9), -9 * std::pow(x, 8)};
    };
    CHECK(newton_root(0.0, 1.0, 1.0, steep) == Approx(std::pow(1e-30, 1 / 9.0)).epsilon(1e-12));
    // the slope on the left leads Newton out of the bracket
    const auto kinked = [](double x) {
        return x < 0.9 ? ValueAndSlope<double>{1 - 1e-3 * x, -1e-3}
                       : ValueAndSlope<double>{0.9991 - 50 * (x - 0.9), -50};
    };
    CHECK(newton_root(0.0, 1.0, 0.0, kinked) == Approx(0.9 + 0.9991 / 50).epsilon(1e-14));
    // a slope of zero must not lead to NaN
    const auto flat = [](double x) { return ValueAndSlope<double>{x < 0.3 ? 1.0 : -1.0, 0.0}; };
    CHECK(newton_root(0.0, 1.0, 0.1, flat) == Approx(0.3).epsilon(1e-14));
}

TEST_CASE("the bracketed search finds roots of smooth, flat and jumping functions", "[law][root]") {
    CHECK(bracketed_root(0.0, 2.0, 0.0, [](double x) { return x * x - 2; }) ==
          Approx(std::sqrt(2.0)).epsilon(1e-14));
    CHECK(bracketed_root(2.0, 0.0, 0.0, [](double x) { return 2 - x * x; }) ==
          Approx(std::sqrt(2.0)).epsilon(1e-14));
    CHECK(bracketed_root(-1.0, 1.0, 0.0, [](double x) { return std::pow(x - 0.3, 9); }) ==
          Approx(0.3).margin(1e-12));
    CHECK(bracketed_root(-1.0, 5.0, 0.0, [](double x) { return x < 0.7 ? -1e6 : 1.0; }) ==
          Approx(0.7).epsilon(1e-14));
    for (const double sign : {-1.0, 1.0}) {
        const auto line = [&](double x) { return sign * x; };
        CHECK(bracketed_root(0.0, 1.0, 0.0, line) == 0.0);
        CHECK(bracketed_root(-1.0, 0.0, 0.0, line) == 0.0);
    }
    CHECK(bracketed_root(0.0f, 2.0f, 0.0f, [](float x) { return x * x - 2; }) ==
          Approx(std::sqrt(2.0)).epsilon(1e-6));
}

TEST_CASE("the bracketed search is much quicker than bisection on a bent function", "[law][root]") {
    int calls = 0;
    const double root = bracketed_root(0.0, 10.0, 0.0, [&](double x) {
        ++calls;
        return std::exp(x) - 20;
    });
    CHECK(root == Approx(std::log(20.0)).epsilon(1e-14));
    CHECK(calls <= 25); // bisection needs 54
}
