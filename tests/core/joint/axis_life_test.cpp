// SPDX-License-Identifier: MIT
#include "ductile/joint/axis_life.hpp"

#include <catch2/catch.hpp>

#include <limits>

using namespace ductile;

namespace {
constexpr double infinity = std::numeric_limits<double>::infinity();
}

TEST_CASE("life along axes is the length of its shares", "[joint][break]") {
    const AxisLife<double, 3> bent({0.3, 0.3, 0.8});
    CHECK(bent.of({0.3, 0, 0}) == Approx(1));
    CHECK(bent.of({0, 0, -0.8}) == Approx(1));
    CHECK(bent.of({0.18, -0.24, 0}) == Approx(1)); // 0.3 rad about an axis between the two
    CHECK(bent.of({0.18, 0, 0.64}) == Approx(1));
    CHECK(bent.limited());

    const AxisLife<double, 3> twisted({infinity, infinity, 2});
    CHECK(twisted.of({9, 9, 1}) == Approx(0.5));
    const AxisLife<double, 3> endless({infinity, infinity, infinity});
    CHECK(endless.of({9, 9, 9}) == 0);
    CHECK_FALSE(endless.limited());
}

TEST_CASE("what is left of a travel is its share of the life that is left", "[joint][break]") {
    CHECK(travel_left(2.0, 0.5, 0.75) == Approx(1));
    CHECK(travel_left(2.0, 0.5, 1.0) == 0);
    CHECK(travel_left(2.0, 0.0, 0.75) == infinity);
}
