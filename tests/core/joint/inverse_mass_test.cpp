// SPDX-License-Identifier: MIT
#include "ductile/joint/inverse_mass.hpp"

#include <catch2/catch.hpp>

#include <Eigen/QR>
#include <cmath>

#include "core/joint/any_body.hpp"
#include "support/property.hpp"

using namespace ductile;
using any_body::Body;
using any_body::number;

TEST_CASE("the inverse by blocks is the inverse", "[joint][mass]") {
    test::prop("any two bodies", [] {
        const Matrix6<double> k =
            inverse_mass_at_joint(Body::any().at_joint(), Body::any().at_joint());
        const Matrix6<double> product = k * inverse_by_blocks(k);
        RC_ASSERT((product - Matrix6<double>::Identity()).norm() < 1e-9);
    });
}

TEST_CASE("an axis response moves its axis by one and leaves the held axes alone",
          "[joint][mass]") {
    test::prop("any two bodies, any axis, any number of held ones", [] {
        const Body a = Body::any(), b = Body::any();
        const Matrix6<double> k = inverse_mass_at_joint(a.at_joint(), b.at_joint());
        // any six directions at right angles
        Matrix6<double> any;
        for (int i = 0; i < 36; ++i) any(i) = number(-2, 2);
        for (int i = 0; i < 6; ++i) any(i, i) += 9;
        const Matrix6<double> q = any.householderQr().householderQ();
        const int held = *rc::gen::inRange(0, 6);
        const Vector6<double> axis = q.col(held);
        const Vector6<double> h = axis_response(k, axis, q, held);
        const Vector6<double> moved = k * h;
        RC_ASSERT(std::abs(axis.dot(moved) - 1) < 1e-9);
        for (int i = 0; i < held; ++i) RC_ASSERT(std::abs(q.col(i).dot(moved)) < 1e-9);
        for (int i = held + 1; i < 6; ++i) RC_ASSERT(std::abs(q.col(i).dot(h)) < 1e-9 * h.norm());
        RC_ASSERT(axis.dot(h) > 0);
    });
}

TEST_CASE("the response of two bodies that cannot move is none", "[joint][mass]") {
    const Matrix6<double> fixed = inverse_mass_at_joint(BodyAtJoint<double>{}, {});
    const Vector6<double> axis = Vector6<double>::Unit(2);
    const Matrix6<double> held = Matrix6<double>::Identity();
    CHECK(axis_response(fixed, axis, held, 2).isZero(0));
}
