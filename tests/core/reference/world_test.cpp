// SPDX-License-Identifier: MIT
//
// The reference integrator on motion that has nothing plastic in it, before it judges the core.
#include <catch2/catch.hpp>

#include <cmath>

#include "reference/world.hpp"

using namespace ductile;
using namespace ductile::reference;

TEST_CASE("two pinned bars that are struck share the impulse as momentum says",
          "[reference][world]") {
    // Two equal rods in line, half length h, the first struck across by P at its free end; the pin
    // passes X to the second. Momentum, with the inertia m h²/3 about each centre:
    //   m v1 = P - X,  m h² ω1/3 = (P + X) h,  m v2 = X,  m h² ω2/3 = X h
    // and v1 - ω1 h = v2 + ω2 h at the pin, so -2P = 8X.
    const double m = 3, length = 2, h = length / 2, struck = 6;
    World<double> world;
    const Body one = world.add_body(m, m * length * length / 12, {0.5 * length, 0});
    const Body two = world.add_body(m, m * length * length / 12, {-0.5 * length, 0});
    world.add_pin(two, one, {0, 0});
    Vector<double> impulse = world.no_load();
    impulse[one.y()] = struck;
    impulse[one.angle()] = struck * h;
    world.strike(impulse);
    const double x = -struck / 4;
    CHECK(world.velocity()[one.y()] == Approx((struck - x) / m).epsilon(1e-12));
    CHECK(world.velocity()[one.angle()] == Approx(3 * (struck + x) / (m * h)).epsilon(1e-12));
    CHECK(world.velocity()[two.y()] == Approx(x / m).epsilon(1e-12));
    CHECK(world.velocity()[two.angle()] == Approx(3 * x / (m * h)).epsilon(1e-12));
}
