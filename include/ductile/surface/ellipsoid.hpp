// SPDX-License-Identifier: MIT
//
// The ellipsoid Σ (f_i/c_i)² = 1: the smooth surface through the capacities of the axes.
//
//   γ(f) = |D⁻¹ f|,  ∇γ = D⁻² f/γ,  support(e) = D² e/|D e|,  D = diag(c)
//
// Limit cases: N = 1 is the single row; a stiffness proportional to D² makes the closest-point
// return radial, and the return of one increment after another then follows the exact path to first
// order.
//
// Source: exact path on it: Krieg & Krieg (1977), doi:10.1115/1.3454568.
#pragma once

#include <Eigen/Core>
#include <concepts>
#include <limits>
#include <string>

#include "ductile/surface/closest_point.hpp"
#include "ductile/surface/surface.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile {

template <std::floating_point S, int N>
struct EllipsoidParameters {
    /// c_i, the semi-axes [N | N m], each > 0
    Eigen::Matrix<S, N, 1> capacity =
        Eigen::Matrix<S, N, 1>::Constant(std::numeric_limits<S>::quiet_NaN());
};

/// Immutable value.
template <std::floating_point S, int N>
class Ellipsoid {
  public:
    using Scalar = S;
    static constexpr int dimension = N;
    using Vector = Eigen::Matrix<S, N, 1>;
    using Matrix = Eigen::Matrix<S, N, N>;

    /// @throws std::invalid_argument where a capacity is missing (NaN), infinite or not positive.
    explicit Ellipsoid(const EllipsoidParameters<S, N>& parameters)
        : capacity_(parameters.capacity) {
        for (int i = 0; i < N; ++i) {
            check::positive("Ellipsoid.capacity[" + std::to_string(i) + "]", capacity_[i],
                            "N or N m");
        }
    }

    [[nodiscard]] const Vector& capacity() const noexcept { return capacity_; } ///< c [N | N m]

    [[nodiscard]] S value(const Vector& force) const noexcept {
        return force.cwiseQuotient(capacity_).stableNorm();
    }

    [[nodiscard]] Vector normal(const Vector& force) const noexcept {
        const Vector use = force.cwiseQuotient(capacity_);
        const S value = use.stableNorm();
        if (!(value > 0)) return Vector::Zero();
        return (use / value).cwiseQuotient(capacity_);
    }

    [[nodiscard]] Vector support(const Vector& flow) const noexcept {
        const Vector work = capacity_.cwiseProduct(flow);
        const S dissipated = work.stableNorm();
        if (!(dissipated > 0)) return Vector::Zero();
        return capacity_.cwiseProduct(work / dissipated);
    }

    /// D (1 - w wᵀ) D / |D e| with the unit vector w = D e/|D e|.
    [[nodiscard]] Matrix support_slope(const Vector& flow) const noexcept {
        const Vector work = capacity_.cwiseProduct(flow);
        const S dissipated = work.stableNorm();
        if (!(dissipated > 0)) return Matrix::Zero();
        const Vector w = work / dissipated;
        const Matrix tangent = (Matrix::Identity() - w * w.transpose()) / dissipated;
        return capacity_.asDiagonal() * tangent * capacity_.asDiagonal();
    }

    [[nodiscard]] Vector project(const Vector& force, const Matrix& stiffness) const noexcept {
        if (!(value(force) > 1 + on_surface<S>)) return force; // to the bit
        const Vector d = capacity_.cwiseInverse();
        // on the unit sphere force and flow are of order one whatever the units
        const Ellipsoid unit(Vector::Ones(), Checked::yes);
        const Matrix k = d.asDiagonal() * stiffness * d.asDiagonal();
        return capacity_.cwiseProduct(closest_point(unit, d.cwiseProduct(force), k));
    }

  private:
    enum class Checked { yes };
    Ellipsoid(const Vector& capacity, Checked) noexcept : capacity_(capacity) {}

    Vector capacity_;
};

static_assert(YieldSurface<Ellipsoid<double, 2>> && YieldSurface<Ellipsoid<float, 6>>);

} // namespace ductile
