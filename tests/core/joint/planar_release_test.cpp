// SPDX-License-Identifier: MIT
#include <rapidcheck/catch.h>
#include <catch2/catch.hpp>

#include <cmath>
#include <tuple>

#include "ductile/joint/pair.hpp"
#include "ductile/joint/planar_release.hpp"

using namespace ductile;

namespace {

double number(int lo, int hi) { return *rc::gen::inRange(lo * 1000, hi * 1000) / 1000.0; }

/// A planar body, moving.
struct Body {
    PlanarBody<double> at_joint;
    double x, y, spin;

    static Body free() {
        return {{1 / number(1, 20), 1 / number(1, 5), number(-2, 2), number(-2, 2)},
                number(-5, 5),
                number(-5, 5),
                number(-5, 5)};
    }
    [[nodiscard]] double kinetic() const {
        return ((x * x + y * y) / at_joint.inverse_mass + spin * spin / at_joint.inverse_inertia) /
               2;
    }
    /// About the pin [N m s].
    [[nodiscard]] double angular_momentum() const {
        return spin / at_joint.inverse_inertia -
               (at_joint.arm_x * y - at_joint.arm_y * x) / at_joint.inverse_mass;
    }
    [[nodiscard]] double pin_x() const { return x - spin * at_joint.arm_y; }
    [[nodiscard]] double pin_y() const { return y + spin * at_joint.arm_x; }
    void change(const PlanarChange<double>& by) {
        x += by.x;
        y += by.y;
        spin += by.spin;
    }
};

/// The same body in space; its other two inertias are no matter.
template <class S>
BodyAtJoint<S> in_space(const PlanarBody<S>& body) {
    BodyAtJoint<S> result{.inverse_mass = body.inverse_mass, .arm = {body.arm_x, body.arm_y, 0}};
    result.inverse_inertia.diagonal() << S(0.7), S(1.3), body.inverse_inertia;
    return result;
}

template <class S>
BreakRelease<S> release_in_space(const PlanarBody<S>& a, const PlanarBody<S>& b, S spin, S energy) {
    const Vector6<S> axis = Vector6<S>::Unit(5);
    return break_release(in_space(a), in_space(b), axis, Vector6<S>(axis * spin), energy);
}

template <class S>
S apart(const PlanarChange<S>& planar, const VelocityChange<S>& spatial) {
    return std::abs(planar.x - spatial.linear.x()) + std::abs(planar.y - spatial.linear.y()) +
           std::abs(planar.spin - spatial.angular.z());
}

} // namespace

TEST_CASE("in the plane a release is the one in space", "[planar]") {
    rc::prop("any two bodies, arms, spin and energy", [] {
        const PlanarBody<double> a = Body::free().at_joint, b = Body::free().at_joint;
        const double spin = number(-10, 10), energy = number(0, 50);
        const auto planar = planar_release(a, b, spin, energy);
        const auto spatial = release_in_space(a, b, spin, energy);
        RC_ASSERT(apart(planar.a, spatial.a) < 1e-11 * (1 + std::abs(planar.a.spin)));
        RC_ASSERT(apart(planar.b, spatial.b) < 1e-11 * (1 + std::abs(planar.b.spin)));
    });
    rc::prop("either body fixed", [] {
        const PlanarBody<double> a = Body::free().at_joint, b{.arm_x = 3, .arm_y = -1};
        BodyAtJoint<double> fixed = in_space(b);
        fixed.inverse_inertia.setZero();
        const double spin = number(-10, 10), energy = number(0, 50);
        const Vector6<double> axis = Vector6<double>::Unit(5);
        const auto spatial =
            break_release(in_space(a), fixed, axis, Vector6<double>(axis * spin), energy);
        const auto planar = planar_release(a, b, spin, energy);
        RC_ASSERT(apart(planar.a, spatial.a) < 1e-11 * (1 + std::abs(planar.a.spin)));
        RC_ASSERT(planar.b.x == 0);
        RC_ASSERT(planar.b.y == 0);
        RC_ASSERT(planar.b.spin == 0);
        const auto swapped = planar_release(b, a, -spin, energy);
        RC_ASSERT(swapped.a.spin == 0);
        // at rest the hinge is turned forwards, whichever body comes first
        RC_ASSERT(spin == 0 ||
                  std::abs(swapped.b.spin - planar.a.spin) < 1e-14 * (1 + std::abs(planar.a.spin)));
    });
}

TEST_CASE("in the plane a release keeps momentum and pin and gives exactly its energy",
          "[planar]") {
    rc::prop("any two bodies whose pin is closed", [] {
        Body a = Body::free(), b = Body::free();
        // b's centre goes along with the pin
        b.x = a.pin_x() + b.spin * b.at_joint.arm_y;
        b.y = a.pin_y() - b.spin * b.at_joint.arm_x;
        const double before = a.kinetic() + b.kinetic(), energy = number(0, 50);
        const double along = a.x / a.at_joint.inverse_mass + b.x / b.at_joint.inverse_mass;
        const double round = a.angular_momentum() + b.angular_momentum();
        const double spin = a.spin - b.spin;

        const auto release = planar_release(a.at_joint, b.at_joint, spin, energy);
        a.change(release.a);
        b.change(release.b);

        RC_ASSERT(std::abs(a.kinetic() + b.kinetic() - before - energy) < 1e-11 * (1 + before));
        RC_ASSERT(std::abs(a.pin_x() - b.pin_x()) < 1e-11 * (1 + std::abs(a.spin - b.spin)));
        RC_ASSERT(std::abs(a.pin_y() - b.pin_y()) < 1e-11 * (1 + std::abs(a.spin - b.spin)));
        RC_ASSERT(std::abs(a.x / a.at_joint.inverse_mass + b.x / b.at_joint.inverse_mass - along) <
                  1e-10);
        RC_ASSERT(std::abs(a.angular_momentum() + b.angular_momentum() - round) < 1e-10);
        RC_ASSERT((a.spin - b.spin) * spin >= 0); // never turned round
    });
}

TEST_CASE("in the plane the limit cases of a release are plain", "[planar]") {
    const PlanarBody<double> fixed;
    SECTION("one body fixed, pin at the other's centre: u'^2 = u^2 + 2 E/I") {
        const auto release =
            planar_release({.inverse_mass = 1, .inverse_inertia = 0.5}, fixed, -3.0, 7.0);
        CHECK(-3 + release.a.spin == Approx(-4).epsilon(1e-14)); // √(9 + 2·7/2) = 4
        CHECK(release.a.x == 0);
        CHECK(release.a.y == 0);
        CHECK(release.b.spin == 0);
    }
    SECTION("one body fixed, pin off the other's centre: its inertia about the pin") {
        // 4 kg, 2 kg m², arm 0.5 m: 2 + 4·0.25 = 3 kg m²; √(1 + 2·12/3) = 3
        const PlanarBody<double> rod{0.25, 0.5, 0.3, 0.4};
        const auto release = planar_release(rod, fixed, 1.0, 12.0);
        CHECK(1 + release.a.spin == Approx(3).epsilon(1e-14));
        CHECK(release.a.x == Approx(release.a.spin * 0.4).epsilon(1e-14));
        CHECK(release.a.y == Approx(release.a.spin * -0.3).epsilon(1e-14));
    }
    SECTION("pin at both centres, with and without mass to move") {
        for (const double inverse_mass : {0.0, 0.1}) {
            // reduced inertia 1/(1/2 + 1/3) = 1.2 kg m²: √(64 + 2·E/1.2) = 10 for 21.6 J
            const auto release = planar_release({inverse_mass, 1 / 2.0, 0, 0},
                                                {inverse_mass, 1 / 3.0, 0, 0}, 8.0, 21.6);
            CHECK(release.a.spin == Approx(1.2).epsilon(1e-14)); // 2 and 3 kg m² share 2 rad/s
            CHECK(release.b.spin == Approx(-0.8).epsilon(1e-14));
            CHECK(release.a.x == 0);
            CHECK(release.b.y == 0);
        }
    }
    SECTION("a hinge at rest is turned forwards") {
        const auto release = planar_release({0, 0.5, 0, 0}, fixed, 0.0, 4.0);
        CHECK(release.a.spin == Approx(2).epsilon(1e-14));
    }
    SECTION("nothing to give, or nothing that can move: no change") {
        const PlanarBody<double> locked{0, 0.5, 1, 0}; // turns about a centre away from the pin
        const PlanarBody<double> mass{1, 0, 1, 0};     // does not turn
        for (const auto& [a, b, energy] :
             {std::tuple{fixed, fixed, 5.0}, std::tuple{locked, fixed, 5.0},
              std::tuple{locked, locked, 5.0}, std::tuple{mass, mass, 5.0},
              std::tuple{mass, locked, 0.0}}) {
            const auto release = planar_release(a, b, 2.0, energy);
            for (const auto& change : {release.a, release.b}) {
                CHECK(change.x == 0);
                CHECK(change.y == 0);
                CHECK(change.spin == 0);
            }
        }
    }
    SECTION("a centre that cannot move is the limit of a heavy body") {
        const PlanarBody<double> rod{0.25, 0.5, 0.3, 0.4};
        const auto heavy = planar_release(rod, {1e-12, 0.4, -0.2, 0.1}, 1.0, 12.0);
        const auto held = planar_release(rod, {0.0, 0.4, -0.2, 0.1}, 1.0, 12.0);
        CHECK(held.a.spin == Approx(heavy.a.spin).epsilon(1e-9));
        CHECK(held.b.spin == Approx(heavy.b.spin).epsilon(1e-9));
    }
}

TEST_CASE("in the plane a release in float is that in double to its round-off", "[planar]") {
    const auto exact = planar_release<double>({0.25, 0.5, 0.3, 0.4}, {0.5, 0.4, -0.2, 0.1}, 1, 12);
    const auto single =
        planar_release<float>({0.25f, 0.5f, 0.3f, 0.4f}, {0.5f, 0.4f, -0.2f, 0.1f}, 1, 12);
    CHECK(single.a.spin == Approx(exact.a.spin).epsilon(1e-6));
    CHECK(single.b.x == Approx(exact.b.x).epsilon(1e-6));
}
