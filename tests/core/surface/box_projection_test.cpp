// SPDX-License-Identifier: MIT
#include "ductile/surface/box_projection.hpp"

#include <catch2/catch.hpp>

#include <Eigen/Core>
#include <limits>

#include "core/surface/cases.hpp"
#include "ductile/numeric/ldlt.hpp"
#include "support/property.hpp"

using namespace ductile;
using namespace ductile::test;

TEST_CASE("the box solver finds the closest point of a box", "[surface]") {
    using Vector = Eigen::Matrix<double, 4, 1>;
    test::prop("complementarity", [] {
        const Vector middle = any_vector<Vector>();
        const Vector half = any_vector<Vector>().cwiseAbs(); // now and then without width
        const Vector lower = middle - half, upper = middle + half;
        const auto k = any_stiffness<Eigen::Matrix4d>();
        const Vector trial = 5 * any_vector<Vector>();
        const Vector force = project_on_box<double, 4>(trial, lower, upper, k);
        const Vector slip = numeric::solve_semidefinite(k, Vector(trial - force));
        constexpr double tolerance = 1e-11; // condition about 100
        for (int i = 0; i < 4; ++i) {
            RC_ASSERT(force[i] >= lower[i]);
            RC_ASSERT(force[i] <= upper[i]);
            if (force[i] < upper[i]) RC_ASSERT(slip[i] <= tolerance);
            if (force[i] > lower[i]) RC_ASSERT(slip[i] >= -tolerance);
        }
    });
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const Eigen::Vector2d rigid = project_on_box<double, 2>({5, -7}, {-infinity, -1}, {infinity, 1},
                                                            Eigen::Matrix2d::Identity());
    CHECK(rigid == Eigen::Vector2d(5, -1));
}
