// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include "properties.hpp"

TEST_CASE("yield surfaces keep what their concept promises, in float", "[surface]") {
    ductile::test::check_all<float>();
}
