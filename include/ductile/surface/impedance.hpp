// SPDX-License-Identifier: MIT
//
// The impedance of rows, by how much their forces change with their velocity: what predicts the
// force that would stop them.
//
//   Z = (M⁻¹ + C)⁻¹/dt = M (1 + C M)⁻¹/dt,   C = 1/(k dt²), 0 for a rigid row
//
// The second form needs no inverse of M and loses no digits at either end: rigid rows, C → 0, give
// Z = M/dt without any arithmetic, springs that are soft for the step, C → ∞, give Z → k dt.
//
// Symbols
//   M   effective mass of the rows, symmetric, positive definite    [kg | kg m²]
//   C   compliance of the rows, diagonal, >= 0                      [1/kg | 1/(kg m²)]
//   Z   impedance, symmetric, positive definite                     [N s/m | N m s/rad]
#pragma once

#include <Eigen/Core>
#include <concepts>

#include "ductile/numeric/lu.hpp"
#include "ductile/numeric/small_vector.hpp"

namespace ductile {

/// Refers to M, which must outlive it. Rigid rows cost a product with a vector, elastic ones a
/// factorisation of 1 + C M.
template <std::floating_point S, int N>
class Impedance {
  public:
    using Vector = Eigen::Matrix<S, N, 1>;
    using Matrix = Eigen::Matrix<S, N, N>;

    /// Rigid rows. `dt` > 0 [s].
    Impedance(const Matrix& mass, S dt) noexcept : mass_(mass), dt_(dt) {}

    Impedance(Matrix&&, S) = delete;

    /// Rows of which some are elastic.
    Impedance(const Matrix& mass, S dt, const Vector& compliance) noexcept
        : mass_(mass), dt_(dt), rigid_(false) {
        Matrix soft;
        for (int j = 0; j < N; ++j) {
            for (int i = 0; i < N; ++i) soft(i, j) = compliance[i] * mass(i, j);
            soft(j, j) += 1;
        }
        factors_ = numeric::Lu<S, N>(soft);
    }
    Impedance(Matrix&&, S, const Vector&) = delete;

    /// Z v [N | N m] for a velocity v [m/s | rad/s].
    [[nodiscard]] Vector operator*(const Vector& velocity) const noexcept {
        return numeric::times(mass_, rigid_ ? velocity : factors_.solve(velocity)) / dt_;
    }

    /// Z dt, all that a projection needs [kg | kg m²].
    [[nodiscard]] Matrix shape() const noexcept {
        if (rigid_) return mass_;
        const Matrix inverse = factors_.inverse();
        Matrix result = Matrix::Zero();
        for (int j = 0; j < N; ++j) {
            for (int k = 0; k < N; ++k) {
                for (int i = 0; i < N; ++i) result(i, j) += mass_(i, k) * inverse(k, j);
            }
        }
        return result;
    }

  private:
    const Matrix& mass_;
    S dt_;
    bool rigid_ = true;
    numeric::Lu<S, N> factors_; ///< of 1 + C M, where not rigid
};

} // namespace ductile
