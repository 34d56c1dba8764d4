// SPDX-License-Identifier: MIT
#include "ductile/joint/mean_flow.hpp"

#include <catch2/catch.hpp>

#include "ductile/surface/ellipsoid.hpp"

using namespace ductile;

namespace {

using V2 = Eigen::Vector2d;
using M2 = Eigen::Matrix2d;

/// On the surface, against `flow` where that is along the normal [N].
V2 against(const Ellipsoid<double, 2>& surface, const V2& flow) {
    const V2 force = -surface.semi_axes().cwiseAbs2().cwiseProduct(flow);
    return force / surface.value(force);
}

} // namespace

TEST_CASE("rows of like strength begin a step with the velocities they have", "[joint]") {
    const Ellipsoid<double, 2> surface({.capacity = {4, 3}});
    const V2 start(2, -1), aside(0.3, 0.2);
    const V2 force = against(surface, start);
    const double stops = 2 * start.norm() / 4; // no step in which it flows is longer [s]
    const M2 mass = 2 * M2::Identity();
    CHECK(flow_at_start(surface, force, V2(start + aside), mass, stops / 2) == start + aside);
}

TEST_CASE("what is along the normal stays, however strong a row is", "[joint]") {
    for (const double strong : {3.0, 1e3, 1e9}) {
        const Ellipsoid<double, 2> surface({.capacity = {strong, 2}});
        const V2 force(-0.6 * strong, -0.8 * 2);
        const V2 start = -5 * surface.normal(force);
        const V2 flow = flow_at_start(surface, force, start, M2::Identity(), 0.1);
        CHECK((flow - start).norm() < 1e-12 * start.norm());
    }
}

TEST_CASE("a row far stronger than the one that flows ends its step along the normal", "[joint]") {
    constexpr double strong = 1e4, weak = 10, mass = 2, dt = 1e-3;
    const Ellipsoid<double, 2> surface({.capacity = {strong, weak}});
    const V2 force(0, -weak), start(0.5, 3);
    const V2 flow = flow_at_start(surface, force, start, M2(mass * M2::Identity()), dt);
    CHECK(flow[1] == Approx(start[1]));
    // the force of its mean velocity v is v R²/P: m (u' - u) = -dt (u' + flow)/2 R²/P
    const double rate = strong * strong / (mass * weak * start[1]) * dt / 2;
    const double end = (start[0] - rate * flow[0]) / (1 + rate);
    CHECK(std::abs(end) < 1e-12 * start[0]);
    const double with_its_own = (start[0] - rate * start[0]) / (1 + rate);
    CHECK(with_its_own < -0.99 * start[0]);
}
