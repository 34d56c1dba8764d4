// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

#include "ductile/fracture/coffin_manson.hpp"
#include "ductile/law/moment_rotation.hpp"
#include "ductile/material/named.hpp"
#include "ductile/material/stress_strain_curve.hpp"
#include "ductile/section/rectangle.hpp"
#include "support/throws.hpp"

using namespace ductile;
using ductile::test::message_of;

TEMPLATE_TEST_CASE("every named material passes the checks of a material", "[material]", float,
                   double) {
    for (const auto& parameters :
         {s235<TestType>(), s355<TestType>(), b500b<TestType>(),
          aluminium_6061_t6_extruded<TestType>(), aluminium_6061_t6_sheet<TestType>(),
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
    CHECK(ductility(aluminium_6061_t6_extruded<double>()) > 15);
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

TEST_CASE("reinforcing bars last as those of Mander, Panthaki and Kasalanati", "[material]") {
    // 0.8 % plastic strain amplitude at 100 reversals, 2.5 % at ten; polished bars would stand five
    // times that
    const auto bar = b500b<double>().fatigue;
    REQUIRE(bar.has_value());
    const CoffinManson<double> life({.ductility_coefficient = bar->ductility_coefficient,
                                     .ductility_exponent = bar->ductility_exponent});
    CHECK(life.amplitude(100) == Approx(0.008).epsilon(1e-9));
    CHECK(life.amplitude(10) == Approx(0.0253).epsilon(1e-3));
    CHECK(bar->strength_coefficient == 0); // not of polished bars either
    const auto polished = detail::uniform_law_of_steel(540e6);
    CHECK(polished.ductility_coefficient * std::pow(100, polished.ductility_exponent) >
          5 * life.amplitude(100));
}

TEST_CASE("a named material gives a hardening law of a hinge", "[material]") {
    // straight from yield to the ultimate stress at the ultimate strain
    for (const auto& named :
         {s235<double>(), s355<double>(), b500b<double>(), aluminium_6061_t6_extruded<double>(),
          aluminium_6061_t6_sheet<double>(), cast_iron_gjl_250<double>()}) {
        const Material material(named);
        INFO("f_y = " << material.yield_stress());
        const auto curve = elastic_hardening(material);
        CHECK(curve.stress(material.yield_strain()) == Approx(material.yield_stress()));
        CHECK(curve.stress(material.ultimate_strain()) == Approx(*material.ultimate_stress()));
        CHECK(curve.stress(0) == 0); // exactly, or a section without axial force has one
        CHECK(curve.youngs_modulus() == Approx(material.youngs_modulus()));
        if (material.ultimate_strain() < 15 * material.yield_strain()) continue; // brittle
        // a rectangle, its outermost fibre strained up to fracture
        const double width = 0.02, height = 0.03, length = 0.03;
        const double last = material.ultimate_strain() / (height / 2);
        const auto hinge = moment_rotation(
            MomentCurvature(Rectangle<double>({.width = width, .height = height}), curve),
            {.length = length, .curvature_max = last});
        const double plastic = width * height * height / 4, turn = last * length;
        CHECK(hinge.backbone.value(turn) > plastic * material.yield_stress());
        CHECK(hinge.backbone.value(turn) < plastic * *material.ultimate_stress());
        CHECK(hinge.backbone.slope(turn / 2) > 0);
    }
}

TEST_CASE("a material without an ultimate stress has no hardening law, and says so", "[material]") {
    auto named = s235<double>();
    named.ultimate_stress.reset();
    CHECK(message_of([&] { (void)elastic_hardening(Material(named)); }) ==
          "Material.ultimate_stress = nan Pa: must be finite and > 0");
    named = s235<double>();
    named.ultimate_strain = std::numeric_limits<double>::infinity();
    CHECK(message_of([&] { (void)elastic_hardening(Material(named)); }) ==
          "Material.ultimate_strain = inf: must be finite and > 0");
}

TEST_CASE("the numbers are those of the standards", "[material]") {
    struct Row {
        MaterialParameters<double> named;
        double density, modulus, poisson, yield, strain; // kg/m³, GPa, -, MPa, %
        double tensile, factor;                          // f_u [MPa], sigma_f'/f_u; 0: none
    };
    for (const Row& row :
         {Row{s235<double>(), 7850, 210, 0.3, 235, 26, 360, 1.5},
          Row{s355<double>(), 7850, 210, 0.3, 355, 22, 470, 1.5},
          Row{b500b<double>(), 7850, 200, 0.3, 500, 5, 1.08 * 500, 0},
          Row{aluminium_6061_t6_extruded<double>(), 2700, 70, 0.3, 240, 8, 260, 1.67},
          Row{aluminium_6061_t6_sheet<double>(), 2700, 70, 0.3, 240, 6, 290, 1.67},
          Row{cast_iron_gjl_250<double>(), 7200, 110, 0.26, 165, 0.3, 250, 0}}) {
        INFO("f_y = " << row.yield << " MPa");
        CHECK(row.named.density == Approx(row.density).epsilon(1e-12));
        CHECK(row.named.youngs_modulus == Approx(row.modulus * 1e9).epsilon(1e-12));
        CHECK(row.named.poisson_ratio == Approx(row.poisson).epsilon(1e-12));
        CHECK(row.named.yield_stress == Approx(row.yield * 1e6).epsilon(1e-12));
        CHECK(row.named.ultimate_strain == Approx(row.strain / 100).epsilon(1e-12));
        REQUIRE(row.named.ultimate_stress.has_value());
        CHECK(*row.named.ultimate_stress == Approx(row.tensile * 1e6).epsilon(1e-12));
        if (row.factor > 0) {
            REQUIRE(row.named.fatigue.has_value());
            CHECK(row.named.fatigue->strength_coefficient ==
                  Approx(row.factor * row.tensile * 1e6).epsilon(1e-12));
        }
    }
}
