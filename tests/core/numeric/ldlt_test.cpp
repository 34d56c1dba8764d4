// SPDX-License-Identifier: MIT
#include "ductile/numeric/ldlt.hpp"

#include <Eigen/Cholesky>
#include <catch2/catch.hpp>
#include <limits>
#include <random>

#include "core/numeric/matrices.hpp"

using ductile::numeric::solve_semidefinite;
using matrices::Case;
using matrices::few;

TEMPLATE_TEST_CASE("L D L' solves positive definite systems as well as Eigen's", "",
                   (Case<double, 1>), (Case<double, 2>), (Case<double, 3>), (Case<double, 4>),
                   (Case<double, 5>), (Case<double, 6>), (Case<float, 6>)) {
    using S = typename TestType::Scalar;
    using Vector = typename TestType::Vector;
    using Matrix = typename TestType::Matrix;
    constexpr int N = TestType::N;
    const double hard = sizeof(S) == 8 ? 1e13 : 1e5;
    std::mt19937 random(1);
    for (const double condition : {1.0, 1e2, hard}) {
        for (int repeat = 0; repeat < 50; ++repeat) {
            const Matrix a = matrices::symmetric<S, N>(matrices::falling<S, N>(condition), random);
            const Vector b = matrices::random<Vector>(random);
            const Vector x = solve_semidefinite(a, b);
            CHECK(matrices::backward_error(a, x, b) < few);
            const Eigen::LDLT<Eigen::MatrixXd> theirs(matrices::of_any_size(a));
            CHECK(matrices::difference(x, theirs.solve(matrices::of_any_size(b))) <
                  few * condition * TestType::epsilon);
        }
    }
}

TEMPLATE_TEST_CASE("L D L' solves singular systems that have a solution", "", (Case<double, 2>),
                   (Case<double, 3>), (Case<double, 6>), (Case<float, 6>)) {
    using Vector = typename TestType::Vector;
    using Matrix = typename TestType::Matrix;
    constexpr int N = TestType::N;
    std::mt19937 random(2);
    for (int rank = 1; rank < N; ++rank) {
        for (int repeat = 0; repeat < 50; ++repeat) {
            Matrix root = matrices::random<Matrix>(random);
            for (int j = rank; j < N; ++j) root.col(j).setZero();
            const Matrix a = root * root.transpose();
            const Vector b = a * matrices::random<Vector>(random);
            const Vector x = solve_semidefinite(a, b);
            // round-off of b beside what A can give, over a pivot that is round-off itself, puts a
            // part of the null space into x, which is then as large as the residual allows
            CHECK(matrices::backward_error(a, x, b) < few);
        }
    }
}

TEMPLATE_TEST_CASE("A row of zeros gets nothing and takes nothing", "", (Case<double, 2>),
                   (Case<double, 3>), (Case<double, 6>), (Case<float, 6>)) {
    using S = typename TestType::Scalar;
    using Vector = typename TestType::Vector;
    using Matrix = typename TestType::Matrix;
    constexpr int N = TestType::N;
    std::mt19937 random(3);
    for (int none = 0; none < N; ++none) {
        for (const S diagonal : {S(0), std::numeric_limits<S>::min()}) {
            Matrix a = matrices::symmetric<S, N>(matrices::falling<S, N>(10), random);
            for (int i = 0; i < N; ++i) a(i, none) = a(none, i) = 0;
            a(none, none) = diagonal;
            const Vector b = matrices::random<Vector>(random);
            const Vector x = solve_semidefinite(a, b);
            CHECK(x[none] == 0);

            Matrix filled = a;
            filled(none, none) = 1;
            Vector without = b;
            without[none] = 0;
            const Eigen::LDLT<Eigen::MatrixXd> theirs(matrices::of_any_size(filled));
            CHECK(matrices::difference(x, theirs.solve(matrices::of_any_size(without))) <
                  few * 10 * TestType::epsilon);
        }
    }
    const Matrix nothing = Matrix::Zero();
    CHECK(solve_semidefinite(nothing, Vector(Vector::Ones())) == Vector::Zero());
}

TEST_CASE("What is not finite stays so") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const Eigen::Vector3d ones(1, 1, 1);
    CHECK_FALSE(
        solve_semidefinite(Eigen::Matrix3d(Eigen::Matrix3d::Identity()), Eigen::Vector3d(1, nan, 1))
            .allFinite());
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j <= i; ++j) {
            Eigen::Matrix3d a = Eigen::Matrix3d::Identity();
            a(i, j) = a(j, i) = nan;
            CHECK_FALSE(solve_semidefinite(a, ones).allFinite());
        }
    }
}
