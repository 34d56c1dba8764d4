// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <tuple>

#include "ductile/joint/break_release.hpp"
#include "ductile/joint/planar_release.hpp"
#include "support/property.hpp"

using namespace ductile;

namespace {

double number(int lo, int hi) { return *rc::gen::inRange(lo * 1000, hi * 1000) / 1000.0; }

PlanarBody<double> any_body() {
    return {1 / number(1, 20),
            1 / number(1, 5),
            number(-2, 2),
            number(-2, 2),
            {number(-5, 5), number(-5, 5), number(-5, 5)}};
}

double kinetic(const PlanarBody<double>& body) {
    const PlanarVelocity<double>& v = body.velocity;
    return ((v.x * v.x + v.y * v.y) / body.inverse_mass + v.spin * v.spin / body.inverse_inertia) /
           2;
}
/// About the joint [N m s].
double angular_momentum(const PlanarBody<double>& body) {
    return body.velocity.spin / body.inverse_inertia -
           (body.arm_x * body.velocity.y - body.arm_y * body.velocity.x) / body.inverse_mass;
}
PlanarVelocity<double> sum(const PlanarVelocity<double>& one, const PlanarVelocity<double>& other,
                           double sign = 1) {
    return {one.x + sign * other.x, one.y + sign * other.y, one.spin + sign * other.spin};
}
/// The velocity of the body's point at the joint.
PlanarVelocity<double> at_pin(const PlanarBody<double>& body) {
    const PlanarVelocity<double>& v = body.velocity;
    return {v.x - v.spin * body.arm_y, v.y + v.spin * body.arm_x, v.spin};
}

/// The same body in space; what its other two inertias are does not matter.
BodyAtJoint<double> in_space(const PlanarBody<double>& body) {
    BodyAtJoint<double> result{.inverse_mass = body.inverse_mass,
                               .arm = {body.arm_x, body.arm_y, 0}};
    result.inverse_inertia(2, 2) = body.inverse_inertia;
    if (body.inverse_mass > 0) result.inverse_inertia.diagonal().head<2>() << 0.7, 1.3;
    return result;
}
BreakRelease<double> release_in_space(const PlanarBody<double>& a, const PlanarBody<double>& b,
                                      double energy) {
    const PlanarVelocity<double> moves = sum(at_pin(a), at_pin(b), -1);
    Vector6<double> twist;
    twist << moves.x, moves.y, 0, 0, 0, moves.spin;
    const Vector6<double> axis = Vector6<double>::Unit(5);
    return break_release(in_space(a), in_space(b), axis, twist, energy);
}

bool same(const PlanarVelocity<double>& planar, const VelocityChange<double>& spatial) {
    const double size = 1 + std::abs(planar.x) + std::abs(planar.y) + std::abs(planar.spin);
    return std::abs(planar.x - spatial.linear.x()) + std::abs(planar.y - spatial.linear.y()) +
               std::abs(planar.spin - spatial.angular.z()) <
           1e-10 * size;
}
bool nothing(const PlanarVelocity<double>& change) {
    return change.x == 0 && change.y == 0 && change.spin == 0;
}

} // namespace

TEST_CASE("in the plane a release is the one in space", "[planar]") {
    test::prop("any two bodies, arms, velocities and energy", [] {
        const PlanarBody<double> a = any_body(), b = any_body();
        const double energy = number(0, 50);
        const auto planar = planar_release(a, b, energy);
        const auto spatial = release_in_space(a, b, energy);
        RC_ASSERT(same(planar.a, spatial.a));
        RC_ASSERT(same(planar.b, spatial.b));
    });
    test::prop("one body fixed, whichever comes first", [] {
        const PlanarBody<double> a = any_body(), fixed{.arm_x = 3, .arm_y = -1};
        const double energy = number(1, 50);
        const auto planar = planar_release(a, fixed, energy);
        RC_ASSERT(same(planar.a, release_in_space(a, fixed, energy).a));
        RC_ASSERT(nothing(planar.b));
        const auto swapped = planar_release(fixed, a, energy);
        RC_ASSERT(same(swapped.b, release_in_space(fixed, a, energy).b));
        RC_ASSERT(nothing(swapped.a));
    });
}

TEST_CASE("in the plane a release keeps momentum and pin and gives exactly its energy",
          "[planar]") {
    test::prop("any two bodies, pin closed or not", [] {
        PlanarBody<double> a = any_body(), b = any_body();
        const auto momentum = [&] {
            return std::array{a.velocity.x / a.inverse_mass + b.velocity.x / b.inverse_mass,
                              a.velocity.y / a.inverse_mass + b.velocity.y / b.inverse_mass,
                              angular_momentum(a) + angular_momentum(b)};
        };
        const double before = kinetic(a) + kinetic(b), energy = number(0, 50);
        const std::array<double, 3> kept = momentum();
        const PlanarVelocity<double> moves = sum(at_pin(a), at_pin(b), -1);

        const auto release = planar_release(a, b, energy);
        a.velocity = sum(a.velocity, release.a);
        b.velocity = sum(b.velocity, release.b);

        const PlanarVelocity<double> after = sum(at_pin(a), at_pin(b), -1);
        const double round_off = 1e-11 * (1 + std::abs(after.spin));
        RC_ASSERT(std::abs(kinetic(a) + kinetic(b) - before - energy) < 1e-11 * (1 + before));
        RC_ASSERT(std::abs(after.x - moves.x) < round_off);
        RC_ASSERT(std::abs(after.y - moves.y) < round_off);
        for (std::size_t i = 0; i < 3; ++i) RC_ASSERT(std::abs(momentum()[i] - kept[i]) < 1e-10);
    });
}

TEST_CASE("in the plane the limit cases of a release are plain", "[planar]") {
    const PlanarBody<double> fixed;
    SECTION("one body fixed, pin at the other's centre: u'^2 = u^2 + 2 E/I") {
        const auto release = planar_release({1, 0.5, 0, 0, {0, 0, -3}}, fixed, 7.0);
        CHECK(-3 + release.a.spin == Approx(-4).epsilon(1e-14)); // √(9 + 2·7/2) = 4
        CHECK(release.a.x == 0);
        CHECK(release.a.y == 0);
        CHECK(nothing(release.b));
    }
    SECTION("one body fixed, pin off the other's centre: its inertia about the pin") {
        // 4 kg, 2 kg m², arm 0.5 m: 2 + 4·0.25 = 3 kg m²; √(1 + 2·12/3) = 3
        const auto release = planar_release({0.25, 0.5, 0.3, 0.4, {0.4, -0.3, 1}}, fixed, 12.0);
        CHECK(release.a.spin == Approx(2).epsilon(1e-14));
        CHECK(release.a.x == Approx(2 * 0.4).epsilon(1e-14));
        CHECK(release.a.y == Approx(2 * -0.3).epsilon(1e-14));
    }
    SECTION("pin at both centres, with and without mass to move") {
        for (const double inverse_mass : {0.0, 0.1}) {
            // 1/(1/2 + 1/3) = 1.2 kg m²: √(64 + 2·21.6/1.2) = 10; shared as 1/2 to 1/3
            const auto release = planar_release({inverse_mass, 1 / 2.0, 0, 0, {0, 0, 9}},
                                                {inverse_mass, 1 / 3.0, 0, 0, {0, 0, 1}}, 21.6);
            CHECK(release.a.spin == Approx(1.2).epsilon(1e-14));
            CHECK(release.b.spin == Approx(-0.8).epsilon(1e-14));
            CHECK(release.a.x == 0);
            CHECK(release.b.y == 0);
        }
    }
    SECTION("at rest A is turned forwards") {
        CHECK(planar_release({0, 0.5, 0, 0}, fixed, 4.0).a.spin == Approx(2).epsilon(1e-14));
    }
    SECTION("nothing to give, or nothing that can turn: no change") {
        const PlanarBody<double> locked{0, 0.5, 1, 0, {0, 0, 2}}; // its centre stays, off the pin
        const PlanarBody<double> mass{1, 0, 1, 0, {1, 1, 0}};     // does not turn
        for (const auto& [a, b, energy] :
             {std::tuple{fixed, fixed, 5.0}, std::tuple{locked, fixed, 5.0},
              std::tuple{locked, locked, 5.0}, std::tuple{mass, mass, 5.0},
              std::tuple{mass, fixed, 5.0}, std::tuple{mass, locked, 0.0}}) {
            const auto release = planar_release(a, b, energy);
            CHECK(nothing(release.a));
            CHECK(nothing(release.b));
        }
    }
    SECTION("a centre that cannot move is the limit of a heavy body") {
        const PlanarBody<double> rod{0.25, 0.5, 0.3, 0.4, {0.4, -0.3, 1}};
        const auto heavy = planar_release(rod, {1e-12, 0.4, -0.2, 0.1}, 12.0);
        const auto held = planar_release(rod, {0.0, 0.4, -0.2, 0.1}, 12.0);
        CHECK(held.a.spin == Approx(heavy.a.spin).epsilon(1e-9));
        CHECK(held.b.spin == Approx(heavy.b.spin).epsilon(1e-9));
    }
    SECTION("two that turn about fixed centres, arms in line, are the limit of heavy ones") {
        // the wheels of a gear: 2 and 1 m, 2 and 4 kg m²; and one whose centre is the pin
        for (const double arm : {-1.0, 0.0}) {
            const auto heavy =
                planar_release({1e-12, 0.5, 2, 0, {}}, {1e-12, 0.25, arm, 0, {}}, 12.0);
            const auto held = planar_release({0, 0.5, 2, 0, {}}, {0, 0.25, arm, 0, {}}, 12.0);
            CHECK(held.b.spin == Approx(heavy.b.spin).epsilon(1e-9));
            CHECK(held.a.spin == Approx(heavy.a.spin).margin(1e-9));
            // all the energy is theirs
            CHECK(held.a.spin * held.a.spin + 2 * held.b.spin * held.b.spin == Approx(12));
        }
    }
}

TEST_CASE("in the plane a release in float is that in double to its round-off", "[planar]") {
    const auto exact = planar_release<double>({0.25, 0.5, 0.3, 0.4, {0.1, -0.3, 1}},
                                              {0.5, 0.4, -0.2, 0.1, {0.3, 0, 0}}, 12);
    const auto single = planar_release<float>({0.25f, 0.5f, 0.3f, 0.4f, {0.1f, -0.3f, 1}},
                                              {0.5f, 0.4f, -0.2f, 0.1f, {0.3f, 0, 0}}, 12);
    CHECK(single.a.spin == Approx(exact.a.spin).epsilon(1e-6));
    CHECK(single.b.x == Approx(exact.b.x).epsilon(1e-6));
}
