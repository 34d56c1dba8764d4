// SPDX-License-Identifier: MIT
#include "ductile/joint/off_normal_work.hpp"

#include <catch2/catch.hpp>

#include "ductile/surface/ellipsoid.hpp"

using namespace ductile;

namespace {

using V2 = Eigen::Vector2d;
const Ellipsoid<double, 2> surface({.capacity = {4, 2}});

} // namespace

TEST_CASE("associated flow does no work off the normal", "[joint][certificate]") {
    const V2 force(4 * 0.6, 2 * 0.8);
    const V2 flow = -3 * surface.normal(force);
    CHECK(off_normal_work(surface, force, flow, -force.dot(flow)) < 1e-15 * force.norm());
}

TEST_CASE("flow of one row where both should flow is off by half of what it should not have done",
          "[joint][certificate]") {
    // of the work D the normal gives the rows 0.36 D and 0.64 D: D/2 (0.64 + 0.64)
    const V2 force(4 * 0.6, 2 * 0.8);
    const double work = 5;
    const V2 flow(-work / force[0], 0);
    CHECK(off_normal_work(surface, force, flow, work) == Approx(0.64 * work).epsilon(1e-14));
}

TEST_CASE("where nothing flowed nothing was done off the normal", "[joint][certificate]") {
    CHECK(off_normal_work(surface, V2(0, 0), V2(0, 0), 0.0) == 0);
    CHECK(off_normal_work(surface, V2(1, 0), V2(-1, 0), -1.0) == 0);
}
