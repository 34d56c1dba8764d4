// SPDX-License-Identifier: MIT
//
// Axes that do not know of each other: |f_i| ≤ c_i. The surface a solver of independent rows
// enforces by itself; the upper bound of every surface with the same capacities.
//
//   γ(f) = max_i |f_i|/c_i
//
// Limit case N = 1: the single row.
//
// Source: Nikula (2017), section 2.8 (uncoupled axes).
#pragma once

#include <Eigen/Core>
#include <concepts>
#include <limits>
#include <string>

#include "ductile/surface/box_projection.hpp"
#include "ductile/surface/surface.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile {

template <std::floating_point S, int N>
struct IndependentAxesParameters {
    /// c_i [N | N m], each > 0
    Eigen::Matrix<S, N, 1> capacity =
        Eigen::Matrix<S, N, 1>::Constant(std::numeric_limits<S>::quiet_NaN());
};

/// Immutable value.
template <std::floating_point S, int N>
class IndependentAxes {
  public:
    using Scalar = S;
    static constexpr int dimension = N;
    using Vector = Eigen::Matrix<S, N, 1>;
    using Matrix = Eigen::Matrix<S, N, N>;

    /// @throws std::invalid_argument where a capacity is missing (NaN), infinite or not positive.
    explicit IndependentAxes(const IndependentAxesParameters<S, N>& parameters)
        : capacity_(parameters.capacity) {
        for (int i = 0; i < N; ++i) {
            check::positive("IndependentAxes.capacity[" + std::to_string(i) + "]", capacity_[i],
                            "N or N m");
        }
    }

    [[nodiscard]] const Vector& capacity() const noexcept { return capacity_; } ///< c [N | N m]

    [[nodiscard]] S value(const Vector& force) const noexcept {
        return force.cwiseQuotient(capacity_).cwiseAbs().maxCoeff();
    }

    /// In an edge or corner the mean of the faces that meet there.
    [[nodiscard]] Vector normal(const Vector& force) const noexcept {
        const Vector use = force.cwiseQuotient(capacity_);
        const S most = use.cwiseAbs().maxCoeff();
        Vector normal = Vector::Zero();
        if (!(most > 0)) return normal;
        int faces = 0;
        for (int i = 0; i < N; ++i) {
            if (std::abs(use[i]) < most * (1 - on_surface<S>)) continue;
            normal[i] = std::copysign(1 / capacity_[i], use[i]);
            ++faces;
        }
        return normal / S(faces);
    }

    /// Where the flow has no part along an axis, any force of that axis would do: zero.
    [[nodiscard]] Vector support(const Vector& flow) const noexcept {
        return capacity_.cwiseProduct(flow.cwiseSign());
    }

    [[nodiscard]] Vector project(const Vector& force, const Matrix& stiffness) const noexcept {
        return project_on_box<S, N>(force, -capacity_, capacity_, stiffness);
    }

    [[nodiscard]] Chords<Vector> chords(const Vector& /*point*/) const noexcept {
        return {-capacity_, capacity_};
    }

  private:
    Vector capacity_;
};

static_assert(ChordedSurface<IndependentAxes<double, 6>> &&
              ChordedSurface<IndependentAxes<float, 2>>);

} // namespace ductile
