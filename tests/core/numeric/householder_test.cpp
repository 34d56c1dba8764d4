// SPDX-License-Identifier: MIT
#include "ductile/numeric/householder.hpp"

#include <Eigen/QR>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "core/numeric/matrices.hpp"

using ductile::numeric::basis_along;
using matrices::Case;
using matrices::few;

TEMPLATE_TEST_CASE("A vector of any size is completed to an orthonormal basis", "",
                   (Case<double, 1>), (Case<double, 2>), (Case<double, 3>), (Case<double, 4>),
                   (Case<double, 5>), (Case<double, 6>), (Case<float, 6>)) {
    using S = typename TestType::Scalar;
    using Vector = typename TestType::Vector;
    using Matrix = typename TestType::Matrix;
    constexpr double tolerance = few * TestType::epsilon;
    std::mt19937 random(1);
    for (const S size : {S(1e-6), S(1), S(1e6)}) {
        for (int repeat = 0; repeat < 50; ++repeat) {
            const Vector x = size * matrices::random<Vector>(random);
            const Matrix basis = basis_along(x);
            CHECK(double((basis.transpose() * basis - Matrix::Identity()).norm()) <= tolerance);
            CHECK(double(std::abs(std::abs(basis.col(0).dot(x)) - x.norm())) <=
                  tolerance * double(x.norm()));
            const Eigen::HouseholderQR<Eigen::MatrixXd> theirs(matrices::of_any_size(x));
            CHECK(matrices::difference(basis, theirs.householderQ()) <= tolerance);
        }
    }
}

TEMPLATE_TEST_CASE("A vector along the first axis, and none at all, is given the axes", "",
                   (Case<double, 1>), (Case<double, 3>), (Case<float, 6>)) {
    using S = typename TestType::Scalar;
    using Vector = typename TestType::Vector;
    using Matrix = typename TestType::Matrix;
    for (const S along : {S(-2), S(0), S(2)}) {
        CHECK(basis_along(Vector(along * Vector::Unit(0))) == Matrix::Identity());
    }
}
