// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include <numbers>

#include "ductile/section/circle.hpp"
#include "ductile/section/notched_rectangle.hpp"
#include "ductile/section/rectangle.hpp"
#include "support/throws.hpp"

using namespace ductile;
using ductile::test::message_of;

namespace {

template <class S>
Material<S> steel(S yield_stress) {
    return Material<S>({.density = 7800, .youngs_modulus = S(200e9), .poisson_ratio = S(0.3),
                        .yield_stress = yield_stress});
}

struct NotASection {
    using Scalar = double;
};
static_assert(!Section<NotASection>);

} // namespace

TEMPLATE_TEST_CASE("a rectangle 50 x 100 mm of 250 MPa yields at 20.8 and flows at 31.25 kN m",
                   "[section]", float, double) {
    // moment-curvature of a rectangle: M_y = f_y b h²/6, M_p = f_y b h²/4
    const Rectangle<TestType> section({.width = TestType(0.05), .height = TestType(0.1)});
    CHECK(yield_moment(section, steel(TestType(250e6))) == Approx(20833.333).epsilon(1e-6));
    CHECK(plastic_moment(section, steel(TestType(250e6))) == Approx(31250).epsilon(1e-6));
    CHECK(200e9 * double(section.second_moment()) == Approx(833333.3).epsilon(1e-6));
}

TEST_CASE("the Charpy ligament of 10 x 8 mm carries 64 N m", "[section]") {
    const NotchedRectangle<double> section({.width = 0.01, .height = 0.01, .notch = 0.002});
    CHECK(plastic_moment(section, steel(400e6)) == Approx(64).epsilon(1e-12));
    CHECK(section.area() == Approx(80e-6).epsilon(1e-12));
    CHECK(section.notch() == Approx(0.002).epsilon(1e-12));
}

TEST_CASE("a notch of no depth leaves the rectangle as it was", "[section]") {
    const Rectangle<double> whole({.width = 0.02, .height = 0.03});
    const NotchedRectangle<double> notched({.width = 0.02, .height = 0.03, .notch = 0});
    CHECK(notched.plastic_modulus() == whole.plastic_modulus());
    CHECK(notched.elastic_modulus() == whole.elastic_modulus());
    CHECK(notched.second_moment() == whole.second_moment());
}

TEST_CASE("a circle's shape factor is 16/(3 pi)", "[section]") {
    const Circle<double> circle({.radius = 0.03});
    CHECK(circle.plastic_modulus() / circle.elastic_modulus() ==
          Approx(16 / (3 * std::numbers::pi)).epsilon(1e-14));
    CHECK(circle.second_moment() == Approx(circle.elastic_modulus() * 0.03).epsilon(1e-14));
}

TEST_CASE("sections refuse sizes that make none, by name", "[section]") {
    CHECK(message_of([] { Rectangle<double>({.width = -0.01, .height = 0.01}); }) ==
          "Rectangle.width = -0.01 m: must be finite and > 0");
    CHECK(message_of([] { Rectangle<double>({.width = 0.01}); }) ==
          "Rectangle.height = nan m: must be finite and > 0");
    CHECK(message_of([] { Circle<double>({.radius = 0}); }) ==
          "Circle.radius = 0 m: must be finite and > 0");
    CHECK(message_of([] {
              NotchedRectangle<double>({.width = 0.01, .height = 0.01, .notch = 0.012});
          }) == "NotchedRectangle.notch = 0.012 m: must be in (0, 0.01) m");
    CHECK(message_of([] {
              NotchedRectangle<double>({.width = 0.01, .height = 0.01, .notch = -0.001});
          }) == "NotchedRectangle.notch = -0.001 m: must be finite and >= 0");
}
