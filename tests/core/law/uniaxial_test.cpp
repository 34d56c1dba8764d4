// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>

#include "ductile/law/uniaxial.hpp"
#include "support/property.hpp"
#include "support/throws.hpp"

using namespace ductile;
using ductile::test::message_of;

namespace {
static_assert(!UniaxialCurve<double>);

const RambergOsgood curve(RambergOsgoodParameters<double>{
    .youngs_modulus = 200e9, .coefficient = 1200e6, .exponent = 0.15});

/// A curve that says nothing of its modulus.
struct Tangens {
    using Scalar = double;
    double stress(double strain) const { return 400e6 * std::tanh(500 * strain); }
};
} // namespace

TEST_CASE("Ramberg-Osgood takes its reference values (P09)", "[law][uniaxial]") {
    constexpr double printed = 1e-8;
    CHECK(curve.strain(300e6) == Approx(0.00159688727).epsilon(printed));
    CHECK(curve.plastic_strain(300e6) == Approx(9.68872712e-05).epsilon(printed));
    CHECK(curve.loop_energy(300e6) == Approx(85934.7971).epsilon(printed));
    CHECK(curve.strain(500e6) == Approx(0.00541916329).epsilon(printed));
    CHECK(curve.plastic_strain(500e6) == Approx(0.00291916329).epsilon(printed));
    CHECK(curve.loop_energy(500e6) == Approx(4315284.86).epsilon(printed));
    CHECK(curve.stress(0.01) == Approx(571.80118e6).epsilon(printed));
}

TEMPLATE_TEST_CASE("Ramberg-Osgood inverts itself from tiny to huge strains",
                   "[law][uniaxial][property]", float, double) {
    using S = TestType;
    test::prop("there and back, odd", [] {
        const RambergOsgood law(
            RambergOsgoodParameters<S>{.youngs_modulus = S(200e9),
                                       .coefficient = S(1200e6),
                                       .exponent = S(*rc::gen::inRange(5, 95)) / 100});
        const S strain = S(std::pow(10.0, *rc::gen::inRange(-8000, 1000) / 1000.0));
        const S stress = law.stress(strain);
        // (σ/K)^(1/n) magnifies the round-off of σ by 1/n <= 20
        const S round_off = 100 * std::numeric_limits<S>::epsilon();
        RC_ASSERT(std::abs(law.strain(stress) - strain) <= round_off * strain);
        RC_ASSERT(law.stress(-strain) == -stress);
        RC_ASSERT(law.stress(S(1.1) * strain) > stress);
    });
    CHECK(RambergOsgood(
              RambergOsgoodParameters<S>{.youngs_modulus = 1, .coefficient = 1, .exponent = S(0.5)})
              .stress(0) == 0);
}

TEST_CASE("the bilinear curve is elastic, then on its second slope", "[law][uniaxial]") {
    const BilinearCurve steel(BilinearCurveParameters<double>{
        .youngs_modulus = 200e9, .yield_stress = 250e6, .slope_ratio = 0.02});
    CHECK(steel.stress(0.001) == 200e6);
    CHECK(steel.stress(0.00225) == Approx(250e6 + 0.02 * 200e6).epsilon(1e-14));
    CHECK(steel.stress(-0.00225) == -steel.stress(0.00225));
    const BilinearCurve perfect(
        BilinearCurveParameters<double>{.youngs_modulus = 200e9, .yield_stress = 250e6});
    CHECK(perfect.stress(1.0) == 250e6);
}

TEST_CASE("the modulus is what a curve says, or the slope where it starts", "[law][uniaxial]") {
    CHECK(initial_modulus(curve) == 200e9);
    CHECK(initial_modulus(Tangens{}) == Approx(200e9).epsilon(1e-6));
}

TEST_CASE("curves refuse bad parameters by name, value, unit and range", "[law][uniaxial][input]") {
    CHECK(message_of([] { BilinearCurve<double>({.yield_stress = 1}); }) ==
          "BilinearCurve.youngs_modulus = nan Pa: must be finite and > 0");
    CHECK(message_of([] { BilinearCurve<double>({.youngs_modulus = 1, .yield_stress = 0}); }) ==
          "BilinearCurve.yield_stress = 0 Pa: must be finite and > 0");
    CHECK(message_of([] {
              BilinearCurve<double>({.youngs_modulus = 1, .yield_stress = 1, .slope_ratio = 2});
          }) == "BilinearCurve.slope_ratio = 2: must be in [0, 1]");
    CHECK(message_of([] {
              RambergOsgood<double>({.youngs_modulus = 1, .coefficient = 1, .exponent = 1});
          }) == "RambergOsgood.exponent = 1: must be in (0, 1)");
    CHECK(message_of([] { RambergOsgood<double>({.youngs_modulus = 1, .exponent = 0.1}); }) ==
          "RambergOsgood.coefficient = nan Pa: must be finite and > 0");
    CHECK(message_of([] { RambergOsgood<double>({.coefficient = 1, .exponent = 0.1}); }) ==
          "RambergOsgood.youngs_modulus = nan Pa: must be finite and > 0");
}
