// SPDX-License-Identifier: MIT
//
// P15. A beam thrown against its supports, and one under a pressure pulse. The problem is
// symmetric, so its hinges yield and stop in exact ties.
#include <catch2/catch.hpp>

#include <cmath>
#include <string>

#include "reference/expect.hpp"
#include "reference/problems/impact.hpp"

using namespace ductile::reference;

TEST_CASE("P15a a thrown beam comes to rest where its N segments should", "[reference][P15]") {
    for (const Support ends : {Support::pinned, Support::clamped}) {
        for (const ThrowAnswer& exact : thrown_beams) {
            const bool pinned = ends == Support::pinned;
            INFO((pinned ? "pinned" : "clamped") << ", " << exact.per_half << " per half");
            const double stop = pinned ? exact.pinned_stop : exact.clamped_stop;
            const double dt = stop / 4000;
            const BeamEnd end = throw_beam({.ends = ends}, exact.per_half, 4, dt);
            const double shortfall = 1.5 * (1 + exact.per_half / 2.0) * 4 * dt / 2; // as in P13
            CHECK(std::abs(end.deflection - (pinned ? exact.pinned : exact.clamped)) < shortfall);
            CHECK(std::abs(end.time - stop) < 5 * dt);
            CHECK(end.struck_energy / 2 == Approx(exact.half_energy).epsilon(1e-6));
            CHECK(std::abs(end.ledger) < 1e-9);
            CHECK(end.residual < 1e-9);
        }
    }
}

TEST_CASE("P15a the error of the centre falls with the step", "[reference][P15]") {
    for (const Support ends : {Support::pinned, Support::clamped}) {
        for (const ThrowAnswer& exact : thrown_beams) {
            if (exact.per_half > 2) continue;
            const bool pinned = ends == Support::pinned;
            expect_trends(std::string("P15a ") + (pinned ? "pinned" : "clamped"),
                          [&](double dt) {
                              std::vector<Quantity> all = p15_thrown(ends, exact, dt);
                              return std::vector<Quantity>{all[0], all[2]};
                          },
                          {.dt = 8e-4 * (pinned ? 0.04 : 0.02), .steps = 16});
        }
    }
}

TEST_CASE(
    "P15b from rest to rest a pulse of twice the collapse load is exact at any step that "
    "divides it",
    "[reference][P15]") {
    // centre 3 p0 τ² (η - 1)/(4μ) = 0.015 m, at rest at η τ = 0.02 s
    for (const int per_half : {1, 2, 4, 10}) {
        for (const double dt : {1e-2, 1e-3, 1e-4}) {
            INFO(per_half << " per half, dt = " << dt);
            const BeamEnd end = push_beam({}, per_half, 2, 0.01, dt);
            CHECK(end.deflection == Approx(0.015).epsilon(1e-9));
            CHECK(end.time == Approx(0.02).epsilon(1e-9));
            CHECK(std::abs(end.ledger) < 1e-10);
        }
    }
}

TEST_CASE("P15b a pulse of six times the collapse load comes to rest where its N segments should",
          "[reference][P15]") {
    constexpr double tau = 0.004;
    for (const PushAnswer& exact : pushed_beams) {
        INFO(exact.per_half << " per half");
        const auto error = [&](int steps) {
            return p15_pushed(exact, tau / steps)[0].error() / exact.centre;
        };
        if (exact.per_half <= 2) {
            // every switch falls on a step; the answers have nine digits
            CHECK(std::abs(error(40)) < 2e-9);
        } else if (exact.per_half == 4) {
            CHECK(observed_order(error(10), error(80), 3) >= 1.8);
            CHECK(std::abs(error(160)) < 2e-7);
        } else {
            // a hinge that stops and one that starts share a step, which costs an order
            CHECK(observed_order(error(40), error(640), 4) >= 0.9);
            CHECK(std::abs(error(1280)) < 5e-6);
        }
    }
}
