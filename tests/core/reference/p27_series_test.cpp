// SPDX-License-Identifier: MIT
//
// P27. Two rotors in series: the outer hinge locks while the inner one goes on.
#include <catch2/catch.hpp>

#include "reference/expect.hpp"
#include "reference/problems/rotors.hpp"

using namespace ductile::reference;

TEST_CASE("P27a two rotors lock together and stop, each hinge in its own rotation",
          "[reference][P27]") {
    expect_trends("P27a", p27_series);
    const SeriesEnd fine = series(1e-4);
    CHECK(fine.lock_speed == Approx(6.545455).epsilon(1e-3));
    CHECK(fine.outer.plastic_work == Approx(65.45455).epsilon(1e-5));
    CHECK(fine.inner.plastic_work == Approx(78.54545).epsilon(1e-5));
}

TEST_CASE("P27a the rotations at 1/60 s are the exact discrete ones", "[reference][P27]") {
    const SeriesEnd end = series(1.0 / 60);
    CHECK(end.inner.plastic_offset == Approx(3.926852).epsilon(2e-7));
    CHECK(end.outer.plastic_offset == Approx(1.209722).epsilon(4e-7));
}
