// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

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
