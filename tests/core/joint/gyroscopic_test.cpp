// SPDX-License-Identifier: MIT
#include "ductile/joint/gyroscopic.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <catch2/catch.hpp>

using namespace ductile;

TEST_CASE("A gyroscopic impulse takes no energy, however far a body turns in a part", "[joint]") {
    const Matrix3<double> inertia = Vector3<double>(0.8, 1.4, 0.7).asDiagonal();
    const Vector3<double> spin(5, 4, 6);
    const auto energy = [&inertia](const Vector3<double>& w) {
        return dot(w, times(inertia, w)) / 2;
    };
    for (const double dt : {1e-4, 1e-2, 1.0 / 30}) {
        CAPTURE(dt);
        const Vector3<double> impulse = gyroscopic_midpoint(inertia, spin, dt);
        const Vector3<double> after = spin + inertia.inverse() * impulse;
        CHECK(energy(after) == Approx(energy(spin)).epsilon(1e-12));
        const Vector3<double> torque = -spin.cross(inertia * spin); // dt -> 0
        CHECK((impulse / dt - torque).norm() < 20 * dt * torque.norm());
    }
}

TEST_CASE("A body that spins about a principal axis, or cannot turn, has no gyroscopic impulse",
          "[joint]") {
    const Matrix3<double> inertia = Vector3<double>(0.8, 1.4, 0.7).asDiagonal();
    const Vector3<double> own(1e-3, 0, 0);
    CHECK(gyroscopic_midpoint(inertia, Vector3<double>(0, 7, 0), 0.03).norm() == 0);
    CHECK(is_zero(gyroscopic_rest(own, Matrix3<double>::Zero(), Vector3<double>(1, 2, 3), 0.03)));
    CHECK(is_zero(
        gyroscopic_rest(Vector3<double>(0, 0, 0), inertia, Vector3<double>(1, 2, 3), 0.03)));
}

TEST_CASE("What turns about a principal axis does not wobble, what is next to one does",
          "[joint]") {
    const Matrix3<double> inertia = Vector3<double>(0.8, 1.4, 0.7).asDiagonal();
    CHECK_FALSE(wobbles(inertia, Vector3<double>(0, 7, 0)));
    CHECK_FALSE(
        wobbles(Matrix3<double>(3 * Matrix3<double>::Identity()), Vector3<double>(1, 2, 3)));
    CHECK(wobbles(inertia, Vector3<double>(1e-6, 7, 0)));
}
