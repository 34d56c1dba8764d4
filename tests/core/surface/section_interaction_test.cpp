// SPDX-License-Identifier: MIT
//
// Interaction of axial force and bending against closed forms, and against fibres of the section
// whose stress follows from the kinematics of the hinge.
#include <catch2/catch.hpp>

#include <cmath>
#include <functional>
#include <numbers>
#include <utility>
#include <vector>

#include "core/surface/cases.hpp"
#include "support/property.hpp"

using namespace ductile;
using namespace ductile::test;
using std::numbers::pi;

namespace {

/// A table given with 7 digits.
constexpr double seven_digits = 5.1e-8;

template <class Surface>
void check_table(const Surface& surface, const std::vector<std::pair<double, double>>& n_and_m) {
    for (const auto& [n, m] : n_and_m) {
        CAPTURE(n);
        CHECK(std::abs(surface.moment(n) - m) <= seven_digits);
        CHECK(std::abs(surface.value({n, surface.moment(n)}) - 1) <= 1e-14);
        CHECK(std::abs(surface.value({-n, m}) - 1) <= 2 * seven_digits);
    }
}

/// n, m and the lever N_p (half height)/M_p of a section of the width b(η), |η| <= 1, with tension
/// where η > -y. Midpoint rule in φ, η = sin φ, which takes the round ends of circles and tubes.
struct Fibres {
    double n, m, lever;
};
Fibres by_fibres(const std::function<double(double)>& width, double y) {
    constexpr int count = 20000;
    double area = 0, modulus = 0, n = 0, m = 0;
    for (int i = 0; i < count; ++i) {
        const double phi = (-1 + (2 * i + 1.0) / count) * pi / 2;
        const double eta = std::sin(phi);
        const double b = width(eta) * std::cos(phi);
        const double sign = eta + y > 0 ? 1 : -1; // strain rate: turn × (eta + y)
        area += b;
        modulus += b * std::abs(eta);
        n += sign * b;
        m += sign * b * eta;
    }
    return {n / area, m / modulus, area / modulus};
}

template <class Surface>
void check_kinematics(const Surface& surface, const std::function<double(double)>& width) {
    constexpr double fibre_error = 5e-4; // one of 20000 fibres on the wrong side of a line
    for (const double y : {0.05, 0.3, 0.62, 0.85, 0.97}) {
        CAPTURE(y);
        const Fibres fibres = by_fibres(width, y);
        const Eigen::Vector2d force{fibres.n, fibres.m};
        CHECK(std::abs(surface.value(force) - 1) <= fibre_error);
        CHECK(std::abs(surface.profile().lever() - fibres.lever) <= fibre_error * fibres.lever);
        // extension rate/rotation rate, in units of the half height: the neutral axis
        const Eigen::Vector2d flow = surface.normal(force);
        CHECK(std::abs(flow[0] / flow[1] / fibres.lever - y) <= 40 * fibre_error);
        // the flow of that neutral axis meets that force
        const Eigen::Vector2d met = surface.support({fibres.lever * y, 1.0});
        CHECK((met - force).norm() <= 2 * fibre_error);
    }
}

} // namespace

TEST_CASE("the rectangle carries m = 1 - n^2", "[surface]") {
    const RectangleAxialBending<double> surface;
    check_table(surface,
                {{0.1, 0.99}, {0.2, 0.96}, {0.4, 0.84}, {0.5, 0.75}, {0.6, 0.64}, {0.8, 0.36}});
    test::prop("gauge in closed form", [&] { // γ² - |m| γ - n² = 0
        const auto f = any_direction<Eigen::Vector2d>();
        const double m = std::abs(f[1]);
        const double gauge = (m + std::sqrt(m * m + 4 * f[0] * f[0])) / 2;
        RC_ASSERT(std::abs(surface.value(f) - gauge) <= 1e-14);
    });
}

TEST_CASE("circles and tubes carry their closed forms", "[surface]") {
    check_table(CircleAxialBending<double>(),
                {{0.2, 0.9629121}, {0.5, 0.7654859}, {0.8, 0.3836245}});
    check_table(ThinTubeAxialBending<double>(),
                {{0.2, 0.9510565}, {0.5, 0.7071068}, {0.8, 0.309017}});
    check_table(TubeAxialBending<double>({.outer_radius = 0.05, .inner_radius = 0.04}),
                {{0.2, 0.9512623}, {0.5, 0.7085616}, {0.8, 0.3153116}});
    for (const double t : {0.1, 0.7, 1.2, 1.5}) { // n = 1 - (2t - sin 2t)/pi, m = sin^3 t
        const double n = 1 - (2 * t - std::sin(2 * t)) / pi;
        const double m = std::pow(std::sin(t), 3);
        CHECK(std::abs(CircleAxialBending<double>().value({n, m}) - 1) <= 1e-14);
        const double thin = std::cos(pi * n / 2);
        CHECK(std::abs(ThinTubeAxialBending<double>().value({n, thin}) - 1) <= 1e-14);
    }
}

TEST_CASE("an I carries its plates", "[surface]") {
    check_table(
        IAxialBending<double>(i_200<double>, BendingAxis::strong),
        {{0.1, 0.9745974}, {0.2, 0.8983896}, {0.4, 0.6875281}, {0.6, 0.467497}, {0.8, 0.238321}});
    check_table(
        IAxialBending<double>(i_200<double>, BendingAxis::weak),
        {{0.1, 0.9976643}, {0.2, 0.9906571}, {0.4, 0.9283383}, {0.6, 0.7434647}, {0.8, 0.4340186}});
}

TEST_CASE("a tube runs from the circle to the thin tube, an I to the rectangle", "[surface]") {
    test::prop("limits", [] {
        const auto f = any_direction<Eigen::Vector2d>();
        // relative: area of the bore ρ² = 1e-12; thickness 1e-4, of second order in the curve; web
        // as wide as the flange but for 1e-12
        const TubeAxialBending<double> bored({.outer_radius = 1, .inner_radius = 1e-6});
        RC_ASSERT(std::abs(bored.value(f) - CircleAxialBending<double>().value(f)) <= 1e-11);
        const TubeAxialBending<double> thin({.outer_radius = 1, .inner_radius = 0.9999});
        RC_ASSERT(std::abs(thin.value(f) - ThinTubeAxialBending<double>().value(f)) <= 1e-4);
        const IAxialBending<double> solid({.height = 0.1,
                                           .width = 0.05,
                                           .web_thickness = 0.05 * (1 - 1e-12),
                                           .flange_thickness = 0.02},
                                          BendingAxis::strong);
        RC_ASSERT(std::abs(solid.value(f) - RectangleAxialBending<double>().value(f)) <= 1e-11);
    });
}

TEST_CASE("flow is associated: the neutral axis is where extension and rotation put it",
          "[surface]") {
    SECTION("rectangle: extension rate / rotation rate = n h/2") {
        const double h = 0.1, b = 0.05, yield = 250e6;
        const Scaled surface(
            RectangleAxialBending<double>(),
            ScaledParameters<double, 2>{.capacity = {yield * b * h, yield * b * h * h / 4}});
        for (const double n : {-0.9, -0.3, 0.0, 0.2, 0.7}) {
            const Eigen::Vector2d force{n * yield * b * h, (1 - n * n) * yield * b * h * h / 4};
            const Eigen::Vector2d flow = surface.normal(force);
            CHECK(flow[0] / flow[1] == Approx(n * h / 2).margin(1e-15));
        }
    }
    SECTION("fibres") {
        const auto circle = [](double y) { return std::sqrt(1 - y * y); };
        check_kinematics(RectangleAxialBending<double>(), [](double) { return 1.0; });
        check_kinematics(CircleAxialBending<double>(), circle);
        check_kinematics(ThinTubeAxialBending<double>(), [&](double y) { return 1 / circle(y); });
        check_kinematics(
            TubeAxialBending<double>({.outer_radius = 0.05, .inner_radius = 0.04}),
            [&](double y) { return circle(y) - (std::abs(y) < 0.8 ? 0.8 * circle(y / 0.8) : 0); });
        check_kinematics(IAxialBending<double>(i_200<double>, BendingAxis::strong),
                         [](double y) { return std::abs(y) < 0.85 ? 0.009 : 0.2; });
        check_kinematics(IAxialBending<double>(i_200<double>, BendingAxis::weak),
                         [](double y) { return std::abs(y) < 0.045 ? 0.2 : 0.03; });
    }
    SECTION("pure axial force: any neutral axis outside the section, the middle one chosen") {
        const CircleAxialBending<double> surface;
        CHECK(surface.normal({-2, 0}) == Eigen::Vector2d(-1, 0));
        const double a = surface.profile().lever();
        CHECK(surface.support({a, 0.99}) == Eigen::Vector2d(1, 0));
    }
}

TEST_CASE("biaxial bending of a rectangle follows its formula in every regime", "[surface]") {
    const BiaxialRectangle<double> surface;
    SECTION("without axial force, and swapped") {
        const std::vector<std::pair<double, double>> table{{0.2, 0.97},      {0.4, 0.88},
                                                           {0.6, 0.73},      {0.8, 0.5163978},
                                                           {0.9, 0.3651484}, {2.0 / 3, 2.0 / 3}};
        for (const auto& [my, mx] : table) {
            CAPTURE(my);
            CHECK(std::abs(surface.value({0, mx, my}) - 1) <= 2 * seven_digits);
            CHECK(std::abs(surface.value({0, -my, mx}) - 1) <= 2 * seven_digits);
        }
    }
    SECTION("with axial force, neutral axis through two sides") {
        const double n = 0.3, tau = 0.4;
        const Eigen::Vector3d force{n, 1 - tau * tau / 3 - n * n, 2 * tau / 3};
        CHECK(std::abs(force[1] - 0.8566667) <= seven_digits);
        CHECK(std::abs(surface.value(force) - 1) <= 1e-15);
        CHECK((surface.support({n, 0.5, tau / 2}) - force).norm() <= 1e-15);
    }
    SECTION("one moment alone is the rectangle") {
        test::prop("n-m", [&] {
            const auto f = any_direction<Eigen::Vector2d>();
            const double flat = RectangleAxialBending<double>().value(f);
            RC_ASSERT(std::abs(surface.value({f[0], f[1], 0}) - flat) <= 1e-14);
            RC_ASSERT(std::abs(surface.value({f[0], 0, f[1]}) - flat) <= 1e-14);
        });
    }
    SECTION("any neutral line, against rows of the square integrated exactly along x") {
        test::prop("support", [&] {
            const auto flow = any_direction<Eigen::Vector3d>();
            constexpr int count = 4000; // rows; midpoint rule in y, second order
            Eigen::Vector3d force = Eigen::Vector3d::Zero();
            for (int i = 0; i < count; ++i) {
                const double y = -1 + (2 * i + 1.0) / count;
                const double left = flow[0] + 2 * flow[1] * y - 2 * flow[2];  // rate at x = -1
                const double right = flow[0] + 2 * flow[1] * y + 2 * flow[2]; // and at x = 1
                const double sign = (right > 0) - (right < 0);
                const bool crossed = left * right < 0;
                const double x = crossed ? -1 + 2 * left / (left - right) : -1;
                force += sign * Eigen::Vector3d(-x, -2 * x * y, 1 - x * x) / count;
            }
            // second order, but one row on the wrong side of a line along x costs 2/count
            RC_ASSERT((surface.support(flow) - force).norm() <= 2e-3);
        });
    }
    SECTION("neutral line across a corner") {
        test::prop("Santathadaporn & Chen", [&] {
            const double a = any_number(0.01, 2.0), b = any_number(0.01, 2.0);
            const double q = a * b / 4; // 1 - n
            const double mx = 2 * q * (1 - b / 3), my = 2 * q * (1 - a / 3);
            const double formula = 9 * (1 - mx / (2 * q)) * (1 - my / (2 * q)) - 4 * q;
            RC_ASSERT(std::abs(formula) <= 1e-12);
            RC_ASSERT(std::abs(surface.value({1 - q, mx, my}) - 1) <= 1e-13);
            const Eigen::Vector3d flow{1 / a + 1 / b - 1, 0.5 / b, 0.5 / a};
            RC_ASSERT((surface.support(flow) - Eigen::Vector3d(1 - q, mx, my)).norm() <= 1e-13);
        });
    }
}
