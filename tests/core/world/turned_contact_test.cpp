// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>

#include "ductile/world/turned_contact.hpp"

using namespace ductile;

namespace {

using V = Vector3<double>;

constexpr double spin = 3, radius = 0.5, half = 1e-3; // [rad/s], [m], h/2 [s]

/// A wheel about z on a flat whose normal is y; its corner is `angle` past the lowest place.
SeenContact corner(double angle) {
    const V arm(radius * std::sin(angle), -radius * std::cos(angle), 0);
    return {.point = arm, .normal = {0, 1, 0}, .arm_a = arm, .arm_b = arm};
}
double w(const SeenContact& now, const SeenContact& then, const ContactBody& a,
         const ContactBody& b = {}, double time = half) {
    return turned_contact(now, then, a, b, time, half);
}

} // namespace

TEST_CASE("Turned contact: a corner that turns over a flat has the acceleration of its circle",
          "[frame]") {
    const ContactBody wheel{.spin = {0, 0, spin}};
    // (sin(ω h/2)) ω r on the way past the lowest place: ω² r h/2
    CHECK(w(corner(0), corner(-spin * half), wheel) ==
          Approx(-spin * spin * radius * half).epsilon(1e-5));
    // seen twice as long ago, the same
    CHECK(w(corner(0), corner(-2 * spin * half), wheel, {}, 2 * half) ==
          Approx(-spin * spin * radius * half).epsilon(1e-4));
}

TEST_CASE("Turned contact: a flat that turns under a point that slides on it", "[frame]") {
    // a point fixed in the world, a flat that turns about its own middle 0.2 m beside it and moves
    // along: the gap has the acceleration 2 ω v + ω² of its height, none
    const double along = 2, turn = spin * half;
    const ContactBody flat{.velocity = {along, 0, 0}, .spin = {0, 0, spin}};
    const auto seen = [&](double time) {
        const double angle = spin * time;
        const V centre(-0.2 + along * time, 0, 0);
        // where a vertical line at x = 0 meets the flat
        const V point(0, -centre.x() * std::tan(angle), 0);
        const V arm(point.x() - centre.x(), point.y(), 0);
        return SeenContact{.point = point,
                           .normal = {-std::sin(angle), std::cos(angle), 0},
                           .arm_a = {0, 0, 0},
                           .arm_b = arm};
    };
    const auto closing = [&](double time) {
        const SeenContact at = seen(time);
        return -dot(at.normal, difference(V(0, 0, 0), flat.at(at.arm_b)));
    };
    CHECK(w(seen(half), seen(0), {}, flat) == Approx(closing(half) - closing(0)));
    CHECK(w(seen(half), seen(0), {}, flat) == Approx(-2 * along * turn).epsilon(1e-2)); // Coriolis
}

TEST_CASE("Turned contact: a flat that turns runs round a ball that it meets", "[frame]") {
    // a ball 2 m in radius, still; the flat turns below it about a place 0.1 m beside
    constexpr double round = 2, aside = 0.1;
    const ContactBody flat{.spin = {0, 0, spin}};
    const auto seen = [&](double angle) {
        const V arm(round * std::sin(angle), -round * std::cos(angle), 0), centre(-aside, round, 0);
        const V normal(-std::sin(angle), std::cos(angle), 0);
        return SeenContact{
            .point = sum(centre, arm), .normal = normal, .arm_a = arm, .arm_b = sum(centre, arm)};
    };
    // the point is ω r h/2 farther, and no faster than ω 0.1 m
    CHECK(w(seen(spin * half), seen(0), {}, flat) ==
          Approx(spin * spin * round * half).epsilon(1e-2));
}

TEST_CASE("Turned contact: what does not turn, or is another contact, has none", "[frame]") {
    const ContactBody slides{.velocity = {2, 0, 0}}, wheel{.spin = {0, 0, spin}};
    SeenContact then = corner(0), now = then;
    now.point[0] += 2 * half; // its arms stay
    CHECK(w(now, then, slides) == 0);
    CHECK(w(now, then, {}) == 0);
    // a ball that rolls: its lowest point, another one each time
    const ContactBody rolls{.velocity = {spin * radius, 0, 0}, .spin = {0, 0, -spin}};
    now.point[0] = spin * radius * half;
    CHECK(w(now, then, rolls) == 0);
    // another corner, or another face
    CHECK(w(corner(0.5), corner(0), wheel) == 0);
    SeenContact face = corner(-spin * half);
    face.normal = {1, 0, 0};
    CHECK(w(corner(0), face, wheel) == 0);
}

TEST_CASE("Turned contact: friction that holds is short of what turns the arms", "[frame]") {
    // a block at `radius` on a table that turns with it: towards the middle, ω² r of the table's
    const ContactBody table{.spin = {0, 0, spin}}, block{.spin = {0, 0, spin}};
    const V at(radius, 0, 0), under(0, 0, -0.1);
    const V held = turning_arms(block, under, table, at);
    CHECK(held.x() == Approx(spin * spin * radius));
    CHECK(held.y() == 0);
    CHECK(held.z() == 0);
    // a wheel that rolls on what stands: nothing along the ground
    const ContactBody wheel{.velocity = {spin * radius, 0, 0}, .spin = {0, 0, -spin}};
    const V rolls = turning_arms(wheel, V(0, -radius, 0), {}, V(3, 0, 0));
    CHECK(rolls.x() == Approx(0).margin(1e-12));
    CHECK(rolls.z() == 0);
}
