// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include "core/surface/properties.hpp"

TEST_CASE("yield surfaces keep what their concept promises, in float", "[surface]") {
    ductile::test::check_all<float>();
}
