// SPDX-License-Identifier: MIT
#include <rapidcheck/catch.h>
#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <limits>

#include "ductile/joint/isolated_pair.hpp"
#include "reference/boxed_lcp.hpp"

using namespace ductile;

namespace {

using V3 = Vector3<double>;
using M3 = Matrix3<double>;
constexpr double infinity = std::numeric_limits<double>::infinity();

double number() { return double(*rc::gen::inRange(-1000, 1001)) / 1000; }
V3 vector() {
    const double x = number(), y = number(), z = number();
    return {x, y, z};
}

BodyState<double> body() {
    BodyState<double> b;
    b.position = vector();
    b.inverse_mass = 1 + number() / 2;
    const V3 inertia = V3::Constant(2) + vector();
    b.inverse_inertia = inertia.asDiagonal();
    return b;
}

struct Pair {
    std::array<RowLimits<double>, 6> rows;
    Matrix6<double> k;
    Vector6<double> free;
};

Pair pair(double bound) {
    Pair p;
    const M3 axes =
        Eigen::AngleAxis<double>(3 * number(), (vector() + V3(0, 0, 2)).normalized()).matrix();
    p.k = inverse_mass_of_rows(body(), body(), vector(), axes);
    p.free << 3 * vector(), 5 * vector();
    for (std::size_t i = 0; i < 6; ++i) {
        p.rows[i] = {.lower = -bound,
                     .upper = bound,
                     .bias = number(),
                     .compliance = i % 2 == 0 ? 0 : 1 + number()};
    }
    return p;
}

Vector6<double> boxed_answer(const Pair& p, double dt) {
    Eigen::VectorXd free(6), lower(6), upper(6);
    Eigen::MatrixXd system = p.k;
    for (int i = 0; i < 6; ++i) {
        const auto& limits = p.rows[std::size_t(i)];
        system(i, i) += limits.compliance;
        free[i] = p.free[i] - limits.bias;
        lower[i] = limits.lower * dt;
        upper[i] = limits.upper * dt;
    }
    reference::BoxedLcp<double> lcp;
    return lcp.solve(system, free, lower, upper) / dt;
}

} // namespace

TEST_CASE("a pair alone is solved exactly where no row reaches its bound", "[joint][pair]") {
    rc::prop("rows with and without compliance", [] {
        const Pair p = pair(infinity);
        const Vector6<double> force = forces_of_isolated_pair(p.rows, p.k, p.free, 0.01);
        Vector6<double> missed = p.free + 0.01 * p.k * force;
        for (Eigen::Index i = 0; i < 6; ++i) {
            const auto& limits = p.rows[std::size_t(i)];
            missed[i] += limits.compliance * force[i] * 0.01 - limits.bias;
        }
        RC_ASSERT(missed.norm() < 1e-9 * (1 + p.free.norm()));
    });
}

TEST_CASE("with one row at its bound the pair's answer is that of the boxed problem",
          "[joint][pair]") {
    rc::prop("one bounded row", [] {
        Pair p = pair(infinity);
        const auto row = std::size_t(*rc::gen::inRange(0, 6));
        p.rows[row].lower = -5;
        p.rows[row].upper = 5;
        const Vector6<double> force = forces_of_isolated_pair(p.rows, p.k, p.free, 0.01);
        const Vector6<double> exact = boxed_answer(p, 0.01);
        RC_ASSERT((force - exact).norm() < 1e-8 * (1 + exact.norm()));
    });
}

TEST_CASE("the pair's answer keeps to every bound, and says nothing where it cannot know",
          "[joint][pair]") {
    rc::prop("all rows bounded", [] {
        const Pair p = pair(20);
        const Vector6<double> force = forces_of_isolated_pair(p.rows, p.k, p.free, 0.01);
        RC_ASSERT(force.cwiseAbs().maxCoeff() <= 20 * (1 + 1e-12));
        RC_ASSERT(force.cwiseAbs().maxCoeff() > 0);
    });
    Pair p;
    for (auto& row : p.rows) row = {.compliance = 0};
    p.k.setZero();
    p.free.setOnes();
    CHECK(forces_of_isolated_pair(p.rows, p.k, p.free, 0.01).allFinite());
}
