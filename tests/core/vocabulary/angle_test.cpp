// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "ductile/vocabulary/angle.hpp"
#include "ductile/vocabulary/row.hpp"
#include "support/property.hpp"

using ductile::unwrap;

TEST_CASE("an angle is found again after any number of turns", "[angle]") {
    ductile::test::prop("unwrap(wrapped angle, guess within pi) is the angle", [] {
        const double angle = *rc::gen::inRange(-2000000, 2000000) / 1e4;
        const double miss = *rc::gen::inRange(-314, 314) / 100.0;
        const double wrapped = std::remainder(angle, 2 * std::numbers::pi);
        RC_ASSERT(std::abs(unwrap(wrapped, angle + miss) - angle) < 1e-12 * (1 + std::abs(angle)));
    });
}

TEST_CASE("outcomes have names", "[vocabulary]") {
    CHECK(to_string(ductile::Outcome::elastic) == "elastic");
    CHECK(to_string(ductile::Outcome::yielding) == "yielding");
    CHECK(to_string(ductile::Outcome::broken) == "broken");
    CHECK(to_string(ductile::Outcome::unreliable) == "unreliable");
}
