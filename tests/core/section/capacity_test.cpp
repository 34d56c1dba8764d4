// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "ductile/section/box.hpp"
#include "ductile/section/capacity.hpp"
#include "ductile/section/channel.hpp"
#include "ductile/section/circle.hpp"
#include "ductile/section/i_section.hpp"
#include "ductile/section/l_section.hpp"
#include "ductile/section/notched_rectangle.hpp"
#include "ductile/section/rectangle.hpp"
#include "ductile/section/t_section.hpp"
#include "ductile/section/tube.hpp"
#include "support/throws.hpp"

using namespace ductile;
using ductile::test::message_of;

namespace {

template <class S>
Material<S> steel() {
    return Material<S>({.density = S(7850),
                        .youngs_modulus = S(200e9),
                        .poisson_ratio = S(0.25), // G = 80 GPa
                        .yield_stress = S(300e6)});
}

} // namespace

TEMPLATE_TEST_CASE("the six capacities and stiffnesses of a bar, by hand", "[section]", float, double) {
    using S = TestType;
    // 60 mm along x, 100 mm along y, 0.5 m long
    const Rectangle<S> section({.width = S(0.06), .height = S(0.1)});
    const auto joint = joint_capacity(section, steel<S>(), {.length = S(0.5)});
    const double tau = 300e6 / std::sqrt(3.0);
    const auto near = [](double value) {
        return Approx(value).epsilon(16 * std::numeric_limits<S>::epsilon());
    };
    CHECK(joint.capacity[0] == near(tau * 0.006));
    CHECK(joint.capacity[1] == near(tau * 0.006));
    CHECK(joint.capacity[2] == near(300e6 * 0.006));
    CHECK(joint.capacity[3] == near(300e6 * 0.06 * 0.01 / 4));
    CHECK(joint.capacity[4] == near(300e6 * 0.1 * 0.0036 / 4));
    CHECK(joint.capacity[5] == near(tau * 1.44e-4)); // 14400 N m at 100 MPa
    CHECK(joint.stiffness[0] == near(80e9 * 0.005 / 0.5));
    CHECK(joint.stiffness[1] == near(80e9 * 0.005 / 0.5));
    CHECK(joint.stiffness[2] == near(200e9 * 0.006 / 0.5));
    CHECK(joint.stiffness[3] == near(200e9 * 5e-6 / 0.5));
    CHECK(joint.stiffness[4] == near(200e9 * 1.8e-6 / 0.5));
    CHECK(joint.stiffness[5] == near(80e9 * static_cast<double>(section.torsion_constant()) / 0.5));
}

TEST_CASE("Tresca's shear strength is below von Mises', bending and tension are the same",
          "[section]") {
    const auto material = steel<double>();
    CHECK(shear_yield_stress(material) == Approx(300e6 / std::sqrt(3.0)).epsilon(1e-15));
    CHECK(shear_yield_stress(material, ShearYield::tresca) == 150e6);
    const Circle<double> section({.radius = 0.05});
    const auto mises = joint_capacity(section, material, {.length = 1});
    const auto tresca =
        joint_capacity(section, material, {.length = 1, .shear_yield = ShearYield::tresca});
    CHECK(mises.stiffness == tresca.stiffness);
    for (const std::size_t axis : {0u, 1u, 5u}) {
        CHECK(tresca.capacity[axis] ==
              Approx(mises.capacity[axis] * std::sqrt(3.0) / 2).epsilon(1e-14));
    }
    for (const std::size_t axis : {2u, 3u, 4u}) CHECK(tresca.capacity[axis] == mises.capacity[axis]);
}

TEST_CASE("twice the length halves every stiffness and leaves every capacity", "[section]") {
    const ISection<double> section(
        {.width = 0.2, .height = 0.3, .web_thickness = 0.009, .flange_thickness = 0.015});
    const auto one = joint_capacity(section, steel<double>(), {.length = 1});
    const auto two = joint_capacity(section, steel<double>(), {.length = 2});
    CHECK(one.capacity == two.capacity);
    for (std::size_t axis = 0; axis < 6; ++axis) {
        CHECK(one.stiffness[axis] == 2 * two.stiffness[axis]);
        CHECK(two.stiffness[axis] > 0);
    }
    // x is the strong axis, and shear along y is carried by the web
    CHECK(one.capacity[3] > one.capacity[4]);
    CHECK(one.capacity[1] < one.capacity[0]);
}

TEST_CASE("a joint without a length cannot have a stiffness", "[section]") {
    const Circle<double> section({.radius = 0.05});
    CHECK(message_of([&] { (void)joint_capacity(section, steel<double>(), {}); }) ==
          "Capacity.length = nan m: must be finite and > 0");
    CHECK(message_of([&] { (void)joint_capacity(section, steel<double>(), {.length = 0}); }) ==
          "Capacity.length = 0 m: must be finite and > 0");
}

TEST_CASE("every section names the length that is missing or out of range", "[section]") {
    CHECK(message_of([] { Rectangle<double>({.height = 1}); }) ==
          "Rectangle.width = nan m: must be finite and > 0");
    CHECK(message_of([] { Rectangle<double>({.width = 1, .height = -2}); }) ==
          "Rectangle.height = -2 m: must be finite and > 0");
    CHECK(message_of([] { Circle<double>({.radius = 0}); }) ==
          "Circle.radius = 0 m: must be finite and > 0");
    CHECK(message_of([] { NotchedRectangle<double>({.width = 1, .height = 1, .notch = 1}); }) ==
          "NotchedRectangle.notch = 1 m: must be in (0, 1) m");
    CHECK(message_of([] { NotchedRectangle<double>({.width = 1, .height = 1, .notch = -1}); }) ==
          "NotchedRectangle.notch = -1 m: must be finite and >= 0");
    CHECK(message_of([] { NotchedRectangle<double>({.width = 0, .height = 1, .notch = 0}); }) ==
          "NotchedRectangle.width = 0 m: must be finite and > 0");
    CHECK(message_of([] { NotchedRectangle<double>({.width = 1, .notch = 0}); }) ==
          "NotchedRectangle.height = nan m: must be finite and > 0");

    CHECK(message_of([] { Tube<double>({.inner_radius = 1}); }) ==
          "Tube.outer_radius = nan m: must be finite and > 0");
    CHECK(message_of([] { Tube<double>({.outer_radius = 0.05, .inner_radius = 0.05}); }) ==
          "Tube.inner_radius = 0.05 m: must be in (0, 0.05) m");
    CHECK(message_of([] { Tube<double>({.outer_radius = 0.05}); }) ==
          "Tube.inner_radius = nan m: must be in (0, 0.05) m");
}

TEST_CASE("every section made of walls names the wall that does not fit", "[section]") {
    CHECK(message_of([] { ISection<double>({.height = 1}); }) ==
          "ISection.width = nan m: must be finite and > 0");
    CHECK(message_of([] { ISection<double>({.width = 1}); }) ==
          "ISection.height = nan m: must be finite and > 0");
    CHECK(message_of([] { ISection<double>({.width = 0.2, .height = 0.3, .web_thickness = 0.2}); }) ==
          "ISection.web_thickness = 0.2 m: must be in (0, 0.2) m");
    CHECK(message_of([] {
              ISection<double>(
                  {.width = 0.2, .height = 0.3, .web_thickness = 0.01, .flange_thickness = 0.15});
          }) == "ISection.flange_thickness = 0.15 m: must be in (0, 0.15) m");

    CHECK(message_of([] { TSection<double>({.width = -1}); }) ==
          "TSection.width = -1 m: must be finite and > 0");
    CHECK(message_of([] { TSection<double>({.width = 1, .height = 0}); }) ==
          "TSection.height = 0 m: must be finite and > 0");
    CHECK(message_of([] { TSection<double>({.width = 0.2, .height = 0.3}); }) ==
          "TSection.web_thickness = nan m: must be in (0, 0.2) m");
    CHECK(message_of([] {
              TSection<double>(
                  {.width = 0.2, .height = 0.3, .web_thickness = 0.01, .flange_thickness = 0.3});
          }) == "TSection.flange_thickness = 0.3 m: must be in (0, 0.3) m");

    CHECK(message_of([] { LSection<double>({}); }) ==
          "LSection.width = nan m: must be finite and > 0");
    CHECK(message_of([] { LSection<double>({.width = 0.2}); }) ==
          "LSection.height = nan m: must be finite and > 0");
    CHECK(message_of([] { LSection<double>({.width = 0.2, .height = 0.1, .thickness = 0.15}); }) ==
          "LSection.thickness = 0.15 m: must be in (0, 0.1) m");

    CHECK(message_of([] { Channel<double>({}); }) == "Channel.width = nan m: must be finite and > 0");
    CHECK(message_of([] { Channel<double>({.width = 0.2}); }) ==
          "Channel.height = nan m: must be finite and > 0");
    CHECK(message_of([] { Channel<double>({.width = 0.2, .height = 0.3, .web_thickness = 0}); }) ==
          "Channel.web_thickness = 0 m: must be in (0, 0.2) m");
    CHECK(message_of([] {
              Channel<double>(
                  {.width = 0.2, .height = 0.3, .web_thickness = 0.01, .flange_thickness = -0.01});
          }) == "Channel.flange_thickness = -0.01 m: must be in (0, 0.15) m");

    CHECK(message_of([] { Box<double>({}); }) == "Box.width = nan m: must be finite and > 0");
    CHECK(message_of([] { Box<double>({.width = 0.2}); }) ==
          "Box.height = nan m: must be finite and > 0");
    CHECK(message_of([] { Box<double>({.width = 0.2, .height = 0.3, .web_thickness = 0.1}); }) ==
          "Box.web_thickness = 0.1 m: must be in (0, 0.1) m");
    CHECK(message_of([] {
              Box<double>(
                  {.width = 0.2, .height = 0.3, .web_thickness = 0.01, .flange_thickness = 0.2});
          }) == "Box.flange_thickness = 0.2 m: must be in (0, 0.15) m");
}
