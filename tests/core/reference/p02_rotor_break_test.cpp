// SPDX-License-Identifier: MIT
//
// P02. The rotors of P01 with a hinge that breaks in mid-motion: ω_res = √(ω0² - 2 α θ_max) and
// E = M_p θ_max, exact at any step because the joint clips its last impulse.
#include <catch2/catch.hpp>

#include <string>

#include "reference/expect.hpp"
#include "reference/problems/rotors.hpp"

using namespace ductile::reference;

TEST_CASE("P02 a hinge breaks at its rotation with the exact residual speed at any step",
          "[reference][P02]") {
    for (const double limit : {1.6, 1.3}) {
        expect_trends("P02 at " + std::to_string(limit),
                      [&](double dt) { return p02_rotor_break({.limit = limit}, dt); },
                      {.dt = 1.0 / 15});
    }
    expect_trends("P02c", p02_pair_break, {.dt = 1.0 / 15});
}

TEST_CASE("P02 the closed forms are the tabulated ones", "[reference][P02]") {
    const auto b = p02_rotor_break({.limit = 1.3}, 1.0 / 60);
    CHECK(b[0].exact == Approx(6.92820323).epsilon(1e-8));
    CHECK(b[3].exact == Approx(0.1535898).epsilon(1e-6));
}
