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

TEST_CASE("the numbers are those of the standards", "[material]") {
    struct Row {
        MaterialParameters<double> named;
        double density, modulus, poisson, yield, strain; // kg/m³, GPa, -, MPa, %
        double tensile, factor;                          // R_m [MPa], sigma_f'/R_m; 0: none
    };
    for (const Row& row : {Row{s235<double>(), 7850, 210, 0.3, 235, 26, 360, 1.5},
                           Row{s355<double>(), 7850, 210, 0.3, 355, 22, 470, 1.5},
                           Row{b500b<double>(), 7850, 200, 0.3, 500, 5, 1.08 * 500, 1.5},
                           Row{aluminium_6061_t6<double>(), 2700, 70, 0.3, 240, 8, 260, 1.67},
                           Row{cast_iron_gjl_250<double>(), 7200, 110, 0.26, 165, 0.3, 0, 0}}) {
        INFO("f_y = " << row.yield << " MPa");
        CHECK(row.named.density == Approx(row.density).epsilon(1e-12));
        CHECK(row.named.youngs_modulus == Approx(row.modulus * 1e9).epsilon(1e-12));
        CHECK(row.named.poisson_ratio == Approx(row.poisson).epsilon(1e-12));
        CHECK(row.named.yield_stress == Approx(row.yield * 1e6).epsilon(1e-12));
        CHECK(row.named.ultimate_strain == Approx(row.strain / 100).epsilon(1e-12));
        REQUIRE(row.named.fatigue.has_value() == (row.tensile > 0));
        if (row.tensile > 0) {
            CHECK(row.named.fatigue->strength_coefficient ==
                  Approx(row.factor * row.tensile * 1e6).epsilon(1e-12));
        }
    }
}
