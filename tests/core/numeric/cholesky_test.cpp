// SPDX-License-Identifier: MIT
#include "ductile/numeric/cholesky.hpp"

#include <Eigen/Cholesky>
#include <catch2/catch.hpp>
#include <limits>
#include <random>

#include "core/numeric/matrices.hpp"

using ductile::numeric::Cholesky;
using matrices::Case;
using matrices::few;

TEMPLATE_TEST_CASE("Cholesky solves positive definite systems as well as Eigen's", "",
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
            const Cholesky<S, N> factors(a);
            REQUIRE(factors.succeeded());
            const Vector x = factors.solve(b);
            CHECK(matrices::backward_error(a, x, b) < few);

            const Eigen::LLT<Eigen::MatrixXd> theirs(matrices::of_any_size(a));
            CHECK(matrices::difference(x, theirs.solve(matrices::of_any_size(b))) <
                  few * condition * TestType::epsilon);
            const Matrix lower = factors.lower();
            CHECK(matrices::difference(Matrix(lower * lower.transpose()),
                                       matrices::of_any_size(a)) < few * TestType::epsilon);
            for (int j = 0; j < N; ++j) {
                CHECK(lower(j, j) > 0);
                for (int i = 0; i < j; ++i) CHECK(lower(i, j) == 0);
            }
        }
    }
}

TEST_CASE("Cholesky reads only the lower triangle") {
    std::mt19937 random(2);
    const Eigen::Matrix3d whole = matrices::symmetric<double, 3>(Eigen::Vector3d(1, 2, 3), random);
    Eigen::Matrix3d half = whole;
    half(0, 1) = half(0, 2) = half(1, 2) = std::numeric_limits<double>::quiet_NaN();
    const Eigen::Vector3d b(1, -2, 3);
    CHECK(Cholesky<double, 3>(half).solve(b) == Cholesky<double, 3>(whole).solve(b));
}

TEMPLATE_TEST_CASE("Cholesky says where a matrix is not positive definite", "", (Case<double, 1>),
                   (Case<double, 2>), (Case<double, 3>), (Case<double, 6>), (Case<float, 6>)) {
    using S = typename TestType::Scalar;
    using Vector = typename TestType::Vector;
    using Matrix = typename TestType::Matrix;
    constexpr int N = TestType::N;
    std::mt19937 random(3);
    for (int repeat = 0; repeat < 50; ++repeat) {
        Vector eigenvalues = Vector::Ones();
        eigenvalues[N - 1] = S(-0.1);
        CHECK_FALSE(Cholesky<S, N>(matrices::symmetric<S, N>(eigenvalues, random)).succeeded());
    }
    CHECK_FALSE(Cholesky<S, N>(Matrix::Zero()).succeeded());
    CHECK_FALSE(Cholesky<S, N>(Matrix::Constant(std::numeric_limits<S>::quiet_NaN())).succeeded());
    CHECK_FALSE(Cholesky<S, N>().succeeded());
    CHECK(Cholesky<S, N>(Matrix::Identity()).succeeded());
}

TEST_CASE("Cholesky says where half of the digits of a pivot are gone") {
    // the second pivot is 1 - a²
    const auto regular = [](double a) {
        Eigen::Matrix2d matrix;
        matrix << 4, 2 * a, 2 * a, 1;
        return Cholesky<double, 2>(matrix).regular();
    };
    CHECK(regular(0));
    CHECK(regular(1 - 1e-7));
    CHECK_FALSE(regular(1 - 1e-9));
    CHECK_FALSE(regular(1));
    CHECK_FALSE(regular(2));
    CHECK_FALSE(regular(std::numeric_limits<double>::quiet_NaN()));
    CHECK_FALSE(Cholesky<double, 2>().regular());
}

TEST_CASE("A matrix of fewer rows is filled up with those of 1") {
    std::mt19937 random(4);
    const Eigen::Matrix3d small = matrices::symmetric<double, 3>(Eigen::Vector3d(1, 2, 3), random);
    Eigen::Matrix<double, 6, 6> large = Eigen::Matrix<double, 6, 6>::Identity();
    large.topLeftCorner<3, 3>() = small;
    const Eigen::Vector3d b(1, -2, 3);
    Eigen::Matrix<double, 6, 1> filled = Eigen::Matrix<double, 6, 1>::Zero();
    filled.head<3>() = b;
    const Eigen::Matrix<double, 6, 1> x = Cholesky<double, 6>(large).solve(filled);
    const Eigen::Vector3d expected = Cholesky<double, 3>(small).solve(b);
    for (int i = 0; i < 3; ++i) {
        CHECK(x[i] == Approx(expected[i]).epsilon(1e-15));
        CHECK(x[3 + i] == 0);
    }
}
