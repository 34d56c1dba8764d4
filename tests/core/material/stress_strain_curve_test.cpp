// SPDX-License-Identifier: MIT
#include "ductile/material/stress_strain_curve.hpp"
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include "support/property.hpp"
#include "support/throws.hpp"

using namespace ductile;
using ductile::test::message_of;

namespace {

constexpr double E = 200e9;

template <class S>
StressStrainCurve<S> hardening_then_softening() {
    return StressStrainCurve<S>({.youngs_modulus = S(E),
                                 .points = {{S(0.001), S(200e6)},
                                            {S(0.011), S(300e6)},
                                            {S(0.111), S(400e6)},
                                            {S(0.211), S(350e6)}}});
}

std::string message_for(std::vector<StressStrainPoint<double>> points, double modulus = E) {
    return message_of([&] {
        StressStrainCurve<double>({.youngs_modulus = modulus, .points = std::move(points)});
    });
}

} // namespace

TEMPLATE_TEST_CASE("a stress-strain curve is straight between its pairs and level beyond them",
                   "[material]", float, double) {
    using S = TestType;
    const auto curve = hardening_then_softening<S>();
    const S eps = 8 * std::numeric_limits<S>::epsilon();
    const auto near = [&](double value) { return Approx(value).epsilon(eps); };
    CHECK(curve.stress(S(0)) == 0);
    CHECK(curve.stress(S(0.0005)) == near(100e6));
    CHECK(curve.stress(S(0.001)) == near(200e6));
    CHECK(curve.stress(S(0.006)) == near(250e6));
    CHECK(curve.stress(S(0.061)) == near(350e6));
    CHECK(curve.stress(S(0.161)) == near(375e6));
    CHECK(curve.stress(S(0.211)) == near(350e6));
    CHECK(curve.stress(S(1)) == near(350e6));
    CHECK(curve.stress(S(-0.006)) == near(-250e6));
    CHECK(curve.stress(std::numeric_limits<S>::infinity()) == near(350e6));

    CHECK(curve.tangent(S(0)) == near(E));
    CHECK(curve.tangent(S(-0.0005)) == near(E));
    CHECK(curve.tangent(S(0.006)) == near(10e9));
    CHECK(curve.tangent(S(0.161)) == near(-0.5e9));
    CHECK(curve.tangent(S(0.5)) == 0);
    CHECK(curve.tangent(S(0.001)) == near(10e9)); // at a pair, of the piece beyond
    CHECK(curve.tangent(S(0.211)) == 0);

    CHECK(curve.youngs_modulus() == near(E));
    CHECK(curve.yield_strain() == S(0.001));
    CHECK(curve.yield_stress() == S(200e6));
    CHECK(curve.ultimate_strain() == S(0.211));
    CHECK(curve.points().size() == 4);
}

TEST_CASE("the tangent of a stress-strain curve is its slope, and the curve is odd", "[material]") {
    const auto curve = hardening_then_softening<double>();
    test::prop("", [&] {
        const double strain = *rc::gen::inRange(-260, 260) * 1e-3 + 0.3e-3; // never at a pair
        const double step = 1e-7;
        const double slope =
            (curve.stress(strain + step) - curve.stress(strain - step)) / (2 * step);
        // differences of stresses of 4e8 Pa known to 1e-16, over 2e-7
        RC_ASSERT(std::abs(slope - curve.tangent(strain)) < 1e6);
        RC_ASSERT(curve.stress(-strain) == -curve.stress(strain));
        RC_ASSERT(curve.tangent(-strain) == curve.tangent(strain));
    });
}

TEST_CASE("true and engineering values convert into each other", "[material]") {
    // eps = 0.1: ln 1.1 and 400 MPa x 1.1, Dieter (1986) ch. 8
    const auto converted = true_from_engineering<double>({.strain = 0.1, .stress = 400e6});
    CHECK(converted.strain == Approx(0.0953101798043).epsilon(1e-12));
    CHECK(converted.stress == Approx(440e6).epsilon(1e-15));
    test::prop("back and forth is the identity", [] {
        const StressStrainPoint<double> point{.strain = *rc::gen::inRange(1, 500) * 1e-3,
                                              .stress = *rc::gen::inRange(1, 1000) * 1e6};
        const auto back = engineering_from_true(true_from_engineering(point));
        RC_ASSERT(std::abs(back.strain - point.strain) < 1e-14);
        RC_ASSERT(std::abs(back.stress - point.stress) < 1e-14 * point.stress);
    });
}

TEST_CASE("an elastic-perfectly plastic curve has two pairs", "[material]") {
    const auto curve = elastic_perfectly_plastic(210e9, 355e6, 0.2);
    CHECK(curve.yield_strain() == 355e6 / 210e9);
    CHECK(curve.stress(0.1) == 355e6);
    CHECK(curve.tangent(0.1) == 0);
}

TEST_CASE("a stress-strain curve says which pair it cannot use", "[material]") {
    CHECK(message_for({{0.001, 200e6}, {0.01, 200e6}}, -1) ==
          "StressStrainCurve.youngs_modulus = -1 Pa: must be finite and > 0");
    CHECK(message_for({{0.001, 200e6}}) ==
          "StressStrainCurve.points = 1: must be at least 2 pairs");
    CHECK(message_for({{0, 0}, {0.001, 200e6}}) ==
          "StressStrainCurve.points[0].strain = 0: must be finite and > 0");
    CHECK(message_for({{0.001, 200e6}, {0.002, -1}}) ==
          "StressStrainCurve.points[1].stress = -1 Pa: must be finite and > 0");
    CHECK(message_for({{0.001, 200e6}, {0.002, 0}}) ==
          "StressStrainCurve.points[1].stress = 0 Pa: must be finite and > 0");
    CHECK(message_for({{0.001, 200e6}, {std::numeric_limits<double>::quiet_NaN(), 0}}) ==
          "StressStrainCurve.points[1].strain = nan: must be finite and > 0");
    CHECK(message_for({{0.001, 200e6}, {0.001, 250e6}}) ==
          "StressStrainCurve.points[1].strain = 0.001: must be > the strain before it");
    CHECK(
        message_for({{0.001, 197e6}, {0.01, 250e6}}) ==
        "StressStrainCurve.points[0].stress = 197000000 Pa: must be youngs_modulus * strain within "
        "1 %: a curve starts elastic");
    CHECK(message_for({{0.001, 200e6}, {0.002, 500e6}}) ==
          "StressStrainCurve.points[1].stress = 500000000 Pa: must be reached with a slope <= "
          "youngs_modulus");
    // a table rounded to three digits is still elastic
    CHECK(message_for({{0.00169, 355e6}, {0.01, 355e6}}, 210e9) == "nothing thrown");
}
