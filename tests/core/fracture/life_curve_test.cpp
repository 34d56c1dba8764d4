// SPDX-License-Identifier: MIT
//
// Reference: P21 of tests/reference (Coffin-Manson with ε_f' = 1, c = -0.6; total strain
// with σ_f' = 900 MPa, b = -0.09, E = 200 GPa).
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include "ductile/fracture/coffin_manson.hpp"
#include "ductile/fracture/hinge_strain.hpp"
#include "ductile/fracture/total_strain_life.hpp"
#include "support/property.hpp"
#include "support/throws.hpp"

using namespace ductile;
using ductile::test::message_of;

namespace {

constexpr double printed = 2e-9; // the table is given to nine digits
constexpr double pi = std::numbers::pi;

const CoffinManson<double> plastic({.ductility_coefficient = 1, .ductility_exponent = -0.6});

template <class S>
constexpr TotalStrainLifeParameters<S> steel{.ductility_coefficient = 1,
                                             .ductility_exponent = S(-0.6),
                                             .strength_coefficient = S(900e6),
                                             .strength_exponent = S(-0.09),
                                             .youngs_modulus = S(200e9)};
const TotalStrainLife<double> total(steel<double>);

} // namespace

TEST_CASE("Coffin-Manson gives the tabulated lives", "[fracture][P21]") {
    const double table[][2] = {{0.005, 6839.90379}, {0.01, 2154.43469}, {0.02, 678.604404},
                               {0.05, 147.36126},   {0.1, 46.4158883},  {0.2, 14.6200887}};
    const CoffinManson<float> single({.ductility_coefficient = 1, .ductility_exponent = -0.6F});
    for (const auto& [amplitude, reversals] : table) {
        CHECK(plastic.reversals(amplitude) == Approx(reversals).epsilon(printed));
        CHECK(plastic.amplitude(reversals) == Approx(amplitude).epsilon(printed));
        CHECK(single.reversals(float(amplitude)) == Approx(reversals).epsilon(2e-6));
    }
    CHECK(plastic.reversals(0) == std::numeric_limits<double>::infinity());
    CHECK(plastic.amplitude(std::numeric_limits<double>::infinity()) == 0);
    CHECK(plastic.reversals(1) == 1);
}

TEST_CASE("a paperclip bent by 90 degrees lasts the tabulated number of cycles",
          "[fracture][P21]") {
    const double k = hinge_strain<double>({.height = 1e-3, .hinge_length = 3e-3});
    const double one_side = k * (pi / 2) / 2; // 0 <-> 90 deg
    const double both = k * (pi / 2);         // +-90 deg
    CHECK(one_side == Approx(0.1308997).epsilon(5e-7));
    CHECK(both == Approx(0.2617994).epsilon(5e-7));
    CHECK(plastic.reversals(one_side) / 2 == Approx(14.81627).epsilon(5e-7));
    CHECK(plastic.reversals(both) / 2 == Approx(4.666833).epsilon(5e-7));
}

TEST_CASE("a steel hinge lasts the tabulated number of cycles", "[fracture][P21]") {
    const double k = hinge_strain<double>({.height = 0.1, .hinge_length = 0.1});
    CHECK(k == 0.5);
    CHECK(plastic.reversals(k * 0.02) / 2 == Approx(1077.217).epsilon(5e-7));
    CHECK(plastic.reversals(k * 0.05) / 2 == Approx(233.9214).epsilon(5e-7));
    CHECK(bar_strain<double>({.length = 0.25}) == 4);
}

TEST_CASE("total strain gives the tabulated lives and transition", "[fracture][P21]") {
    CHECK(total.reversals(0.005) == Approx(15112.99).epsilon(5e-7));
    CHECK(total.reversals(0.01) == Approx(3241.603).epsilon(5e-7));
    CHECK(total.reversals(0.02) == Approx(844.0375).epsilon(5e-7));
    CHECK(total.transition_reversals() == Approx(39952.51).epsilon(5e-7));
    const double transition = total.transition_reversals();
    CHECK(total.elastic_amplitude(transition) ==
          Approx(total.plastic_amplitude(transition)).epsilon(1e-13));
    CHECK(TotalStrainLife<float>(steel<float>).reversals(0.01F) == Approx(3241.603).epsilon(1e-5));
}

TEST_CASE("total strain tends to Coffin-Manson at large and to Basquin at small amplitude",
          "[fracture]") {
    CHECK(total.reversals(1e4) == Approx(plastic.reversals(1e4)).epsilon(1e-5));
    const double basquin = std::pow(1e-4 * 200e9 / 900e6, 1 / -0.09);
    CHECK(total.reversals(1e-4) == Approx(basquin).epsilon(1e-4));
    CHECK(total.reversals(0) == std::numeric_limits<double>::infinity());
    CHECK(total.reversals(std::numeric_limits<double>::infinity()) == 0);
}

TEST_CASE("life curves are inverted to round-off and decrease", "[fracture]") {
    test::prop(
        "amplitude(reversals(a)) is a, for any constants and twelve decades of amplitude", [] {
            const auto real = [](double low, double high) {
                return low + (high - low) * *rc::gen::inRange(0, 1'000'001) / 1e6;
            };
            const double c = real(-1.9, -0.05);
            const double b = c * real(0.01, 0.99);
            const TotalStrainLife<double> curve({.ductility_coefficient = std::pow(10, real(-3, 1)),
                                                 .ductility_exponent = c,
                                                 .strength_coefficient = std::pow(10, real(7, 10)),
                                                 .strength_exponent = b,
                                                 .youngs_modulus = std::pow(10, real(9, 12))});
            const double amplitude = std::pow(10, real(-8, 4));
            const double life = curve.reversals(amplitude);
            RC_ASSERT(!std::isnan(life));
            if (!std::isfinite(life) || life < 1e-280) return; // out of range, said honestly
            // x = ln 2N is good to a few ε|x|, ε_a goes with exp(c x)
            const double bound = 1e-15 * (8 + 8 * std::abs(c * std::log(life)));
            RC_ASSERT(std::abs(curve.amplitude(life) / amplitude - 1) < bound);
            RC_ASSERT(curve.reversals(amplitude * 1.001) < life);
        });
}

TEST_CASE("life curves name the constant that is missing or out of range", "[fracture]") {
    CHECK(message_of([] { CoffinManson<double>({}); }) ==
          "CoffinManson.ductility_coefficient = nan: must be finite and > 0");
    CHECK(message_of([] {
              CoffinManson<double>({.ductility_coefficient = 1, .ductility_exponent = 0.6});
          }) == "CoffinManson.ductility_exponent = 0.6: must be in (-2, 0)");
    const auto message = [](auto change) {
        auto parameters = steel<double>;
        change(parameters);
        return message_of([&] { TotalStrainLife<double>{parameters}; });
    };
    CHECK(message([](auto& p) { p.ductility_coefficient = -1; }) ==
          "TotalStrainLife.ductility_coefficient = -1: must be finite and > 0");
    CHECK(message([](auto& p) { p.ductility_exponent = -2; }) ==
          "TotalStrainLife.ductility_exponent = -2: must be in (-2, 0)");
    CHECK(message([](auto& p) { p.strength_coefficient = 0; }) ==
          "TotalStrainLife.strength_coefficient = 0 Pa: must be finite and > 0");
    CHECK(message([](auto& p) { p.strength_exponent = -0.7; }) ==
          "TotalStrainLife.strength_exponent = -0.7: must be in (-0.6, 0)");
    CHECK(message([](auto& p) { p.youngs_modulus = std::nan(""); }) ==
          "TotalStrainLife.youngs_modulus = nan Pa: must be finite and > 0");
    CHECK(message_of([] { (void)hinge_strain<double>({.height = 0, .hinge_length = 1}); }) ==
          "HingeStrain.height = 0 m: must be finite and > 0");
    CHECK(message_of([] { (void)hinge_strain<double>({.height = 1}); }) ==
          "HingeStrain.hinge_length = nan m: must be finite and > 0");
    CHECK(message_of([] { (void)bar_strain<double>({}); }) ==
          "BarStrain.length = nan m: must be finite and > 0");
}
