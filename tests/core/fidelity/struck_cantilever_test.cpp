// SPDX-License-Identifier: MIT
//
// The closed form of the chain against the chain itself, stepped with exact rows by the reference
// integrator, and the choice of segments and step against what they then really give.
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <vector>

#include "ductile/fidelity/struck_cantilever.hpp"
#include "reference/problems/impact.hpp"
#include "support/throws.hpp"

using namespace ductile;
using Catch::Matchers::Contains;
using ductile::test::message_of;

namespace {

StruckCantilever<double> beam(double tip_mass, double speed) {
    return {.length = 1,
            .mass_per_length = 2,
            .plastic_moment = 100,
            .tip_mass = tip_mass,
            .speed = speed};
}
/// P13 a, b, c.
const std::vector<StruckCantilever<double>> cases{beam(1, 4), beam(0.2, 10), beam(20, 1)};

/// Deflection of the tip of the stepped chain [m]; `inertia` of a segment over its mass × length².
double stepped(const StruckCantilever<double>& c, int segments, double dt, double inertia) {
    reference::Beam<double> chain({.length = c.length,
                                   .mass_per_length = c.mass_per_length,
                                   .plastic_moment = c.plastic_moment,
                                   .segments = segments,
                                   .left = reference::Support::clamped,
                                   .right = reference::Support::free,
                                   .tip_mass = c.tip_mass,
                                   .segment_inertia = inertia});
    auto impulse = chain.world().no_load();
    chain.add_force(impulse, c.length, c.tip_mass * c.speed);
    chain.world().strike(impulse);
    const auto none = chain.world().no_load();
    return reference::run_to_rest(chain, segments, segments, dt, [&](double) { return none; })
        .deflection;
}

} // namespace

TEST_CASE("the continuum is Parkes' cantilever", "[struck_cantilever]") {
    // printed digits of P13
    CHECK(continuum_deflection(cases[0]) == Approx(0.050301183).epsilon(1e-8));
    CHECK(continuum_deflection(cases[1]) == Approx(0.0294456818).epsilon(1e-8));
    CHECK(continuum_deflection(cases[2]) == Approx(0.096799584).epsilon(1e-8));
    CHECK(chain_deflection(cases[0], 1) == Approx(0.048).epsilon(1e-12));
    CHECK(chain_deflection(cases[1], 1) == Approx(0.0230769231).epsilon(1e-8));
    CHECK(chain_deflection(cases[2], 1) == Approx(0.0967741935).epsilon(1e-8));
}

TEST_CASE("a chain with its mass at the joints does what the closed form says",
          "[struck_cantilever]") {
    for (const auto& c : cases) {
        const double stop = c.tip_mass * c.speed * c.length / c.plastic_moment;
        for (const int n : {1, 2, 3, 5, 8}) {
            INFO("beta = " << c.mass_ratio() << ", N = " << n);
            // stopped V_1 dt/2 short, second order beyond that
            const double dt = stop / 4000;
            const double inertia = n > 1 ? 1.0 / 4 : 1.0 / 12;
            const double whole = stepped(c, n, dt, inertia) + chain_start_speed(c, n) * dt / 2;
            CHECK(whole == Approx(chain_deflection(c, n)).epsilon(1e-5));
        }
    }
}

TEST_CASE("the inertia that breaks the tie moves nothing", "[struck_cantilever]") {
    for (const auto& c : cases) {
        for (const int n : {2, 5, 8}) {
            const double dt = c.tip_mass * c.speed * c.length / c.plastic_moment / 4000;
            const double with = stepped(c, n, dt, segment_inertia(1.0, 1.0, n));
            CHECK(with == Approx(stepped(c, n, dt, 0.25)).epsilon(1e-3));
        }
    }
    CHECK(segment_inertia(3.0, 2.0, 1) == Approx(1).epsilon(1e-15));
}

TEST_CASE("its error falls with the square of the number of segments", "[struck_cantilever]") {
    for (const auto& c : cases) {
        const auto error = [&](int n) {
            return 1 - chain_deflection(c, n) / continuum_deflection(c);
        };
        INFO("beta = " << c.mass_ratio());
        CHECK(error(160) > 0);
        CHECK(error(80) / error(160) == Approx(4).epsilon(0.05));
        CHECK(error(40) / error(80) == Approx(4).epsilon(0.1));
    }
}

TEST_CASE("the segments and the step chosen keep the tolerance", "[struck_cantilever]") {
    for (const auto& c : cases) {
        const double exact = continuum_deflection(c);
        for (const double tolerance : {0.1, 0.03, 0.01}) {
            const auto choice = choose_segments(c, {.tolerance = tolerance});
            INFO("beta = " << c.mass_ratio() << ", " << choice.reason);
            CHECK(choice.error <= 0.95 * tolerance * (1 + 1e-12));
            const double inertia = segment_inertia(1.0, 1.0, choice.segments);
            const double error =
                std::abs(stepped(c, choice.segments, choice.dt, inertia) / exact - 1);
            CHECK(error <= tolerance);
            CHECK(error == Approx(choice.error).epsilon(0.1));
        }
    }
}

TEST_CASE("no other number of segments is cheaper", "[struck_cantilever]") {
    for (const auto& c : cases) {
        for (const double tolerance : {0.1, 0.01}) {
            const SegmentParameters<double> p{.tolerance = tolerance, .cost_power = 2};
            const auto best = choose_segments(c, p);
            const double cost = std::pow(best.segments, 2.0) / best.dt;
            for (int n = 1; n <= 40; ++n) {
                const double exact = continuum_deflection(c);
                const double left = 0.95 * tolerance - 1 + chain_deflection(c, n) / exact;
                if (left <= 0) continue;
                const double dt = std::min(2 * left * exact / chain_start_speed(c, n), 1.0 / 60);
                CHECK(cost <= n * n / dt * (1 + 1e-12));
            }
        }
    }
}

TEST_CASE("a heavy mass needs one segment, a light one many", "[struck_cantilever]") {
    CHECK(choose_segments(beam(20, 1), {.tolerance = 0.01}).segments == 1);
    CHECK(choose_segments(beam(0.2, 10), {.tolerance = 0.01}).segments > 15);
    const auto none = choose_segments(beam(0.2, 10), {.tolerance = 0.01, .most = 10});
    CHECK(none.segments == 0);
    CHECK(none.error == std::numeric_limits<double>::infinity());
    CHECK(none.reason == "no number up to 10 leaves an error of 0.95 % or less");
    CHECK_THAT(choose_segments(beam(1, 4), {.tolerance = 0.1}).reason,
               Contains("1 segments are off by 4.57 %, steps of "));
}

TEST_CASE("float chooses the same segments as double", "[struck_cantilever]") {
    const StruckCantilever<float> c{
        .length = 1, .mass_per_length = 2, .plastic_moment = 100, .tip_mass = 1, .speed = 4};
    const auto choice = choose_segments(c, {.tolerance = 0.03f});
    const auto exact = choose_segments(cases[0], {.tolerance = 0.03});
    CHECK(choice.segments == exact.segments);
    CHECK(choice.dt == Approx(exact.dt).epsilon(1e-3));
}

TEST_CASE("a struck cantilever refuses what makes none, by name", "[struck_cantilever]") {
    const auto with = [](auto&& change) {
        auto c = beam(1, 4);
        SegmentParameters<double> p;
        change(c, p);
        return message_of([&] { (void)choose_segments(c, p); });
    };
    CHECK(with([](auto&, auto&) {}) == "nothing thrown");
    CHECK(with([](auto& c, auto&) { c.tip_mass = 0; }) ==
          "StruckCantilever.tip_mass = 0 kg: must be finite and > 0");
    CHECK(with([](auto& c, auto&) { c.speed = NAN; }) ==
          "StruckCantilever.speed = nan m/s: must be finite and > 0");
    CHECK(with([](auto&, auto& p) { p.tolerance = 0; }) ==
          "Segments.tolerance = 0: must be in (0, 1)");
    CHECK(with([](auto&, auto& p) { p.reserve = 1; }) == "Segments.reserve = 1: must be in (0, 1)");
    CHECK(with([](auto&, auto& p) { p.most = 0; }) == "Segments.most = 0: must be >= 1");
}
