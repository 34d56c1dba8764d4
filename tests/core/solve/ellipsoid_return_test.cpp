// SPDX-License-Identifier: MIT
#include "ductile/solve/ellipsoid_return.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using ductile::Vector6;
using ductile::solve::closest_on_ellipsoid;

TEST_CASE("The closest point lies on the ellipsoid and the way to it along its normal", "[solve]") {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (int repeat = 0; repeat < 20000; ++repeat) {
        const int count = 1 + repeat % 6;
        Vector6<double> y = Vector6<double>::Zero(), metric = Vector6<double>::Ones();
        double semi_axes[6] = {};
        for (int i = 0; i < count; ++i) {
            y[i] = uniform(random) * std::pow(10, 4 * uniform(random));
            metric[i] = std::pow(10, 6 * uniform(random));
            semi_axes[i] = std::pow(10, 4 * uniform(random));
        }
        const auto found = closest_on_ellipsoid(y, metric, semi_axes, count);
        double before = 0, gauge = 0;
        for (int i = 0; i < count; ++i) {
            before += std::pow(y[i] / semi_axes[i], 2);
            gauge += std::pow(found.point[i] / semi_axes[i], 2);
        }
        if (before <= 1) {
            CHECK(found.multiplier == 0);
            CHECK(found.point == y);
            continue;
        }
        CHECK(found.multiplier > 0);
        CHECK(gauge == Approx(1).epsilon(1e-12));
        for (int i = 0; i < count; ++i) {
            const double along = metric[i] * (y[i] - found.point[i]);
            const double normal = found.multiplier * found.point[i] / std::pow(semi_axes[i], 2);
            CHECK(along == Approx(normal).epsilon(1e-9).margin(1e-12 * metric[i] * std::abs(y[i])));
        }
    }
}

TEST_CASE("A semi-axis of zero carries nothing", "[solve]") {
    const Vector6<double> ones = Vector6<double>::Ones();
    const double none[6] = {0, 0, 0, 0, 0, 0}, some[6] = {0, 2, 0, 0, 0, 0};
    CHECK(closest_on_ellipsoid(ones, ones, none, 2).point.isZero());
    const auto found = closest_on_ellipsoid(ones, ones, some, 2);
    CHECK(found.point[0] == 0);
    CHECK(found.point[1] == Approx(1).epsilon(0.01));
}
