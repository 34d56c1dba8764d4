// SPDX-License-Identifier: MIT
//
// Rectangle under axial force and bending about both axes, exact, from the kinematics of the fully
// plastic section: with the section mapped on the square |X|, |Y| ≤ 1 and the rate of strain
// e + k_x Y + k_y X,
//
//   n = ⟨sgn⟩,   m_x = 2 ⟨Y sgn⟩,   m_y = 2 ⟨X sgn⟩        ⟨·⟩ mean over the square
//
// For n, m_x, m_y ≥ 0 and m_x ≥ m_y (else swap the axes) the neutral line runs
//   1. through the two sides X = ±1, where ν + τ ≤ 1 with ν = e/k_x, τ = k_y/k_x:
//        n = ν,  m_x = 1 - ν² - τ²/3,  m_y = 2τ/3      ⇔  m_x = 1 - n² - (3/4) m_y²
//   2. across a corner, cutting off a triangle of the legs a along X, b along Y, a, b ≤ 2:
//        n = 1 - ab/4,  m_x = (ab/2)(1 - b/3),  m_y = (ab/2)(1 - a/3)
//        ⇔  9 (1 - m_x/(2(1-n))) (1 - m_y/(2(1-n))) = 4 (1 - n)
//   3. outside the section: n = 1, the corner of the surface.
// Gauge: a quadratic in γ in 1, a cubic in γ - n in 2.
//
// Limit cases: m_y = 0: m_x = 1 - n²; n = 0: m_x + (3/4) m_y² = 1 down to m_x = m_y = 2/3.
//
// Symbols (normalised)
//   n = N/N_p, m_x = M_x/M_px, m_y = M_y/M_py   [-], entries 0, 1, 2 of the vector
//
// Source: Santathadaporn & Chen (1970), Interaction curves for sections under combined biaxial
// bending and axial force, WRC Bulletin 148; written out here.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <concepts>
#include <utility>

#include "ductile/surface/closest_point.hpp"
#include "ductile/surface/surface.hpp"

namespace ductile {

/// Normalised surface in (n, m_x, m_y), the same for every rectangle. Immutable value.
template <std::floating_point S>
class BiaxialRectangle {
  public:
    using Scalar = S;
    static constexpr int dimension = 3;
    using Vector = Eigen::Matrix<S, 3, 1>;
    using Matrix = Eigen::Matrix<S, 3, 3>;

    [[nodiscard]] S value(const Vector& force) const noexcept {
        const Vector flow = direction(force);
        const S dissipated = flow.dot(support(flow));
        return dissipated > 0 ? flow.dot(force) / dissipated : S(0);
    }

    [[nodiscard]] Vector normal(const Vector& force) const noexcept {
        const Vector flow = direction(force);
        const S dissipated = flow.dot(support(flow));
        if (!(dissipated > 0)) return Vector::Zero();
        return flow / dissipated;
    }

    [[nodiscard]] Vector support(const Vector& flow) const noexcept {
        const Line line(flow);
        Vector force;
        switch (line.kind) {
            case Kind::none:
                return Vector::Zero();
            case Kind::outside:
                force << 1, 0, 0;
                break;
            case Kind::sides:
                force << line.a, 1 - line.a * line.a - line.b * line.b / 3, 2 * line.b / 3;
                break;
            case Kind::corner: {
                const S half = line.a * line.b / 2;
                force << 1 - half / 2, half * (1 - line.b / 3), half * (1 - line.a / 3);
                break;
            }
        }
        return restored(force, flow, line.swapped);
    }

    /// (density of the neutral line) × mean of v vᵀ along it, v = (1, 2Y, 2X).
    [[nodiscard]] Matrix support_slope(const Vector& flow) const noexcept {
        const Line line(flow);
        const S a = line.a;
        const S b = line.b;
        S density = 0;                          // of area swept per unit e
        S y = 0, x = 0, yy = 0, xx = 0, xy = 0; // means along the line
        if (line.kind == Kind::sides) {
            density = 1 / line.larger;
            y = -a;
            yy = a * a + b * b / 3;
            xx = S(1) / 3;
            xy = -b / 3;
        } else if (line.kind == Kind::corner) {
            density = b / (2 * line.smaller);
            y = b / 2 - 1;
            x = a / 2 - 1;
            yy = 1 - b + b * b / 3;
            xx = 1 - a + a * a / 3;
            xy = 1 - (a + b) / 2 + a * b / 6;
        } else {
            return Matrix::Zero();
        }
        if (line.swapped) {
            std::swap(x, y);
            std::swap(xx, yy);
        }
        const S n = std::copysign(S(1), flow[0]);
        const S up = std::copysign(S(2), flow[1]), aside = std::copysign(S(2), flow[2]);
        Matrix m;
        m(0, 0) = density;
        m(1, 1) = density * 4 * yy;
        m(2, 2) = density * 4 * xx;
        m(0, 1) = m(1, 0) = density * n * up * y;
        m(0, 2) = m(2, 0) = density * n * aside * x;
        m(1, 2) = m(2, 1) = density * up * aside * xy;
        return m;
    }

    [[nodiscard]] Vector project(const Vector& force, const Matrix& stiffness) const noexcept {
        return closest_point(*this, force, stiffness);
    }

  private:
    enum class Kind { none, outside, sides, corner };

    /// Neutral line of a flow: a, b are ν, τ where it runs through two sides, the legs of the
    /// triangle where it cuts a corner.
    struct Line {
        explicit Line(const Vector& flow) noexcept
            : swapped(std::abs(flow[2]) > std::abs(flow[1])),
              larger(2 * std::abs(flow[swapped ? 2 : 1])),
              smaller(2 * std::abs(flow[swapped ? 1 : 2])) {
            const S e = std::abs(flow[0]);
            if (e == 0 && larger == 0) {
                kind = Kind::none;
            } else if (e >= larger + smaller) {
                kind = Kind::outside;
            } else if (e + smaller <= larger) {
                kind = Kind::sides;
                a = e / larger;
                b = smaller / larger;
            } else {
                kind = Kind::corner;
                const S cut = larger + smaller - e;
                a = cut / smaller;
                b = cut / larger;
            }
        }

        Kind kind;
        bool swapped;
        S larger, smaller; ///< of |k_x|, |k_y|
        S a = 0, b = 0;
    };

    static Vector restored(Vector force, const Vector& signs, bool swapped) noexcept {
        if (swapped) std::swap(force[1], force[2]);
        for (int i = 0; i < 3; ++i) force[i] = std::copysign(force[i], signs[i]);
        return force;
    }

    /// A normal, of any length, where the surface meets the ray of the force; zero at zero.
    Vector direction(const Vector& force) const noexcept {
        const Vector size = force.cwiseAbs();
        const S scale = size.maxCoeff();
        if (!(scale > 0)) return Vector::Zero();
        const bool swapped = size[2] > size[1];
        const S n = size[0] / scale;
        const S larger = size[swapped ? 2 : 1] / scale;
        const S smaller = size[swapped ? 1 : 2] / scale;

        Vector flow;
        const S value =
            (larger + std::sqrt(larger * larger + 4 * n * n + 3 * smaller * smaller)) / 2;
        const S tau = S(1.5) * smaller / value;
        if (n / value + tau <= 1) {
            flow << n / value, S(0.5), tau / 2;
        } else if (larger == 0) {
            flow << 1, 0, 0;
        } else {
            const S excess = corner_excess(n, larger, smaller);
            const S a = std::clamp(3 * (1 - smaller / (2 * excess)), S(0), S(2));
            const S b = std::clamp(3 * (1 - larger / (2 * excess)), S(0), S(2));
            flow << std::max(a + b - a * b, S(0)), a / 2, b / 2;
        }
        return restored(flow, force, swapped);
    }

    /// Largest root w = γ - n of 9 (w+n)(2w-p)(2w-q) = 16 w³: Newton from above, monotone.
    static S corner_excess(S n, S p, S q) noexcept {
        constexpr int max_steps = 100;
        S w = p + q;
        for (int step = 0; step < max_steps; ++step) {
            const S left = 9 * (w + n);
            const S u = 2 * w - p;
            const S v = 2 * w - q;
            const S f = left * u * v - 16 * w * w * w;
            const S slope = 9 * u * v + 2 * left * (u + v) - 48 * w * w;
            const S next = w - f / slope;
            if (!(next < w) || !(next > p / 2)) break;
            w = next;
        }
        return w;
    }
};

static_assert(YieldSurface<BiaxialRectangle<double>> && YieldSurface<BiaxialRectangle<float>>);

} // namespace ductile
