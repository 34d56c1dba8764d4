// SPDX-License-Identifier: MIT
//
// The ellipsoid Σ (f_i/c_i)² = 1: the smooth surface through the capacities of the axes.
//
//   γ(f) = |D⁻¹ f|,  ∇γ = D⁻² f/γ,  support(e) = D² e/|D e|,  D = diag(c)
//
// Chord along axis i through a point x = D⁻¹ f: it ends at ±c_i (1 - |x|² + x_i²)^½.
//
// Closest point. On the unit sphere the flow is μ x, so that x = t - μ K x, |x| = 1, with the trial
// t = D⁻¹ f and the stiffness D⁻¹ K D⁻¹: one unknown,
//
//   x(μ) = (1 + μ K)⁻¹ t,   1/|x(μ)| = 1
//
// In the axes of K, 1/|x| is the power mean of degree -2 of the functions (1 + μ k_i)/|t_i|, hence
// concave and rising: Newton from μ = 0, x = t, never passes the root and needs no safeguard. Where
// K is a multiple of 1 it is straight, and the first step exact.
//
// Limit cases: N = 1 is the single row; a stiffness proportional to D² makes the closest-point
// return radial, and the return of one increment after another then follows the exact path to first
// order.
//
// Source: the equation of one unknown as in Moré & Sorensen (1983), doi:10.1137/0904038; exact path: Krieg & Krieg (1977), doi:10.1115/1.3454568.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <concepts>
#include <limits>
#include <string>

#include "ductile/numeric/cholesky.hpp"
#include "ductile/numeric/small_vector.hpp"
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
    /// c once more, by the name that says the shape: a surface with semi-axes is an ellipsoid.
    [[nodiscard]] const Vector& semi_axes() const noexcept { return capacity_; }

    [[nodiscard]] S value(const Vector& force) const noexcept {
        return numeric::length(shares(force));
    }

    [[nodiscard]] Vector normal(const Vector& force) const noexcept {
        Vector result = shares(force);
        const S value = numeric::length(result);
        if (!(value > 0)) return Vector::Zero();
        for (int i = 0; i < N; ++i) result[i] = result[i] / value / capacity_[i];
        return result;
    }

    [[nodiscard]] Vector support(const Vector& flow) const noexcept {
        const Vector work = capacity_.cwiseProduct(flow);
        const S dissipated = numeric::length(work);
        if (!(dissipated > 0)) return Vector::Zero();
        return capacity_.cwiseProduct(work / dissipated);
    }

    /// D (1 - w wᵀ) D / |D e| with the unit vector w = D e/|D e|.
    [[nodiscard]] Matrix support_slope(const Vector& flow) const noexcept {
        const Vector work = capacity_.cwiseProduct(flow);
        const S dissipated = numeric::length(work);
        if (!(dissipated > 0)) return Matrix::Zero();
        const Vector w = work / dissipated;
        const Matrix tangent = (Matrix::Identity() - w * w.transpose()) / dissipated;
        return capacity_.asDiagonal() * tangent * capacity_.asDiagonal();
    }

    [[nodiscard]] Vector project(const Vector& force, const Matrix& stiffness) const noexcept {
        if (!(value(force) > 1 + on_surface<S>)) return force; // to the bit
        Matrix k;
        S trace = 0;
        for (int j = 0; j < N; ++j) {
            for (int i = 0; i < N; ++i) k(i, j) = stiffness(i, j) / (capacity_[i] * capacity_[j]);
            trace += k(j, j);
        }
        const S scale = S(N) / trace;
        for (int j = 0; j < N; ++j) {
            for (int i = 0; i < N; ++i) k(i, j) *= scale;
        }
        Vector on = closest_on_sphere(shares(force), k);
        for (int i = 0; i < N; ++i) on[i] *= capacity_[i];
        return on;
    }

    [[nodiscard]] Chords<Vector> chords(const Vector& point) const noexcept {
        const Vector x = shares(point);
        const S square = numeric::dot(x, x);
        Vector left;
        for (int i = 0; i < N; ++i) left[i] = std::max(1 - (square - x[i] * x[i]), S(0));
        const Vector root = left.cwiseSqrt();
        Chords<Vector> chords;
        for (int i = 0; i < N; ++i) {
            chords.upper[i] = capacity_[i] * root[i];
            chords.lower[i] = -chords.upper[i];
        }
        return chords;
    }

  private:
    /// D⁻¹ f.
    [[nodiscard]] Vector shares(const Vector& force) const noexcept {
        return force.cwiseQuotient(capacity_);
    }

    /// `trial` outside the unit sphere. Cost: a Cholesky factorisation for each of 1 to 5 steps.
    static Vector closest_on_sphere(const Vector& trial, const Matrix& stiffness) noexcept;

    Vector capacity_;
};

template <std::floating_point S, int N>
auto Ellipsoid<S, N>::closest_on_sphere(const Vector& trial, const Matrix& stiffness) noexcept
    -> Vector {
    constexpr int max_steps = 60;
    Vector x = trial;
    Vector slope = numeric::times(stiffness, x); // -dx/dμ
    S mu = 0;
    for (int step = 0; step < max_steps; ++step) {
        const S size = numeric::length(x);
        S shrinks = 0; // divided one by one: the squares of x may be out of range
        for (int i = 0; i < N; ++i) shrinks += (x[i] / size) * (slope[i] / size);
        const S ahead = (size - 1) / shrinks;
        // what a straight step leaves out is below |slope| ahead²/μ
        const S left_out = numeric::length(slope) * ahead * ahead;
        if (!(left_out > std::numeric_limits<S>::epsilon() * mu)) {
            for (int i = 0; i < N; ++i) x[i] -= slope[i] * ahead;
            break;
        }
        mu += ahead;
        Matrix system;
        for (int j = 0; j < N; ++j) {
            for (int i = 0; i < N; ++i) system(i, j) = mu * stiffness(i, j);
            system(j, j) += 1;
        }
        const numeric::Cholesky<S, N> factors(system);
        x = factors.solve(trial);
        slope = factors.solve(numeric::times(stiffness, x));
    }
    const S size = numeric::length(x);
    for (int i = 0; i < N; ++i) x[i] /= size;
    return x;
}

static_assert(ChordedSurface<Ellipsoid<double, 2>> && ChordedSurface<Ellipsoid<float, 6>>);

} // namespace ductile
