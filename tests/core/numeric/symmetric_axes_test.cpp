// SPDX-License-Identifier: MIT
#include "ductile/numeric/symmetric_axes.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <random>

#include "core/numeric/matrices.hpp"

using ductile::Matrix3;
using ductile::Vector3;
using ductile::numeric::symmetric_axes;

TEMPLATE_TEST_CASE("Principal axes are those of Eigen's", "", double, float) {
    using S = TestType;
    std::mt19937 random(1);
    const S few = 20 * std::numeric_limits<S>::epsilon();
    for (int repeat = 0; repeat < 200; ++repeat) {
        const Matrix3<S> turn = matrices::axes<S, 3>(random);
        Vector3<S> values(3, 2, 1);
        if (repeat % 3 == 1) values = {1, 1, S(1e-3)}; // a bar
        if (repeat % 3 == 2) values = {5, 5, 5};
        const Matrix3<S> a = turn * values.asDiagonal() * turn.transpose();
        const auto found = symmetric_axes(a);
        const Matrix3<S> again = found.axes * found.values.asDiagonal() * found.axes.transpose();
        CHECK((again - a).cwiseAbs().maxCoeff() < few * values.maxCoeff());
        CHECK((found.axes.transpose() * found.axes - Matrix3<S>::Identity()).norm() < few);
        CHECK(found.axes.determinant() == Approx(1));
        Eigen::SelfAdjointEigenSolver<Matrix3<S>> theirs(a);
        std::array<S, 3> mine{found.values[0], found.values[1], found.values[2]};
        std::sort(mine.begin(), mine.end());
        for (int i = 0; i < 3; ++i) {
            CHECK(std::abs(mine[std::size_t(i)] - theirs.eigenvalues()[i]) <
                  few * values.maxCoeff());
        }
    }
}

TEST_CASE("A diagonal matrix keeps its axes in their order") {
    const Matrix3<double> a = Vector3<double>(1, 3, 2).asDiagonal();
    const auto found = symmetric_axes(a);
    CHECK(found.axes == Matrix3<double>::Identity());
    CHECK(found.values == Vector3<double>(1, 3, 2));
}
