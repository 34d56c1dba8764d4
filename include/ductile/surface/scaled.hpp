// SPDX-License-Identifier: MIT
//
// A normalised surface in forces: f_i = c_i x_i with the capacities c (N_p, M_p, T_p ...) of the
// axes.
//
//   γ(f) = γ₁(D⁻¹ f),  ∇γ = D⁻¹ ∇γ₁,  support(e) = D support₁(D e),  K₁ = D⁻¹ K D⁻¹,  D = diag(c)
//
// A change of units is a change of c and nothing else.
#pragma once

#include <Eigen/Core>
#include <concepts>
#include <limits>
#include <string>
#include <utility>

#include "ductile/surface/closest_point.hpp"
#include "ductile/surface/surface.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile {

template <std::floating_point S, int N>
struct ScaledParameters {
    /// c_i, the force at which axis i flows alone, in the order of the surface [N | N m], each > 0
    Eigen::Matrix<S, N, 1> capacity =
        Eigen::Matrix<S, N, 1>::Constant(std::numeric_limits<S>::quiet_NaN());
};

/// Immutable value.
template <YieldSurface Surface>
class Scaled {
  public:
    using Scalar = typename Surface::Scalar;
    static constexpr int dimension = Surface::dimension;
    using Vector = typename Surface::Vector;
    using Matrix = typename Surface::Matrix;

    /// @throws std::invalid_argument where a capacity is missing (NaN), infinite or not positive.
    Scaled(Surface surface, const ScaledParameters<Scalar, dimension>& parameters)
        : surface_(std::move(surface)), capacity_(parameters.capacity) {
        for (int i = 0; i < dimension; ++i) {
            check::positive("Scaled.capacity[" + std::to_string(i) + "]", capacity_[i], "N or N m");
        }
    }

    [[nodiscard]] const Surface& normalised() const noexcept { return surface_; }
    [[nodiscard]] const Vector& capacity() const noexcept { return capacity_; } ///< c [N | N m]

    [[nodiscard]] Scalar value(const Vector& force) const noexcept {
        return surface_.value(force.cwiseQuotient(capacity_));
    }
    [[nodiscard]] Vector normal(const Vector& force) const noexcept {
        return surface_.normal(force.cwiseQuotient(capacity_)).cwiseQuotient(capacity_);
    }
    [[nodiscard]] Vector support(const Vector& flow) const noexcept {
        return capacity_.cwiseProduct(surface_.support(capacity_.cwiseProduct(flow)));
    }
    [[nodiscard]] Matrix support_slope(const Vector& flow) const noexcept requires
        CurvedSurface<Surface> {
        Matrix slope = surface_.support_slope(capacity_.cwiseProduct(flow));
        for (int j = 0; j < dimension; ++j) {
            for (int i = 0; i < dimension; ++i) slope(i, j) *= capacity_[i] * capacity_[j];
        }
        return slope;
    }
    [[nodiscard]] Vector project(const Vector& force, const Matrix& stiffness) const noexcept {
        if (!(value(force) > 1 + on_surface<Scalar>)) return force; // to the bit
        Matrix shares;                                              // K₁
        for (int j = 0; j < dimension; ++j) {
            for (int i = 0; i < dimension; ++i) {
                shares(i, j) = stiffness(i, j) / (capacity_[i] * capacity_[j]);
            }
        }
        return capacity_.cwiseProduct(surface_.project(force.cwiseQuotient(capacity_), shares));
    }
    [[nodiscard]] Chords<Vector> chords(const Vector& point) const noexcept requires
        ChordedSurface<Surface> {
        const auto [lower, upper] = surface_.chords(point.cwiseQuotient(capacity_));
        return {capacity_.cwiseProduct(lower), capacity_.cwiseProduct(upper)};
    }

  private:
    Surface surface_;
    Vector capacity_;
};

} // namespace ductile
