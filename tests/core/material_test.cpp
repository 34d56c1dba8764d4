// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include <string>

#include "ductile/material.hpp"
#include "support/throws.hpp"

using ductile::Material;
using ductile::MaterialParameters;
using ductile::test::message_of;

namespace {
constexpr MaterialParameters<double> steel{
    .density = 7800, .youngs_modulus = 200e9, .poisson_ratio = 0.3, .yield_stress = 400e6};
}

TEST_CASE("a material keeps what it was given and derives the shear modulus", "[material]") {
    const Material material(steel);
    CHECK(material.density() == 7800);
    CHECK(material.youngs_modulus() == 200e9);
    CHECK(material.poisson_ratio() == 0.3);
    CHECK(material.yield_stress() == 400e6);
    CHECK(material.shear_modulus() == Approx(200e9 / 2.6).epsilon(1e-15));
}

TEST_CASE("a material names the parameter that is missing or out of range", "[material]") {
    CHECK(message_of([] { Material<double>({}); }) ==
          "Material.density = nan kg/m^3: must be finite and > 0");
    auto bad = steel;
    bad.yield_stress = -1;
    CHECK(message_of([&] { Material<double>{bad}; }) ==
          "Material.yield_stress = -1 Pa: must be finite and > 0");
    bad = steel;
    bad.poisson_ratio = 0.5;
    CHECK(message_of([&] { Material<double>{bad}; }) ==
          "Material.poisson_ratio = 0.5: must be in (-1, 0.5)");
    bad = steel;
    bad.youngs_modulus = std::numeric_limits<double>::infinity();
    CHECK(message_of([&] { Material<double>{bad}; }) ==
          "Material.youngs_modulus = inf Pa: must be finite and > 0");
}

TEST_CASE("a material whose yield stress and modulus are not both in Pa is refused", "[material]") {
    constexpr auto range = ": must be from 1e-7 to 1 of youngs_modulus, both in Pa";
    auto bad = steel;
    bad.yield_stress = 400; // MPa
    CHECK(message_of([&] { Material<double>{bad}; }) ==
          "Material.yield_stress = 400 Pa" + std::string(range));
    bad = steel;
    bad.youngs_modulus = 200; // GPa
    CHECK(message_of([&] { Material<double>{bad}; }) ==
          "Material.yield_stress = 400000000 Pa" + std::string(range));
    bad.youngs_modulus = 1e6; // rubber
    bad.yield_stress = 1e6;
    CHECK(message_of([&] { Material<double>{bad}; }) == "nothing thrown");
}

TEST_CASE("a material without a limit of strain or fatigue constants says so", "[material]") {
    const Material material(steel);
    CHECK(material.ultimate_strain() == std::numeric_limits<double>::infinity());
    CHECK_FALSE(material.fatigue().has_value());
    CHECK(material.yield_strain() == 0.002);
}

TEST_CASE("a material keeps its ultimate strain and fatigue constants", "[material]") {
    auto parameters = steel;
    parameters.ultimate_strain = 0.2;
    parameters.fatigue =
        ductile::FatigueConstants<double>{.ductility_coefficient = 1, .ductility_exponent = -0.6};
    const Material material(parameters);
    CHECK(material.ultimate_strain() == 0.2);
    REQUIRE(material.fatigue().has_value());
    CHECK(*material.fatigue() == *parameters.fatigue);
    CHECK(material.fatigue()->strength_coefficient == 0);
}

TEST_CASE("a material names the limit of strain or fatigue constant that is out of range",
          "[material]") {
    auto bad = steel;
    bad.ultimate_strain = 0.002;
    CHECK(message_of([&] { Material<double>{bad}; }) ==
          "Material.ultimate_strain = 0.002: must be > yield_stress / youngs_modulus (infinity: no "
          "limit)");
    bad.ultimate_strain = std::numeric_limits<double>::quiet_NaN();
    CHECK(message_of([&] { Material<double>{bad}; }) ==
          "Material.ultimate_strain = nan: must be > 0 (infinity: no limit)");

    const auto with = [](ductile::FatigueConstants<double> fatigue) {
        return message_of([&] {
            auto parameters = steel;
            parameters.fatigue = fatigue;
            Material<double>{parameters};
        });
    };
    CHECK(with({}) == "FatigueConstants.ductility_coefficient = nan: must be finite and > 0");
    CHECK(with({.ductility_coefficient = 1}) ==
          "FatigueConstants.ductility_exponent = nan: must be in (-1, 0)");
    CHECK(with({.ductility_coefficient = 1, .ductility_exponent = 0.6}) ==
          "FatigueConstants.ductility_exponent = 0.6: must be in (-1, 0)");
    CHECK(
        with(
            {.ductility_coefficient = 1, .ductility_exponent = -0.6, .strength_coefficient = -1}) ==
        "FatigueConstants.strength_coefficient = -1 Pa: must be finite and >= 0");
    CHECK(with({.ductility_coefficient = 1,
                .ductility_exponent = -0.6,
                .strength_coefficient = 900e6}) ==
          "FatigueConstants.strength_exponent = 0: must be in (-1, 0)");
    CHECK(with({.ductility_coefficient = 1,
                .ductility_exponent = -0.6,
                .strength_coefficient = 900e6,
                .strength_exponent = -0.09}) == "nothing thrown");
}

TEST_CASE("a material names an ultimate stress that is out of range", "[material]") {
    auto parameters = steel;
    CHECK_FALSE(Material(parameters).ultimate_stress().has_value());
    parameters.ultimate_stress = 400e6;
    CHECK(Material(parameters).ultimate_stress() == 400e6);
    parameters.ultimate_stress = 399e6;
    CHECK(message_of([&] { Material<double>{parameters}; }) ==
          "Material.ultimate_stress = 399000000 Pa: must be >= yield_stress");
    parameters.ultimate_stress = std::numeric_limits<double>::quiet_NaN();
    CHECK(message_of([&] { Material<double>{parameters}; }) ==
          "Material.ultimate_stress = nan Pa: must be finite and > 0");
}
