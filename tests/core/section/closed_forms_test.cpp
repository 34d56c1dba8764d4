// SPDX-License-Identifier: MIT
//
// Sections against closed forms and tabulated figures: rectangle, circle, tube, and the plastic moduli
// about the equal-area axis of T, channel and L (lengths in m).
#include <catch2/catch.hpp>
#include <limits>
#include <numbers>

#include "core/section/shapes.hpp"
#include "ductile/material.hpp"
#include "ductile/section/box.hpp"
#include "ductile/section/channel.hpp"
#include "ductile/section/circle.hpp"
#include "ductile/section/i_section.hpp"
#include "ductile/section/l_section.hpp"
#include "ductile/section/notched_rectangle.hpp"
#include "ductile/section/principal.hpp"
#include "ductile/section/rectangle.hpp"
#include "ductile/section/t_section.hpp"
#include "ductile/section/tube.hpp"

using namespace ductile;
using namespace ductile::test;

namespace {

constexpr auto x = SectionAxis::x;
constexpr auto y = SectionAxis::y;
constexpr double pi = std::numbers::pi;

/// A few dozen roundings.
template <class S>
constexpr S round_off = 64 * std::numeric_limits<S>::epsilon();

template <class S>
Approx near(double value) {
    return Approx(value).epsilon(round_off<S>);
}

/// A printed figure of seven digits or more.
Approx printed(double value) { return Approx(value).epsilon(5e-7); }

} // namespace

TEMPLATE_TEST_CASE("a rectangle has the moments of its closed forms about both axes", "[section]",
                   float, double) {
    using S = TestType;
    const Rectangle<S> section({.width = S(0.05), .height = S(0.1)});
    CHECK(section.area() == near<S>(0.005));
    CHECK(section.second_moment() == near<S>(0.05 * 1e-3 / 12));
    CHECK(section.second_moment(y) == near<S>(0.1 * 0.05 * 0.05 * 0.05 / 12));
    CHECK(section.elastic_modulus(x) == near<S>(0.05 * 0.01 / 6));
    CHECK(section.elastic_modulus(y) == near<S>(0.1 * 0.0025 / 6));
    CHECK(section.plastic_modulus(x) == near<S>(0.05 * 0.01 / 4));
    CHECK(section.plastic_modulus(y) == near<S>(0.1 * 0.0025 / 4));
    CHECK(section.product_of_inertia() == 0);
    CHECK(section.shear_area(x) == section.area());
    CHECK(section.elastic_shear_area(y) == near<S>(0.005 * 5 / 6));
}

TEST_CASE("a 50 x 100 mm bar of 250 MPa yields at 20833 N m and flows at 31250 N m", "[section]") {
    const Rectangle<double> section({.width = 0.05, .height = 0.1});
    const Material<double> steel(
        {.density = 7850, .youngs_modulus = 200e9, .poisson_ratio = 0.3, .yield_stress = 250e6});
    CHECK(yield_moment(section, steel) == printed(20833.33));
    CHECK(plastic_moment(section, steel) == near<double>(31250));
    CHECK(plastic_moment(section, steel, x) == plastic_moment(section, steel));
    CHECK(plastic_moment(section, steel, y) == near<double>(15625));
    CHECK(yield_moment(section, steel, y) == near<double>(31250.0 / 3));
}

TEST_CASE("a square bar twists as St Venant says, a strip as a thin wall", "[section]") {
    // Timoshenko and Goodier (1970), section 109: 0.1406 a^4, 0.229 for 2:1, 0.312 for 10:1
    const auto factor = [](double ratio) {
        return Rectangle<double>({.width = ratio, .height = 1}).torsion_constant() / ratio;
    };
    CHECK(factor(1) == Approx(0.140577).epsilon(5e-6));
    CHECK(factor(2) == Approx(0.229).epsilon(3e-3));
    CHECK(factor(10) == Approx(0.312).epsilon(3e-3));
    CHECK(factor(1e6) == Approx(1.0 / 3).epsilon(1e-6));
    CHECK(Rectangle<double>({.width = 1, .height = 2}).torsion_constant() ==
          Rectangle<double>({.width = 2, .height = 1}).torsion_constant());
    // the series itself, summed to 2001 terms, whose remainder is below 1e-14
    double sum = 0;
    for (int n = 2001; n > 0; n -= 2) sum += std::tanh(n * pi * 1.7 / 2) / std::pow(n, 5);
    const double series = 1.7 / 3 * (1 - 192 / std::pow(pi, 5) / 1.7 * sum);
    CHECK(Rectangle<double>({.width = 1.7, .height = 1}).torsion_constant() ==
          Approx(series).epsilon(1e-13));
}

TEMPLATE_TEST_CASE("plastic torque by the sand heap at tau_y = 100 MPa", "[section][reference]", float,
                   double) {
    using S = TestType;
    const double tau = 100e6;
    const auto torque = [&](const auto& section) {
        return tau * static_cast<double>(section.plastic_torsion_modulus());
    };
    CHECK(torque(Rectangle<S>({.width = S(0.01), .height = S(0.01)})) == printed(33.333333));
    CHECK(torque(Rectangle<S>({.width = S(0.1), .height = S(0.06)})) == printed(14400));
    CHECK(torque(Rectangle<S>({.width = S(0.01), .height = S(0.05)})) == printed(233.33333));
    CHECK(torque(Circle<S>({.radius = S(0.05)})) == printed(26179.939));
    CHECK(torque(Tube<S>({.outer_radius = S(0.05), .inner_radius = S(0.04)})) == printed(12775.81));
    // four printed digits, found numerically
    CHECK(torque(LSection<S>({.width = S(0.1), .height = S(0.1), .thickness = S(0.01)})) ==
          Approx(935.40).epsilon(5e-6));
    const double height = 0.06 * std::sqrt(0.75);
    const Polygon<S> triangle({.vertices = {{0, 0}, {S(0.06), 0}, {S(0.03), S(height)}}});
    CHECK(torque(triangle) == printed(1800));
}

TEMPLATE_TEST_CASE("geometry of an I section and a tube", "[section][reference]", float, double) {
    using S = TestType;
    const ISection<S> i({.width = S(0.2),
                         .height = S(0.2),
                         .web_thickness = S(0.009),
                         .flange_thickness = S(0.015)});
    CHECK(i.area() == near<S>(0.00753));
    CHECK(i.plastic_modulus() == near<S>(0.000620025));
    CHECK(i.plastic_modulus(y) == near<S>(0.0003034425));
    // b h³/12 less the two recesses
    const double strong = (0.2 * 0.008 - 0.191 * 0.17 * 0.17 * 0.17) / 12;
    CHECK(i.second_moment() == near<S>(strong));
    CHECK(i.elastic_modulus() == near<S>(strong / 0.1));
    const double weak = (2 * 0.015 * 0.008 + 0.17 * 0.009 * 0.009 * 0.009) / 12;
    CHECK(i.second_moment(y) == near<S>(weak));
    CHECK(i.elastic_modulus(y) == near<S>(weak / 0.1));
    CHECK(i.shear_area(y) == near<S>(0.2 * 0.009));
    CHECK(i.shear_area(x) == near<S>(2 * 0.2 * 0.015));
    CHECK(i.torsion_constant() ==
          near<S>((2 * 0.2 * 0.015 * 0.015 * 0.015 + 0.185 * 0.009 * 0.009 * 0.009) / 3));

    const Tube<S> tube({.outer_radius = S(0.05), .inner_radius = S(0.04)});
    CHECK(tube.plastic_modulus(y) == Approx(8.13333333e-05).epsilon(1e-6));
    CHECK(tube.area() == near<S>(pi * 9e-4));
    CHECK(tube.second_moment() == near<S>(pi / 4 * (6.25e-6 - 2.56e-6)));
    CHECK(tube.torsion_constant() == near<S>(pi / 2 * (6.25e-6 - 2.56e-6)));
    CHECK(tube.shear_area(x) == near<S>(2 * 9e-4));
}

TEMPLATE_TEST_CASE("plastic moduli of T, channel and L about their equal-area axes",
                   "[section][reference]", float, double) {
    using S = TestType;
    const TSection<S> thin(
        {.width = S(0.1), .height = S(0.1), .web_thickness = S(0.01), .flange_thickness = S(0.01)});
    CHECK(thin.plastic_modulus() == near<S>(4.5475e-05));
    CHECK(thin.plastic_modulus(y) == near<S>(2.725e-05));
    CHECK(thin.highest() - thin.equal_area_height() == Approx(0.0095).epsilon(1e3 * round_off<S>));

    const TSection<S> thick(
        {.width = S(0.1), .height = S(0.12), .web_thickness = S(0.01), .flange_thickness = S(0.02)});
    CHECK(thick.plastic_modulus() == near<S>(6.75e-05));
    CHECK(thick.plastic_modulus(y) == near<S>(5.25e-05));
    CHECK(thick.highest() - thick.equal_area_height() == Approx(0.015).epsilon(1e3 * round_off<S>));

    const Channel<S> channel({.width = S(0.06),
                              .height = S(0.1),
                              .web_thickness = S(0.008),
                              .flange_thickness = S(0.008)});
    CHECK(channel.plastic_modulus(y) == near<S>(2.4816e-05));
    CHECK(channel.plastic_modulus() == near<S>(5.8272e-05));
    // 9 mm from the back: in the flanges, 1 mm beyond the web, whose area is not quite half
    CHECK(channel.equal_area_height(y) - channel.lowest(y) ==
          Approx(0.009).epsilon(1e3 * round_off<S>));

    const LSection<S> angle({.width = S(0.1), .height = S(0.1), .thickness = S(0.01)});
    CHECK(angle.plastic_modulus() == near<S>(4.5475e-05));
    CHECK(angle.plastic_modulus(y) == near<S>(4.5475e-05));
}

TEMPLATE_TEST_CASE("an L bent about a leg needs a companion moment, about its principal axes none",
                   "[section][reference]", float, double) {
    using S = TestType;
    const auto polygon =
        polygon_of(LSection<S>({.width = S(0.1), .height = S(0.1), .thickness = S(0.01)}));
    const auto held = polygon.plastic_bending(0);
    CHECK(held.modulus == near<S>(4.5475e-05));
    CHECK(std::abs(held.companion) == near<S>(4.05e-05));

    const auto principal = principal_axes(polygon);
    CHECK(principal.angle == near<S>(pi / 4));
    const auto strong = polygon.plastic_bending(principal.angle);
    const auto weak = polygon.plastic_bending(principal.angle + std::numbers::pi_v<S> / 2);
    CHECK(strong.modulus == printed(6.387531e-05).epsilon(5e-7 + round_off<S>));
    CHECK(weak.modulus == printed(3.220282e-05).epsilon(5e-7 + round_off<S>));
    CHECK(std::abs(strong.companion) < round_off<S> * strong.modulus);
    // about the weak axis the cut leaves the two legs symmetric as well
    CHECK(std::abs(weak.companion) < round_off<S> * strong.modulus);
}

TEST_CASE("a box is its outer rectangle less the inner one", "[section]") {
    const Box<double> box(
        {.width = 0.1, .height = 0.2, .web_thickness = 0.01, .flange_thickness = 0.01});
    const Rectangle<double> outer({.width = 0.1, .height = 0.2});
    const Rectangle<double> inner({.width = 0.08, .height = 0.18});
    for (const SectionAxis axis : {x, y}) {
        CHECK(box.second_moment(axis) ==
              near<double>(outer.second_moment(axis) - inner.second_moment(axis)));
        CHECK(box.plastic_modulus(axis) ==
              near<double>(outer.plastic_modulus(axis) - inner.plastic_modulus(axis)));
    }
    CHECK(box.plastic_torsion_modulus() ==
          near<double>(outer.plastic_torsion_modulus() - inner.plastic_torsion_modulus()));
    // Bredt alone: 4 A_m² t/perimeter; the walls' own part is small
    const double bredt = 4 * std::pow(0.09 * 0.19, 2) * 0.01 / (2 * (0.09 + 0.19));
    CHECK(box.torsion_constant() > bredt);
    CHECK(box.torsion_constant() == Approx(bredt).epsilon(0.01));
}

TEST_CASE("thin limits of tube and angle", "[section]") {
    const double radius = 0.05;
    const double wall = 1e-7;
    const Tube<double> tube({.outer_radius = radius, .inner_radius = radius - wall});
    // relative deviation wall/radius = 2e-6
    CHECK(tube.plastic_modulus() == Approx(4 * radius * radius * wall).epsilon(1e-5));
    CHECK(tube.elastic_shear_area(x) == Approx(tube.area() / 2).epsilon(1e-5));
    CHECK(tube.plastic_torsion_modulus() ==
          Approx(2 * pi * radius * radius * wall).epsilon(1e-5)); // Bredt: 2 A t
    const LSection<double> angle({.width = 0.1, .height = 0.05, .thickness = 1e-6});
    CHECK(angle.plastic_torsion_modulus() == Approx(0.15 * 1e-12 / 2).epsilon(1e-4));
}

TEMPLATE_TEST_CASE("a notched rectangle is its ligament", "[section]", float, double) {
    using S = TestType;
    const NotchedRectangle<S> section({.width = S(0.01), .height = S(0.01), .notch = S(0.002)});
    const Rectangle<S> ligament({.width = S(0.01), .height = S(0.01) - S(0.002)});
    for (const SectionAxis axis : {x, y}) {
        CHECK(section.second_moment(axis) == ligament.second_moment(axis));
        CHECK(section.elastic_modulus(axis) == ligament.elastic_modulus(axis));
        CHECK(section.plastic_modulus(axis) == ligament.plastic_modulus(axis));
        CHECK(section.shear_area(axis) == ligament.shear_area(axis));
        CHECK(section.elastic_shear_area(axis) == ligament.elastic_shear_area(axis));
        CHECK(section.lowest(axis) == ligament.lowest(axis));
        CHECK(section.highest(axis) == ligament.highest(axis));
        CHECK(section.width_at(0, axis) == ligament.width_at(0, axis));
    }
    CHECK(section.torsion_constant() == ligament.torsion_constant());
    CHECK(section.plastic_torsion_modulus() == ligament.plastic_torsion_modulus());
    CHECK(section.product_of_inertia() == 0);
    CHECK(section.notch() == Approx(0.002).epsilon(1e-6));
    // the Charpy specimen's 64 N m at 400 MPa
    CHECK(S(400e6) * section.plastic_modulus() == Approx(64).epsilon(1e-6));
}
