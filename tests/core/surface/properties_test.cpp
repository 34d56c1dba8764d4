// SPDX-License-Identifier: MIT
//
// What holds for every yield surface.
#include <catch2/catch.hpp>

#include <Eigen/Core>
#include <cmath>
#include <string>
#include <type_traits>

#include "core/surface/cases.hpp"
#include "core/surface/properties.hpp"
#include "ductile/numeric/ldlt.hpp"
#include "ductile/surface/closest_point.hpp"
#include "support/property.hpp"

using namespace ductile;
using namespace ductile::test;

namespace {

struct NotASurface {
    using Scalar = double;
    static constexpr int dimension = 2;
    using Vector = Eigen::Vector2d;
    using Matrix = Eigen::Matrix2d;
    double value(const Vector&) const { return 0; } // may throw
    Vector normal(const Vector&) const noexcept { return Vector::Zero(); }
    Vector support(const Vector&) const noexcept { return Vector::Zero(); }
    Vector project(const Vector& f, const Matrix&) const noexcept { return f; }
};
static_assert(!YieldSurface<NotASurface>);
static_assert(!YieldSurface<double>);
static_assert(!CurvedSurface<IndependentAxes<double, 2>>); // its dissipation has corners
static_assert(CurvedSurface<BiaxialRectangle<float>>);

} // namespace

TEST_CASE("the normal is the gradient of the value", "[surface]") {
    for_every_surface<double>([](const std::string& name, const auto& surface) {
        using T = std::decay_t<decltype(surface)>;
        using Vector = typename T::Vector;
        test::prop(name, [&] {
            const auto f = any_direction<Vector>();
            constexpr double step = 1e-6;
            // second differences reach 1e2 (edges of the box excluded): error of step² × third, and
            // round-off 1e-16/step
            constexpr double tolerance = 1e-6;
            Vector difference;
            for (int i = 0; i < T::dimension; ++i) {
                const Vector shift = Vector::Unit(i) * step;
                const double ahead = (surface.value(f + shift) - surface.value(f)) / step;
                const double behind = (surface.value(f) - surface.value(f - shift)) / step;
                RC_PRE(std::abs(ahead - behind) < 1e-3); // not at a corner, nor next to one
                difference[i] = (ahead + behind) / 2;
            }
            RC_ASSERT((surface.normal(f) - difference).norm() <= tolerance);
        });
    });
}

TEST_CASE("the slope of the support is its derivative", "[surface]") {
    for_every_surface<double>([](const std::string& name, const auto& surface) {
        using T = std::decay_t<decltype(surface)>;
        if constexpr (CurvedSurface<T>) {
            using Vector = typename T::Vector;
            using Matrix = typename T::Matrix;
            test::prop(name, [&] {
                const auto flow = any_direction<Vector>();
                constexpr double step = 1e-6;
                const Matrix slope = surface.support_slope(flow);
                RC_PRE(slope.norm() < 100); // the neutral axis not at the very edge of the section
                RC_ASSERT((slope - slope.transpose()).norm() <= 1e-12 * (1 + slope.norm()));
                // Euler, homogeneous of degree 0
                RC_ASSERT((slope * flow).norm() <= 1e-12 * (1 + slope.norm()));
                for (int i = 0; i < T::dimension; ++i) {
                    const Vector shift = Vector::Unit(i) * step;
                    const Matrix next = surface.support_slope(flow + shift);
                    const Matrix last = surface.support_slope(flow - shift);
                    RC_PRE((next - last).norm() < 1e-2); // the plates of an I meet in a jump
                    const Vector difference =
                        (surface.support(flow + shift) - surface.support(flow - shift)) /
                        (2 * step);
                    RC_ASSERT((difference - slope.col(i)).norm() <= 1e-5);
                }
            });
        }
    });
}

TEST_CASE("an ellipsoid's own closest point is that of the general return", "[surface]") {
    using Surface = Ellipsoid<double, 6>;
    using Vector = Surface::Vector;
    const Surface surface({.capacity = {1, 2, 0.5, 1.5, 0.7, 1}});
    test::prop("any trial, any stiffness", [&] {
        const auto ray = any_direction<Vector>();
        const double beyond = std::pow(10, any_number(-6.0, 6.0));
        const Vector trial = ray * ((1 + beyond) / surface.value(ray));
        const auto stiffness = any_stiffness<Surface::Matrix>();
        const Vector own = surface.project(trial, stiffness);
        // the general return settles where its residual is round-off of the trial
        const double tolerance = 1e-12 * (1 + beyond);
        RC_ASSERT((own - closest_point(surface, trial, stiffness)).norm() <= tolerance);
    });
    // K = 1, c = 1: the radial return; and one axis much stiffer than the rest: x = t/(1 + μ k),
    // where μ = 1 was chosen and t follows from x on the sphere
    const Ellipsoid<double, 2> circle({.capacity = {1, 1}});
    const Eigen::Vector2d radial = circle.project({3, 4}, Eigen::Matrix2d::Identity());
    CHECK((radial - Eigen::Vector2d(0.6, 0.8)).norm() < 1e-15);
    const Eigen::Vector2d stiffness(1, 1e8), on(0.6, 0.8);
    const Eigen::Vector2d trial = on + stiffness.cwiseProduct(on);
    CHECK((circle.project(trial, stiffness.asDiagonal()) - on).norm() < 1e-14);
}

TEST_CASE("float agrees with double", "[surface]") {
    // 7 digits, less those lost to the square root by which the thin tube ends in its corner
    constexpr double tolerance = 2e-5;
    const auto check = [&](const char* name, const auto& single, const auto& twice) {
        using Vector = typename std::decay_t<decltype(single)>::Vector;
        test::prop(name, [&] {
            const auto f = any_direction<Vector>();
            const auto wide = f.template cast<double>().eval();
            RC_ASSERT(std::abs(double(single.value(f)) - twice.value(wide)) <= tolerance);
            const auto normal = single.normal(f).template cast<double>().eval();
            RC_ASSERT((normal - twice.normal(wide)).norm() <= tolerance * (1 + normal.norm()) * 50);
        });
    };
    check("circle", CircleAxialBending<float>(), CircleAxialBending<double>());
    check("I", IAxialBending<float>(i_200<float>, BendingAxis::strong),
          IAxialBending<double>(i_200<double>, BendingAxis::strong));
    check("biaxial", BiaxialRectangle<float>(), BiaxialRectangle<double>());
}

TEST_CASE("no force and no flow are not divided by", "[surface]") {
    for_every_surface<double>([](const std::string& name, const auto& surface) {
        using Vector = typename std::decay_t<decltype(surface)>::Vector;
        CAPTURE(name);
        CHECK(surface.value(Vector::Zero()) == 0);
        CHECK(surface.normal(Vector::Zero()) == Vector::Zero());
        CHECK(surface.support(Vector::Zero()) == Vector::Zero());
    });
}

TEST_CASE("huge and tiny forces are met as well", "[surface]") {
    for_every_surface<double>([](const std::string& name, const auto& surface) {
        using T = std::decay_t<decltype(surface)>;
        using Vector = typename T::Vector;
        using Matrix = typename T::Matrix;
        CAPTURE(name);
        const Vector ray = Vector::Constant(0.3);
        for (const double size : {1e-100, 1e-12, 1e12, 1e100}) {
            CAPTURE(size);
            CHECK(surface.value(size * ray) == Approx(size * surface.value(ray)).epsilon(1e-13));
            CHECK((surface.normal(size * ray) - surface.normal(ray)).norm() < 1e-12);
        }
        // from far away in the unit metric, the closest point is the support of the direction
        const Vector far = surface.project(1e9 * ray, Matrix::Identity());
        CHECK((far - surface.support(ray)).norm() < 1e-6);
    });
}

TEST_CASE("a change of units or of the order of the moments changes nothing", "[surface]") {
    using Surface = Scaled<BiaxialRectangle<double>>;
    test::prop("N, N m against kN, kN mm; x against y", [] {
        const Eigen::Vector3d capacity{2.5e5, 3.1e4, 1.2e4};
        const Eigen::Vector3d units{1e-3, 1, 1}; // kN, kN mm
        const Surface si(BiaxialRectangle<double>(), {.capacity = capacity});
        const Surface other(BiaxialRectangle<double>(), {.capacity = capacity.cwiseProduct(units)});
        const Eigen::Vector3d swapped_capacity{capacity[0], capacity[2], capacity[1]};
        const Surface swapped(BiaxialRectangle<double>(), {.capacity = swapped_capacity});

        const Eigen::Vector3d f = 3 * capacity.cwiseProduct(any_direction<Eigen::Vector3d>());
        const auto stiffness = any_stiffness<Eigen::Matrix3d>();
        const Eigen::Matrix3d k = capacity.asDiagonal() * stiffness * capacity.asDiagonal();
        const Eigen::Vector3d on = si.project(f, k);

        const Eigen::Vector3d g = units.cwiseProduct(f);
        RC_ASSERT(std::abs(other.value(g) - si.value(f)) <= 1e-13);
        const Eigen::Vector3d on_g = other.project(g, units.asDiagonal() * k * units.asDiagonal());
        RC_ASSERT((on_g - units.cwiseProduct(on)).cwiseQuotient(g.cwiseAbs() + units).norm() <=
                  1e-9);

        Eigen::Matrix3d exchange;
        exchange << 1, 0, 0, 0, 0, 1, 0, 1, 0;
        RC_ASSERT(std::abs(swapped.value(exchange * f) - si.value(f)) <= 1e-13);
        const Eigen::Vector3d on_s = swapped.project(exchange * f, exchange * k * exchange);
        RC_ASSERT((on_s - exchange * on).norm() <= 1e-9 * on.norm());
    });
}
