// SPDX-License-Identifier: MIT
#include "ductile/numeric/lu.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "core/numeric/matrices.hpp"

using ductile::numeric::determinant;
using ductile::numeric::inverse;
using ductile::numeric::Lu;
using matrices::Case;
using matrices::few;

TEMPLATE_TEST_CASE("LU solves, inverts and takes determinants as well as Eigen's", "",
                   (Case<double, 1>), (Case<double, 2>), (Case<double, 3>), (Case<double, 4>),
                   (Case<double, 5>), (Case<double, 6>), (Case<float, 6>)) {
    using S = typename TestType::Scalar;
    using Vector = typename TestType::Vector;
    using Matrix = typename TestType::Matrix;
    constexpr int N = TestType::N;
    const double hard = sizeof(S) == 8 ? 1e11 : 1e4;
    std::mt19937 random(1);
    for (const double condition : {1.0, 1e2, hard}) {
        const double allowed = few * condition * TestType::epsilon;
        for (int repeat = 0; repeat < 50; ++repeat) {
            const Matrix left = matrices::axes<S, N>(random), right = matrices::axes<S, N>(random);
            const Matrix a = left * matrices::falling<S, N>(condition).asDiagonal() * right;
            const Vector b = matrices::random<Vector>(random);
            const Lu<S, N> factors(a);
            const Vector x = factors.solve(b);
            CHECK(matrices::backward_error(a, x, b) < few);

            const Eigen::PartialPivLU<Eigen::MatrixXd> theirs(matrices::of_any_size(a));
            CHECK(matrices::difference(x, theirs.solve(matrices::of_any_size(b))) < allowed);
            CHECK(matrices::difference(factors.inverse(), theirs.inverse()) < allowed);
            // cofactors lose as many digits as the determinant is small
            const double lost = std::pow(double(a.norm()), N) / std::abs(theirs.determinant());
            CHECK(matrices::difference(inverse(a), theirs.inverse()) <
                  (N > 3 ? allowed : few * lost * TestType::epsilon));
            CHECK(std::abs(double(factors.determinant()) / theirs.determinant() - 1) < allowed);
        }
    }
}

TEMPLATE_TEST_CASE("LU finds the pivots of a matrix with a diagonal of zeros", "",
                   (Case<double, 2>), (Case<double, 3>), (Case<double, 6>), (Case<float, 6>)) {
    using S = typename TestType::Scalar;
    using Vector = typename TestType::Vector;
    using Matrix = typename TestType::Matrix;
    constexpr int N = TestType::N;
    Matrix shift = Matrix::Zero();
    Vector b;
    for (int i = 0; i < N; ++i) {
        shift(i, (i + 1) % N) = 1;
        b[i] = S(i + 1);
    }
    CHECK(shift * Lu<S, N>(shift).solve(b) == b);
    CHECK(Lu<S, N>(shift).inverse() == shift.transpose());
    CHECK(inverse(shift) == shift.transpose());
    CHECK(Lu<S, N>(shift).determinant() == (N % 2 == 0 ? S(-1) : S(1)));
}

TEST_CASE("The 3x3 inverse is Eigen's to the bit, the determinant to round-off") {
    std::mt19937 random(2);
    for (int repeat = 0; repeat < 1000; ++repeat) {
        const auto a = matrices::random<Eigen::Matrix3d>(random);
        const Eigen::Matrix3d theirs = a.inverse();
        CHECK(inverse(a) == theirs);
        CHECK(std::abs(determinant(a) - a.determinant()) <=
              few * std::numeric_limits<double>::epsilon());
    }
}

TEMPLATE_TEST_CASE("A singular matrix has no finite inverse", "", (Case<double, 1>),
                   (Case<double, 2>), (Case<double, 3>), (Case<double, 6>), (Case<float, 6>)) {
    using S = typename TestType::Scalar;
    using Vector = typename TestType::Vector;
    using Matrix = typename TestType::Matrix;
    constexpr int N = TestType::N;
    Matrix a = Matrix::Identity();
    a(N - 1, N - 1) = 0;
    CHECK_FALSE(inverse(a).allFinite());
    CHECK_FALSE(Lu<S, N>(a).inverse().allFinite());
    CHECK_FALSE(Lu<S, N>(a).solve(Vector::Ones()).allFinite());
    CHECK(Lu<S, N>(a).determinant() == 0);
    const Matrix nothing = Matrix::Zero();
    CHECK_FALSE(inverse(nothing).allFinite());
    CHECK(Lu<S, N>(nothing).determinant() == 0);
}
