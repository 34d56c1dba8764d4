// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include "ductile/material/named.hpp"

using namespace ductile;

TEMPLATE_TEST_CASE("every named material passes the checks of a material", "[material]", float,
                   double) {
    for (const auto& parameters :
         {s235<TestType>(), s355<TestType>(), b500b<TestType>(), aluminium_6061_t6<TestType>(),
          cast_iron_gjl_250<TestType>()}) {
        CHECK_NOTHROW(Material<TestType>(parameters));
    }
}

TEST_CASE("the steels are named after their yield stress", "[material]") {
    STATIC_REQUIRE(s235<double>().yield_stress == 235e6);
    STATIC_REQUIRE(s355<double>().yield_stress == 355e6);
    STATIC_REQUIRE(b500b<double>().yield_stress == 500e6);
}

TEST_CASE("cast iron breaks soon after it yields, steel long after", "[material]") {
    const auto ductility = [](const MaterialParameters<double>& parameters) {
        const Material material(parameters);
        return material.ultimate_strain() / material.yield_strain();
    };
    // EN 1993-1-1, 3.2.2 asks 15 of a steel for plastic analysis
    CHECK(ductility(s235<double>()) > 15);
    CHECK(ductility(s355<double>()) > 15);
    CHECK(ductility(b500b<double>()) > 15);
    CHECK(ductility(aluminium_6061_t6<double>()) > 15);
    CHECK(ductility(cast_iron_gjl_250<double>()) < 3);
    CHECK_FALSE(cast_iron_gjl_250<double>().fatigue.has_value());
}

TEST_CASE("fatigue constants of S355 follow the uniform material law", "[material]") {
    // Bäumel and Seeger (1990): sigma_f' = 1.5 R_m with R_m = 470 MPa
    const auto fatigue = s355<double>().fatigue;
    REQUIRE(fatigue.has_value());
    CHECK(fatigue->strength_coefficient == 705e6);
    CHECK(fatigue->strength_exponent == -0.087);
    CHECK(fatigue->ductility_coefficient == 0.59);
    CHECK(fatigue->ductility_exponent == -0.58);
}
