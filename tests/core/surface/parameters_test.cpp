// SPDX-License-Identifier: MIT
//
// Bad parameters of surfaces.
#include <catch2/catch.hpp>

#include <limits>

#include "core/surface/cases.hpp"
#include "support/throws.hpp"

using namespace ductile;
using namespace ductile::test;

TEST_CASE("a surface names the parameter that is missing or out of range", "[surface]") {
    CHECK(message_of([] { Ellipsoid<double, 2>({}); }) ==
          "Ellipsoid.capacity[0] = nan N or N m: must be finite and > 0");
    CHECK(message_of([] {
              Ellipsoid<double, 2>({.capacity = {1, -3}});
          }) == "Ellipsoid.capacity[1] = -3 N or N m: must be finite and > 0");
    CHECK(message_of([] {
              IndependentAxes<double, 2>({.capacity = {1, 0}});
          }) == "IndependentAxes.capacity[1] = 0 N or N m: must be finite and > 0");
    CHECK(message_of([] {
              Scaled(BiaxialRectangle<double>(),
                     ScaledParameters<double, 3>{
                         .capacity = {1, 2, std::numeric_limits<double>::infinity()}});
          }) == "Scaled.capacity[2] = inf N or N m: must be finite and > 0");
    CHECK(message_of([] { BendingTorsion<double>({.plastic_moment = 5}); }) ==
          "BendingTorsion.plastic_torque = nan N m: must be finite and > 0");
    CHECK(message_of([] { BendingTorsion<double>({.plastic_moment = -5, .plastic_torque = 1}); }) ==
          "BendingTorsion.plastic_moment = -5 N m: must be finite and > 0");
}

TEST_CASE("a tube names the radius that does not fit", "[surface]") {
    CHECK(message_of([] { TubeAxialBending<double>({.inner_radius = 0.04}); }) ==
          "TubeAxialBending.outer_radius = nan m: must be finite and > 0");
    CHECK(message_of([] {
              TubeAxialBending<double>({.outer_radius = 0.05, .inner_radius = 0.06});
          }) == "TubeAxialBending.inner_radius = 0.06 m: must be in (0, 0.05) m");
    CHECK(message_of([] { TubeAxialBending<double>({.outer_radius = 0.05}); }) ==
          "TubeAxialBending.inner_radius = nan m: must be in (0, 0.05) m");
}

TEST_CASE("an I names the plate that does not fit", "[surface]") {
    const auto message = [](IAxialBendingParameters<double> p,
                            double IAxialBendingParameters<double>::*field, double value) {
        p.*field = value;
        return message_of([&] { IAxialBending<double>(p, BendingAxis::weak); });
    };
    using P = IAxialBendingParameters<double>;
    CHECK(message(i_200<double>, &P::height, 0) ==
          "IAxialBending.height = 0 m: must be finite and > 0");
    CHECK(message(i_200<double>, &P::width, -1) ==
          "IAxialBending.width = -1 m: must be finite and > 0");
    CHECK(message(i_200<double>, &P::web_thickness, 0.2) ==
          "IAxialBending.web_thickness = 0.2 m: must be in (0, 0.2) m");
    CHECK(message(i_200<double>, &P::flange_thickness, 0.1) ==
          "IAxialBending.flange_thickness = 0.1 m: must be in (0, 0.1) m");
}
