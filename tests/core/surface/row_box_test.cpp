// SPDX-License-Identifier: MIT
#include "ductile/surface/row_box.hpp"

#include <catch2/catch.hpp>

#include <Eigen/Core>
#include <cmath>
#include <string>
#include <type_traits>

#include "core/surface/cases.hpp"
#include "core/surface/enforced_rows.hpp"
#include "support/property.hpp"

using namespace ductile;
using namespace ductile::test;

namespace {

template <class Mapping, class T>
Eigen::Vector2d travel_of(const T& surface, int steps_per_second, const Eigen::Matrix2d& believed) {
    Rows<Mapping, T> rows{surface, masses, believed};
    const double dt = 1.0 / steps_per_second;
    for (int i = 0; i < 2 * steps_per_second; ++i) {
        const double t = (i + 0.5) * dt;
        const double pulse = t < 1 ? 1.3 : 0;
        rows.step({0.4 + pulse * std::cos(4 * t), 0.3 + pulse * std::sin(5 * t)}, dt);
    }
    return rows.travel;
}

} // namespace

TEST_CASE("the box along a prediction touches the surface there and holds what is inside",
          "[surface]") {
    for_every_surface<double>([](const std::string& name, const auto& surface) {
        using T = std::decay_t<decltype(surface)>;
        using Vector = typename T::Vector;
        test::prop(name, [&] {
            const auto ray = any_direction<Vector>();
            const double value = any_number(0.0, 3.0);
            const Vector predicted = ray * (value / surface.value(ray));
            const auto box = box_along(surface, predicted);
            const Vector point = project_radially(surface, predicted);
            for (int i = 0; i < T::dimension; ++i) {
                RC_ASSERT(box.lower[i] <= point[i]);
                RC_ASSERT(box.upper[i] >= point[i]);
                for (const double bound : {box.lower[i], box.upper[i]}) { // the chord ends on it
                    Vector end = point;
                    end[i] = bound;
                    RC_ASSERT(std::abs(surface.value(end) - 1) <= 1e-12);
                }
            }
            // a load that is as predicted and inside is held, whatever the masses
            if (value < 1) {
                const auto mass = any_stiffness<typename T::Matrix>();
                RC_ASSERT((enforce(box, point, mass) - point).norm() <= 1e-12);
            }
        });
    });
}

TEST_CASE("told the right force, the rows give it and its associated flow", "[surface]") {
    for_every_surface<double>([](const std::string& name, const auto& surface) {
        using T = std::decay_t<decltype(surface)>;
        using Vector = typename T::Vector;
        test::prop(name, [&] {
            Vector ray = any_direction<Vector>();
            for (double& entry : ray) { // the chord of a row without force: below
                if (std::abs(entry) < 1e-3) entry = 1e-3;
            }
            const Vector trial = ray * ((1 + any_number(0.01, 10.0)) / surface.value(ray));
            const auto mass = any_stiffness<typename T::Matrix>();
            const Vector exact = surface.project(trial, mass);
            RC_ASSERT((enforce(box_along(surface, exact), trial, mass) - exact).norm() <= 1e-6);
        });
    });
}

TEST_CASE("a row without force in flow gets no room, and its chord only touches", "[surface]") {
    const RectangleAxialBending<double> surface;
    const auto box = box_along(surface, {0, 1});
    CHECK(box.upper[1] == Approx(1).epsilon(1e-15));
    CHECK(std::abs(box.upper[0]) < 1e-7);            // round-off of the value, under a square root
    const auto bent = box_along(surface, {0, 0.75}); // inside: the chord at m = 0.75
    CHECK(bent.upper[0] == Approx(0.5).epsilon(1e-14));
    CHECK(bent.lower[0] == Approx(-0.5).epsilon(1e-14));
    CHECK(bent.upper[1] == Approx(1).epsilon(1e-14));
}

TEST_CASE("rows bounded along the prediction flow as the surface does, to first order",
          "[surface]") {
    const auto check = [](const auto& surface) {
        const Eigen::Vector2d exact = travel_of<Exact>(surface, 100000, masses);
        Eigen::Matrix2d wrong = masses.diagonal().asDiagonal();
        wrong(1, 1) *= 4;
        for (const Eigen::Matrix2d& believed : {masses, wrong}) {
            double last = 0;
            for (const int rate : {240, 960, 3840}) {
                const double error = (travel_of<Boxed>(surface, rate, believed) - exact).norm();
                CAPTURE(rate);
                CHECK(error < 3.0 / rate * exact.norm());
                if (last > 0) CHECK(error < last / 2);
                last = error;
            }
        }
    };
    check(BendingTorsion<double>({.plastic_moment = 1, .plastic_torque = 1}));
    check(RectangleAxialBending<double>());
    check(IAxialBending<double>(i_200<double>, BendingAxis::strong));
}

TEST_CASE("a joint bent in flow extends as associated flow demands", "[surface]") {
    // moment beyond capacity, steady axial force: the rate of extension over that of rotation tends
    // to the neutral axis of the section, n h/2
    const double np = 2, mp = 0.5, h = 4 * mp / np, n = 0.4;
    const Scaled surface(RectangleAxialBending<double>(),
                         ScaledParameters<double, 2>{.capacity = {np, mp}});
    Rows<Boxed, std::decay_t<decltype(surface)>> rows{surface,
                                                      Eigen::Matrix2d{{3.0, 0.0}, {0.0, 0.01}}};
    // settle into the flow, in which the axial row hardly accelerates
    for (int i = 0; i < 400; ++i) rows.step({n * np, (1 - n * n) * mp * 1.0001}, 1e-2);
    for (int i = 0; i < 4000; ++i) rows.step({n * np, (1 - n * n) * mp}, 1e-2);
    CHECK(-rows.force[0] == Approx(n * np).epsilon(1e-6));
    CHECK(rows.velocity[0] / rows.velocity[1] == Approx(n * h / 2).epsilon(1e-3));
}

TEST_CASE("a load inside the surface is held for good, also after shaking", "[surface]") {
    const BiaxialRectangle<double> surface;
    Rows<Boxed, BiaxialRectangle<double>> rows{
        surface, Eigen::Matrix3d{{0.05, 0.01, 0.0}, {0.01, 0.03, -0.01}, {0.0, -0.01, 0.04}}};
    const Eigen::Vector3d load{0.4, 0.3, 0.3}; // gauge 0.72
    REQUIRE(surface.value(load) < 0.8);
    for (int i = 0; i < 10; ++i) rows.step(load * (0.1 * i), 1e-3);
    rows.travel.setZero();
    for (int i = 0; i < 2000; ++i) {
        const Eigen::Vector3d shake{0.05 * std::sin(0.9 * i), 0.05 * std::cos(1.7 * i), 0};
        rows.step(load + shake, 1e-3);
    }
    CHECK(rows.travel.norm() < 1e-12);
}
