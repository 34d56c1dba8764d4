// SPDX-License-Identifier: MIT
#include "ductile/structure/mechanism.hpp"

#include <catch2/catch.hpp>

using ductile::Bond;
using ductile::find_mechanism;
using ductile::Mechanism;

TEST_CASE("Freedoms are those of the bodies less what joints hold", "[structure]") {
    CHECK_FALSE(find_mechanism(1, {}));
    CHECK_FALSE(find_mechanism(1, {{.a = 0}}));
    CHECK(find_mechanism(1, {{.a = 0, .held = 5}}) == Mechanism{0, 1});
    const Bond pinned{.a = 0, .to = Bond::To::body, .b = 1, .held = 5};
    CHECK(find_mechanism(2, {pinned}) == Mechanism{0, 1});
    CHECK_FALSE(find_mechanism(2, {pinned, {.a = 1}, {.a = 0, .held = 5}}));
    // two parts: each by itself
    CHECK(find_mechanism(2, {{.a = 0}, {.a = 0}, {.a = 1, .held = 3}}) == Mechanism{1, 3});
    // what hangs on something unknown is not judged
    CHECK_FALSE(find_mechanism(1, {{.a = 0, .to = Bond::To::unknown, .held = 1}}));
}
