// SPDX-License-Identifier: MIT
#include <rapidcheck/catch.h>
#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <cstddef>

#include "ductile/joint/decoupled_rows.hpp"
#include "ductile/joint/link_pose.hpp"
#include "ductile/joint/link_types.hpp"

using namespace ductile;

namespace {

using V3 = Vector3<double>;
using M3 = Matrix3<double>;
using Order = std::array<std::size_t, 6>;

double number() { return double(*rc::gen::inRange(-1000, 1001)) / 1000; }
V3 vector() {
    const double x = number(), y = number(), z = number();
    return {x, y, z};
}
M3 turned() { return turned_by<double>(3 * vector(), M3::Identity()); }
JointFrame<double> frame() { return {.origin = vector(), .axes = turned()}; }
PrincipalMass<double> mass() { return {1 + number() / 2, V3(V3::Constant(2) + vector())}; }

BodyState<double> body(const PrincipalMass<double>& of) {
    BodyState<double> b{.position = vector(), .orientation = turned()};
    b.inverse_mass = of.inverse_mass;
    b.inverse_inertia = b.orientation * of.inverse_inertia.asDiagonal() * b.orientation.transpose();
    return b;
}

Matrix6<double> matrix(const CombinedRows<double>& rows) {
    Matrix6<double> result;
    for (int i = 0; i < 6; ++i) {
        result.row(i) << rows[std::size_t(i)].force.transpose(),
            rows[std::size_t(i)].moment.transpose();
    }
    return result;
}

} // namespace

TEST_CASE("the inverse mass from principal masses is that from the bodies", "[joint][decoupled]") {
    CHECK(rc::check([] {
        const auto mass_a = mass(), mass_b = mass();
        const BodyState<double> a = body(mass_a), b = body(mass_b);
        LinkPose<double> pose(frame(), frame());
        pose.look(a, b);
        const Matrix6<double> k =
            inverse_mass_along_b(pose, pose.orientation(), pose.displacement(), mass_a, mass_b);
        RC_ASSERT((k - inverse_mass_of_rows(a, b, pose.point(), pose.axes())).norm() <
                  1e-12 * k.norm());
        RC_ASSERT((inverse_by_blocks(k) * k).isIdentity(1e-9));
    }));
}

TEST_CASE("decoupled rows do not push each other, and bounds hold as before",
          "[joint][decoupled]") {
    constexpr int rigid = 4; // two plastic rows
    const Order order{3, 4, 0, 2, 5, 1};
    CHECK(rc::check([&] {
        const auto mass_a = mass(), mass_b = mass();
        LinkPose<double> pose(frame(), frame());
        pose.look(body(mass_a), body(mass_b));
        const Matrix6<double> k =
            inverse_mass_along_b(pose, pose.orientation(), pose.displacement(), mass_a, mass_b);
        const Matrix6<double> rows = matrix(decoupled_rows(k, order, rigid, 1e-15));
        Matrix6<double> pushed = rows * k * rows.transpose();
        for (int i = 0; i < 6; ++i) {
            for (int j = 0; j < 6; ++j) {
                if (i == j || (i >= rigid && j >= rigid)) continue;
                RC_ASSERT(std::abs(pushed(i, j)) < 1e-12 * k.norm());
            }
        }
        // an axis that is plastic is in its own row alone: its force is the impulse of that row
        for (int j = rigid; j < 6; ++j) {
            const auto axis = Eigen::Index(order[std::size_t(j)]);
            for (int i = 0; i < 6; ++i) RC_ASSERT(rows(i, axis) == (i == j ? 1 : 0));
        }
    }));
}

TEST_CASE("rows that no body can follow stay as they are", "[joint][decoupled]") {
    const Order order{3, 4, 0, 1, 2, 5};
    Matrix6<double> single = Matrix6<double>::Zero();
    for (int i = 0; i < 6; ++i) single(i, Eigen::Index(order[std::size_t(i)])) = 1;
    CHECK(matrix(decoupled_rows(Matrix6<double>(Matrix6<double>::Zero()), order, 5, 1e-15)) ==
          single);

    // a force that turns the body only about an axis that is held already
    Matrix6<double> k = Matrix6<double>::Identity();
    k(0, 0) = k(3, 0) = k(0, 3) = 1; // left of row 0 after row 3: nothing
    CHECK(matrix(decoupled_rows(k, order, 5, 1e-15)) == single);
}
