// SPDX-License-Identifier: MIT
//
// P13. Parkes' cantilever, struck at its tip, cut into N rigid segments. Compared with the exact
// answers for N segments, not with the continuum, which many segments approach slowly.
#include <catch2/catch.hpp>

#include <cmath>
#include <string>

#include "reference/expect.hpp"
#include "reference/problems/impact.hpp"

using namespace ductile::reference;

namespace {

/// Every hinge stops u dt/2 short of where it should, and there are up to N of them.
double shortfall(double speed, int segments, double dt) {
    return 1.5 * (1 + segments / 2.0) * speed * dt / 2;
}

} // namespace

TEST_CASE("P13 a struck cantilever comes to rest where its N segments should", "[reference][P13]") {
    for (const ParkesCase& c : parkes_cases) {
        const double dt = c.answers.front().stop / 4000;
        for (const ParkesAnswer& exact : c.answers) {
            INFO("case " << c.name << ", N = " << exact.segments);
            const BeamEnd end = strike_cantilever(c.parameters, exact.segments, dt);
            const double allowed = shortfall(c.parameters.speed, exact.segments, dt);
            CHECK(std::abs(end.deflection - exact.tip) < allowed);
            CHECK(std::abs(end.root - exact.root) < allowed);
            CHECK(std::abs(end.time - exact.stop) < 5 * dt);
            CHECK(end.struck_energy == Approx(exact.struck_energy).epsilon(1e-8));
            CHECK(std::abs(end.ledger) < 1e-10 * exact.struck_energy);
            CHECK(end.residual < 1e-9);
        }
    }
}

TEST_CASE("P13 the error of the tip falls with the step", "[reference][P13]") {
    for (const ParkesCase& c : parkes_cases) {
        for (const ParkesAnswer& exact : c.answers) {
            // light segments under a heavy mass pass their first hinges in less than these steps
            const int most = std::string(c.name) == "c" ? 2 : 5;
            if (exact.segments > most || exact.segments == 4) continue;
            expect_trends("P13" + std::string(c.name) + ", N = " + std::to_string(exact.segments),
                          [&](double dt) {
                              std::vector<Quantity> all = p13_cantilever(c.parameters, exact, dt);
                              return std::vector<Quantity>{all[0], all[3], all[4]};
                          },
                          {.dt = 8e-4 * c.answers.front().stop});
        }
    }
}

TEST_CASE("P13 five segments give the exact discrete figures", "[reference][P13]") {
    // symplectic Euler with exact rows
    const BeamEnd coarse = strike_cantilever(parkes_cases[0].parameters, 5, 1e-3);
    CHECK(coarse.deflection == Approx(0.04983089).epsilon(2e-7));
    CHECK(coarse.root == Approx(0.03813839).epsilon(2e-7));
    const BeamEnd fine = strike_cantilever(parkes_cases[0].parameters, 5, 1e-4);
    CHECK(fine.deflection == Approx(0.05358069).epsilon(2e-7));
    CHECK(fine.root == Approx(0.04069901).epsilon(2e-7));
}

TEST_CASE("P13 finite rotation moves the tip by less than a thousandth", "[reference][P13]") {
    // exact for the large-angle chain: tip y 0.05377271, root 0.04077867
    const BeamEnd end = strike_cantilever(parkes_cases[0].parameters, 5, 2e-6, Kinematics::finite);
    CHECK(end.deflection == Approx(0.05377271).epsilon(3e-4));
    CHECK(end.root == Approx(0.04077867).epsilon(3e-4));
}
