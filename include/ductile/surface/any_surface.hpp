// SPDX-License-Identifier: MIT
//
// A curved yield surface whatever its kind, for a solver that meets it: forces in shares of the
// strengths along the axes, so that numbers are of order one.
//
//   s_i = f_i/c_i,  c_i = 1/γ(axis i),   closest point of a in the metric d:
//   s = support(e),  e = d (a - s),      ds/de = S = B Bᵀ, the slope of the support there
//
// Symbols as in surface.hpp; forces and flows are in shares [-].
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <concepts>

#include "ductile/surface/closest_point.hpp"
#include "ductile/surface/surface.hpp"
#include "ductile/vocabulary/vector.hpp"

namespace ductile {

/// Immutable. The first `dimension` entries of a vector are the surface's axes, the others zero.
class AnySurface {
  public:
    /// Where a force belongs.
    struct Closest {
        bool inside = true; ///< it is admissible itself, and there is no slope
        Vector6<double> point = Vector6<double>::Zero();              ///< s
        std::array<Vector6<double>, 2> slope{Vector6<double>::Zero(), ///< columns of B
                                             Vector6<double>::Zero()};
    };

    [[nodiscard]] virtual double value(const Vector6<double>& force) const noexcept = 0; ///< γ
    /// `metric`: d, entries > 0.
    [[nodiscard]] virtual Closest closest(const Vector6<double>& force,
                                          const Vector6<double>& metric) const noexcept = 0;

  protected:
    AnySurface() = default;
    AnySurface(const AnySurface&) = default;
    AnySurface& operator=(const AnySurface&) = default;
    ~AnySurface() = default;
};

/// A surface that a solver can meet so: the slope of its support has no more than two columns.
template <class T>
concept MeetableSurface = YieldSurface<T> && CurvedSurface<T> && T::dimension <= 3 &&
                          std::same_as<typename T::Scalar, double>;

template <MeetableSurface Surface>
class AnySurfaceOf final : public AnySurface {
  public:
    using Vector = typename Surface::Vector;
    using Matrix = typename Surface::Matrix;

    explicit AnySurfaceOf(const Surface& surface) : surface_(surface) {
        for (int i = 0; i < Surface::dimension; ++i) {
            strength_[i] = 1 / surface.value(Vector(Vector::Unit(i)));
        }
    }

    [[nodiscard]] const Vector& strength() const noexcept { return strength_; } ///< c [N | N m]

    [[nodiscard]] double value(const Vector6<double>& force) const noexcept override {
        return shares().value(force.head<Surface::dimension>());
    }

    [[nodiscard]] Closest closest(const Vector6<double>& force,
                                  const Vector6<double>& metric) const noexcept override {
        constexpr int n = Surface::dimension;
        const InShares surface = shares();
        Matrix stiffness = Matrix::Zero();
        for (int i = 0; i < n; ++i) stiffness(i, i) = 1 / metric[i];
        const auto found =
            find_closest(surface, Vector(force.head<Surface::dimension>()), stiffness);
        Closest result;
        result.inside = found.inside;
        result.point.head<n>() = found.force;
        if (found.inside) return result;
        Matrix left = surface.support_slope(found.flow); // Cholesky, the largest pivot first
        for (Vector6<double>& column : result.slope) {
            int pivot = 0;
            for (int i = 1; i < n; ++i) {
                if (left(i, i) > left(pivot, pivot)) pivot = i;
            }
            if (!(left(pivot, pivot) > 0)) break;
            const Vector root = left.col(pivot) / std::sqrt(left(pivot, pivot));
            column.template head<n>() = root;
            left -= root * root.transpose();
        }
        return result;
    }

  private:
    struct InShares {
        using Scalar = double;
        static constexpr int dimension = Surface::dimension;
        using Vector = typename Surface::Vector;
        using Matrix = typename Surface::Matrix;

        [[nodiscard]] double value(const Vector& s) const noexcept {
            return surface.value(Vector(c.cwiseProduct(s)));
        }
        [[nodiscard]] Vector normal(const Vector& s) const noexcept {
            return c.cwiseProduct(surface.normal(Vector(c.cwiseProduct(s))));
        }
        [[nodiscard]] Vector support(const Vector& e) const noexcept {
            return surface.support(Vector(e.cwiseQuotient(c))).cwiseQuotient(c);
        }
        [[nodiscard]] Matrix support_slope(const Vector& e) const noexcept {
            Matrix slope = surface.support_slope(Vector(e.cwiseQuotient(c)));
            for (int i = 0; i < dimension; ++i) {
                for (int j = 0; j < dimension; ++j) slope(i, j) /= c[i] * c[j];
            }
            return slope;
        }

        const Surface& surface;
        const Vector& c;
    };
    [[nodiscard]] InShares shares() const noexcept { return {surface_, strength_}; }

    Surface surface_;
    Vector strength_;
};

} // namespace ductile
