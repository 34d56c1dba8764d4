// SPDX-License-Identifier: MIT
#include "ductile/numeric/small_vector.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "core/numeric/matrices.hpp"

using namespace ductile;
using matrices::Case;
using matrices::few;

TEMPLATE_TEST_CASE("products and lengths are those of the entries", "", (Case<double, 1>),
                   (Case<double, 3>), (Case<double, 6>), (Case<float, 6>)) {
    using Vector = typename TestType::Vector;
    using Matrix = typename TestType::Matrix;
    constexpr int N = TestType::N;
    std::mt19937 random(1);
    for (int repeat = 0; repeat < 20; ++repeat) {
        const Matrix a = matrices::random<Matrix>(random);
        const Vector x = matrices::random<Vector>(random), y = matrices::random<Vector>(random);
        const Vector ax = numeric::times(a, x);
        double product = 0, square = 0, most = 0;
        for (int i = 0; i < N; ++i) {
            product += double(x[i]) * double(y[i]);
            square += double(x[i]) * double(x[i]);
            most = std::max(most, std::abs(double(x[i])));
            double row = 0;
            for (int j = 0; j < N; ++j) row += double(a(i, j)) * double(x[j]);
            CHECK(std::abs(double(ax[i]) - row) <= few * TestType::epsilon);
        }
        CHECK(std::abs(double(numeric::dot(x, y)) - product) <= few * TestType::epsilon);
        CHECK(double(numeric::length(x)) ==
              Approx(std::sqrt(square)).epsilon(few * TestType::epsilon));
        CHECK(double(numeric::largest(x)) == most);
    }
}

TEMPLATE_TEST_CASE("a length is right whatever its size", "", (Case<double, 3>), (Case<float, 6>)) {
    using S = typename TestType::Scalar;
    using Vector = typename TestType::Vector;
    using Limits = std::numeric_limits<S>;
    Vector x = Vector::Zero();
    CHECK(numeric::length(x) == 0);
    for (const S size : {S(1), Limits::max() / 8, Limits::min(), Limits::min() / 8}) {
        x[0] = 3 * size;
        x[2] = -4 * size;
        CHECK(double(numeric::length(x) / size) == Approx(5).epsilon(few * TestType::epsilon));
    }
    x[0] = Limits::infinity();
    CHECK(numeric::length(x) == Limits::infinity());
    for (const S other : {S(0), Limits::min(), Limits::infinity()}) {
        x[0] = Limits::quiet_NaN();
        x[2] = other;
        CHECK(std::isnan(numeric::length(x)));
    }
}
