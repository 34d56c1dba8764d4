// SPDX-License-Identifier: MIT
//
// The impedance of rows against its definition and its limits.
#include <catch2/catch.hpp>

#include <Eigen/LU>
#include <cmath>

#include "core/surface/cases.hpp"
#include "ductile/surface/impedance.hpp"
#include "support/property.hpp"

using namespace ductile;
using namespace ductile::test;

namespace {

using Vector = Eigen::Matrix<double, 4, 1>;
using Matrix = Eigen::Matrix4d;
using Rows = Impedance<double, 4>;

} // namespace

TEST_CASE("the impedance is that of masses and springs in series", "[surface]") {
    test::prop("(M⁻¹ + C)⁻¹/dt, some rows rigid", [] {
        const auto mass = any_stiffness<Matrix>();
        const Vector compliance = any_vector<Vector>().cwiseAbs(); // now and then 0
        const double dt = any_number(0.001, 0.1);
        const auto velocity = any_vector<Vector>();
        Matrix series = mass.inverse();
        series.diagonal() += compliance;
        const Matrix expected = series.inverse();
        const Rows rows(mass, dt, compliance);
        const double tolerance = 1e-12 * expected.norm(); // condition about 100
        RC_ASSERT((rows.shape() - expected).norm() <= tolerance);
        RC_ASSERT((rows * velocity * dt - expected * velocity).norm() <= tolerance);
    });
}

TEST_CASE("rigid rows have the impedance of their mass, soft ones that of their spring",
          "[surface]") {
    const Vector velocity(1, -2, 3, 0.5);
    Matrix mass = Vector(3, 2, 5, 1).asDiagonal();
    mass(0, 1) = mass(1, 0) = 1;
    const double dt = 0.01;
    CHECK(Rows(mass, dt).shape() == mass);
    CHECK((Rows(mass, dt) * velocity - mass * velocity / dt).norm() < 1e-12);
    CHECK((Rows(mass, dt, Vector::Zero()).shape() - mass).norm() < 1e-15);
    // a = k dt²/m of 1e-12: no digit may be lost to the difference of two masses
    const Vector soft = Vector(1, 2, 3, 4) * 1e-12;
    const Vector product = Rows(mass, dt, soft.cwiseInverse()) * velocity * dt;
    const Vector expected = soft.cwiseProduct(velocity);
    CHECK((product - expected).norm() < 1e-11 * expected.norm());
}
