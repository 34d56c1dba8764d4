// SPDX-License-Identifier: MIT
#include "ductile/surface/any_surface.hpp"

#include <rapidcheck.h>

#include <Eigen/LU>

#include <catch2/catch.hpp>

#include "core/surface/cases.hpp"
#include "support/property.hpp"

using namespace ductile;
using namespace ductile::test;

namespace {

/// Calls visit(name, surface) for what a solver meets by its closest point.
template <class Visit>
void for_every_meetable_surface(const Visit& visit) {
    for_every_surface<double>([&](const char* name, const auto& surface) {
        if constexpr (requires { AnySurfaceOf(surface); }) visit(name, surface);
    });
}

template <class Vector>
Vector6<double> six(const Vector& vector) {
    Vector6<double> result = Vector6<double>::Zero();
    result.head<Vector::RowsAtCompileTime>() = vector;
    return result;
}

} // namespace

TEST_CASE("a surface for solvers is the surface in shares of its strengths", "[surface]") {
    int met = 0;
    for_every_meetable_surface([&](const char* name, const auto& surface) {
        using Surface = std::remove_cvref_t<decltype(surface)>;
        using Vector = typename Surface::Vector;
        constexpr int n = Surface::dimension;
        ++met;
        const AnySurfaceOf any(surface);
        INFO(name);
        for (int i = 0; i < n; ++i) CHECK(any.value(six(Vector(Vector::Unit(i)))) == Approx(1));
        test::prop(name, [&] {
            const Vector share = any_direction<Vector>() * 2,
                         metric = Vector::Ones() * 0.1 + any_vector<Vector>().cwiseAbs();
            const Vector c = any.strength();
            Vector6<double> of_six = Vector6<double>::Ones();
            of_six.head<n>() = metric;
            RC_ASSERT(std::abs(any.value(six(share)) - surface.value(c.cwiseProduct(share))) <
                      1e-12);
            const AnySurface::Closest to = any.closest(six(share), of_six);
            RC_ASSERT(to.inside == !(any.value(six(share)) > 1 + on_surface<double>));
            const typename Surface::Matrix stiffness =
                c.cwiseProduct(c).cwiseQuotient(metric).asDiagonal();
            const Vector closest =
                surface.project(c.cwiseProduct(share), stiffness).cwiseQuotient(c);
            RC_ASSERT((to.point.template head<n>() - closest).norm() < 1e-12);
            if (to.inside) return;
            // what the answer makes of a change of the aim: (d + S⁻¹)⁻¹ d
            const Vector change = any_vector<Vector>() * 1e-6;
            const Vector flow = metric.cwiseProduct(share - closest);
            RC_PRE(flow.norm() > 0.05); // else the slope is steep
            Eigen::Matrix<double, n, n> slope = Eigen::Matrix<double, n, n>::Zero();
            for (const Vector6<double>& column : to.slope) {
                slope += column.template head<n>() * column.template head<n>().transpose();
            }
            const Eigen::Matrix<double, n, n> left =
                Eigen::Matrix<double, n, n>::Identity() +
                slope * Eigen::Matrix<double, n, n>(metric.asDiagonal());
            const Vector expected = left.inverse() * (slope * Vector(metric.cwiseProduct(change)));
            const Vector before =
                any.closest(six(Vector(share - change)), of_six).point.template head<n>();
            const Vector after =
                any.closest(six(Vector(share + change)), of_six).point.template head<n>();
            // a neutral line that leaves the section, a web or a side within the change is a kink
            const double off = ((after - before) / 2 - expected).norm();
            RC_PRE((after - Vector(2 * closest) + before).norm() < 1e-9);
            RC_ASSERT(off <= 1e-3 * change.norm());
        });
    });
    CHECK(met == 10);
}
