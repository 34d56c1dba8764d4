// SPDX-License-Identifier: MIT
//
// What of a convex shape is over a face (face_points.hpp), beside where its corners are.
#include <btBulletDynamicsCommon.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <vector>

#include "ductile/bullet/face_points.hpp"
#include "ductile/vocabulary/vector.hpp"

namespace {

using namespace ductile;
using bullet::Gap;
using bullet::detail::Placed;

constexpr double exact = 4e-7; // of places of some metres in single precision [m]
constexpr double margin = 1e-3;

[[nodiscard]] btVector3 vector(double x, double y, double z) {
    return {btScalar(x), btScalar(y), btScalar(z)};
}
[[nodiscard]] btTransform at(const Vector3<double>& place, double tilt = 0) {
    return btTransform(btQuaternion(btVector3(0, 0, 1), btScalar(tilt)),
                       vector(place[0], place[1], place[2]));
}

/// Where Bullet has them meet along the height, the first one above unless `below`.
[[nodiscard]] std::vector<Gap> face_gaps(const Placed& a, const Placed& b, bool below = false) {
    const btVector3 zero(0, 0, 0), up(0, btScalar(below ? -1 : 1), 0);
    std::vector<Gap> gaps;
    bullet::detail::list_face_gaps(a, b, btManifoldPoint(zero, zero, up, 0), gaps);
    return gaps;
}

/// A brick of 0.4 by 0.1 by 0.2 m as a hull, margins and all.
struct Brick : btConvexHullShape {
    Brick() {
        setMargin(btScalar(margin));
        const btVector3 within = vector(0.2, 0.05, 0.1) - btScalar(margin) * btVector3(1, 1, 1);
        for (int i = 0; i < 8; ++i) {
            addPoint(within * btVector3(btScalar((i & 1) != 0 ? 1 : -1),
                                        btScalar((i & 2) != 0 ? 1 : -1),
                                        btScalar((i & 4) != 0 ? 1 : -1)));
        }
    }
};

} // namespace

TEST_CASE("Corners over a face: a hull over a box has all eight, the lowest first") {
    const Brick brick;
    const btBoxShape table(vector(1, 0.5, 1));
    constexpr double tilt = 0.02, height = 0.0601;
    const Placed on = {&table, at({5, -0.5, 2})}, falls = {&brick, at({5, height, 2}, tilt)};
    for (const bool swapped : {false, true}) {
        const std::vector<Gap> gaps = swapped ? face_gaps(on, falls, true) : face_gaps(falls, on);
        REQUIRE(gaps.size() == 8);
        const double low = height - 0.199 * std::sin(tilt) - 0.049 * std::cos(tilt) - margin,
                     high = low + 2 * 0.199 * std::sin(tilt);
        for (std::size_t i = 0; i < 4; ++i) {
            CHECK(gaps[i].away == Approx(i < 2 ? low : high).margin(exact));
            CHECK(double(gaps[i].normal.y()) == (swapped ? -1 : 1));
            const btVector3& below = swapped ? gaps[i].on_a : gaps[i].on_b;
            CHECK(double(below.y()) == Approx(0).margin(exact));
            const double side = i < 2 ? -1 : 1; // in world axes
            CHECK(double(below.x()) ==
                  Approx(5 + side * 0.199 * std::cos(tilt) + 0.049 * std::sin(tilt)).margin(exact));
        }
    }
}

TEST_CASE("Corners over a face: what stands out beyond its edge is Bullet's own matter") {
    const Brick brick;
    const btBoxShape table(vector(1, 0.5, 1));
    const Placed on = {&table, at({0, -0.5, 0})};
    CHECK(face_gaps({&brick, at({0.9, 0.05, 0})}, on).empty());
    CHECK_FALSE(face_gaps({&brick, at({0.79, 0.05, 0})}, on).empty());
    // the end that stands out is higher than any contact
    CHECK(face_gaps({&brick, at({0.9, 0.15, 0}, 0.5)}, on).size() == 4);
    CHECK(face_gaps({&brick, at({0.9, 0.15, 0}, -0.5)}, on).empty());
}

TEST_CASE("Corners over a face: cylinders, capsules, and boxes over a plane") {
    const btBoxShape table(vector(1, 0.5, 1)), box(vector(0.2, 0.05, 0.1));
    const btStaticPlaneShape plane(btVector3(0, 1, 0), 0);
    const btSphereShape ball(btScalar(0.1));
    const Placed on = {&table, at({0, -0.5, 0})}, ground = {&plane, at({0, 0, 0})};
    const auto near = [](const std::vector<Gap>& gaps) {
        std::size_t count = 0;
        for (const Gap& gap : gaps) count += gap.away < 1e-3 ? 1 : 0;
        return count;
    };
    const btCylinderShapeX lies(vector(0.2, 0.05, 0.05));
    const btCylinderShape stands(vector(0.05, 0.2, 0.05));
    const btCapsuleShapeX capsule(btScalar(0.05), btScalar(0.3));
    CHECK(near(face_gaps({&lies, at({0, 0.0505, 0})}, on)) == 2);
    CHECK(near(face_gaps({&lies, at({0, 0.06, 0}, 0.05)}, on)) == 1);
    CHECK(near(face_gaps({&stands, at({0, 0.2005, 0})}, on)) == 4);
    CHECK(near(face_gaps({&stands, at({0, 0.2005, 0}, 0.02)}, on)) == 3); // and rises by 2 mm
    CHECK(near(face_gaps({&capsule, at({0, 0.0505, 0})}, on)) == 2);
    CHECK(near(face_gaps({&box, at({0, 0.0505, 0})}, ground)) == 4);
    CHECK(near(face_gaps(ground, {&lies, at({0, 0.0505, 0})}, true)) == 2);
    CHECK(face_gaps({&box, at({0, 0.0505, 0})}, on).empty()); // Bullet knows them
    CHECK(face_gaps({&ball, at({0, 0.1, 0})}, on).empty());   // it has one
    const double rim = face_gaps({&stands, at({0, 0.3, 0}, 0.1)}, on).front().away;
    const double margin_of_it = double(stands.getMargin());
    CHECK(rim == Approx(0.3 - (0.2 - margin_of_it) * std::cos(0.1) -
                        (0.05 - margin_of_it) * std::sin(0.1) - margin_of_it)
                     .margin(exact));
}

TEST_CASE("Corners over a face: four of many span what all do") {
    btConvexHullShape disc;
    disc.setMargin(0);
    for (int i = 0; i < 32; ++i) {
        const double turn = i * 0.19634954; // 2 pi / 32
        for (const double y : {-0.05, 0.05}) {
            disc.addPoint(btVector3(btScalar(0.3 * std::cos(turn)), btScalar(y),
                                    btScalar(0.3 * std::sin(turn))));
        }
    }
    const btBoxShape table(vector(1, 0.5, 1));
    std::vector<Gap> gaps = face_gaps({&disc, at({0, 0.05, 0}, 1e-3)}, {&table, at({0, -0.5, 0})});
    const double nearest = gaps.front().away;
    std::erase_if(gaps, [](const Gap& gap) { return gap.away > 0.01; });
    REQUIRE(gaps.size() == 32);
    bullet::detail::keep_spread(gaps);
    REQUIRE(gaps.size() == 4);
    CHECK(gaps.front().away == nearest);
    const double area =
        double((gaps[1].on_b - gaps[0].on_b).cross(gaps[3].on_b - gaps[2].on_b).length()) / 2;
    CHECK(area == Approx(2 * 0.3 * 0.3).epsilon(0.02)); // of the largest square in it
}

TEST_CASE("Corners over a face: what is over a hull's face is what is over a box's") {
    const Brick brick;
    const btBoxShape table(vector(1, 0.5, 1)), box(vector(0.2, 0.05, 0.1));
    const btCylinderShapeX lies(vector(0.2, 0.05, 0.05));
    const btCapsuleShapeX capsule(btScalar(0.05), btScalar(0.3));
    btConvexHullShape slab; // its edges cut off, and points amid its faces
    slab.setMargin(btScalar(margin));
    for (int i = 0; i < 27; ++i) {
        const btVector3 side(btScalar(i % 3 - 1), btScalar(i / 3 % 3 - 1), btScalar(i / 9 - 1));
        const int edges = int(btFabs(side.x()) + btFabs(side.y()) + btFabs(side.z()));
        slab.addPoint(side * vector(1, 0.5 - margin, 1) * btScalar(edges == 3 ? 0.97 : 1));
        if (edges == 3) slab.addPoint(side * vector(0.98, 0.5 - margin, 0.98));
    }
    const Placed on_box = {&table, at({5, -0.5, 2})}, on_hull = {&slab, at({5, -0.5, 2})};
    for (const btCollisionShape* shape :
         std::initializer_list<const btCollisionShape*>{&brick, &lies, &capsule}) {
        for (const double tilt : {0.0, 0.02, -0.3}) {
            const Placed falls = {shape, at({5.1, 0.12, 2.2}, tilt)};
            const std::vector<Gap> expected = face_gaps(falls, on_box);
            for (const bool swapped : {false, true}) {
                const std::vector<Gap> gaps =
                    swapped ? face_gaps(on_hull, falls, true) : face_gaps(falls, on_hull);
                REQUIRE(gaps.size() == expected.size());
                for (std::size_t i = 0; i < gaps.size(); ++i) {
                    CHECK(gaps[i].away == Approx(expected[i].away).margin(exact));
                    CHECK(double(gaps[i].normal.y()) == Approx(swapped ? -1 : 1));
                }
            }
        }
    }
    CHECK(face_gaps({&box, at({5, 0.0505, 2})}, on_hull).size() == 8);
    CHECK(face_gaps({&brick, at({5.9, 0.05, 2})}, on_hull).empty());
    CHECK_FALSE(face_gaps({&brick, at({5.7, 0.05, 2})}, on_hull).empty());
}

TEST_CASE("Corners over a face: an end of a cylinder that looks elsewhere is none") {
    const btCylinderShapeX bar(vector(0.25, 0.05, 0.05));
    const btCylinderShape drum(vector(3, 0.5, 3));
    const Placed on = {&drum, at({0, -0.5, 0})};
    // its axis goes through the drum's far rim
    const double tilt = -std::atan2(1.143, 2.78);
    const std::vector<Gap> gaps = face_gaps(on, {&bar, at({0.22, 0.143, 0}, tilt)}, true);
    REQUIRE(gaps.size() == 5);
    CHECK(double(gaps[0].normal.y()) == -1);
    CHECK(gaps[0].away > -0.05);
}
