// SPDX-License-Identifier: MIT
//
// Axial force with bending of a section that is symmetric about its bending axis, from the
// kinematics of the fully plastic section. The headers *_axial_bending.hpp name the sections.
//
// A hinge that turns by κ and extends by ε has its neutral axis at the distance Y = ε/κ from the
// centroid; every fibre flows in tension on one side and in compression on the other. With the
// width b(η) of the section at the height η (half its height is 1) and y = |Y|/half height,
//
//   n(y) = ∫₀^y b dη / ∫₀¹ b dη,   m(y) = ∫_y^1 b η dη / ∫₀¹ b η dη,   y in [0, 1]
//   dm/dn = -a y,   a = ∫₀¹ b dη / ∫₀¹ b η dη = N_p (half height) / M_p
//
// so the normal of the curve m(n) at y is (a y, 1): flow is associated because Y = ε/κ. At y = 1
// the whole section yields in tension: the surface has a corner at n = 1, m = 0, where any neutral
// axis outside the section will do.
//
// The gauge of (n, m) is γ = max_y (a y |n| + |m|)/(a y n(y) + m(y)), reached where n(y) : m(y) is
// |n| : |m|. It is stationary in y, so an error of y enters squared.
//
// Symbols (normalised)
//   n = N/N_p, m = M/M_p   axial force and moment            [-], entries 0 and 1 of the vector
//   y                      neutral axis / half height        [-]
//
// Source: Neal (1977), The Plastic Methods of Structural Analysis, chapter 6; written out here.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <utility>

#include "ductile/surface/closest_point.hpp"
#include "ductile/surface/surface.hpp"

namespace ductile {

/// The section's n(y), m(y), dn/dy and a, for y in [0, 1]: n rises from 0 to 1,
/// m falls from 1 to 0.
template <class T>
concept AxialBendingProfile = requires(const T profile, typename T::Scalar y) {
    { profile.axial(y) } noexcept -> std::same_as<typename T::Scalar>;
    { profile.bending(y) } noexcept -> std::same_as<typename T::Scalar>;
    { profile.density(y) } noexcept -> std::same_as<typename T::Scalar>;
    { profile.lever() } noexcept -> std::same_as<typename T::Scalar>;
};

/// Normalised surface in (n, m). Immutable value.
template <AxialBendingProfile Profile>
class AxialBending {
  public:
    using Scalar = typename Profile::Scalar;
    static constexpr int dimension = 2;
    using Vector = Eigen::Matrix<Scalar, 2, 1>;
    using Matrix = Eigen::Matrix<Scalar, 2, 2>;

    explicit AxialBending(Profile profile) noexcept : profile_(std::move(profile)) {}

    [[nodiscard]] const Profile& profile() const noexcept { return profile_; }

    /// Distance of the neutral axis from the centroid over half the height, in [0, 1], at which the
    /// section carries n : m = force[0] : force[1]. 0 at zero force.
    [[nodiscard]] Scalar neutral_axis(const Vector& force) const noexcept {
        const Scalar size = force.cwiseAbs().maxCoeff();
        if (!(size > 0)) return 0;
        return neutral_axis(std::abs(force[0]) / size, std::abs(force[1]) / size);
    }

    /// The moment the section carries beside the axial force n in [-1, 1], >= 0.
    [[nodiscard]] Scalar moment(Scalar axial_force) const noexcept {
        const Scalar n = std::min(std::abs(axial_force), Scalar(1));
        return profile_.bending(solve([&](Scalar y) { return n - profile_.axial(y); },
                                      [&](Scalar y) { return -profile_.density(y); }));
    }

    [[nodiscard]] Scalar value(const Vector& force) const noexcept {
        const Vector flow = direction(force, neutral_axis(force));
        const Scalar dissipated = flow.dot(support(flow));
        return dissipated > 0 ? flow.dot(force) / dissipated : Scalar(0);
    }

    [[nodiscard]] Vector normal(const Vector& force) const noexcept {
        const Vector flow = direction(force, neutral_axis(force));
        const Scalar dissipated = flow.dot(support(flow));
        if (!(dissipated > 0)) return Vector::Zero();
        return flow / dissipated;
    }

    [[nodiscard]] Vector support(const Vector& flow) const noexcept {
        if (flow[0] == 0 && flow[1] == 0) return Vector::Zero();
        const Scalar y = neutral_axis_of_flow(flow);
        return {std::copysign(profile_.axial(y), flow[0]),
                std::copysign(profile_.bending(y), flow[1])};
    }

    [[nodiscard]] Matrix support_slope(const Vector& flow) const noexcept {
        const Scalar y = neutral_axis_of_flow(flow);
        if (!(y < 1)) return Matrix::Zero();
        const Scalar a = profile_.lever();
        const Vector tangent(1, -std::copysign(a * y, flow[0] * flow[1]));
        return tangent * tangent.transpose() * (profile_.density(y) / (a * std::abs(flow[1])));
    }

    [[nodiscard]] Vector project(const Vector& force, const Matrix& stiffness) const noexcept {
        return closest_point(*this, force, stiffness);
    }

  private:
    static Scalar sign(Scalar x) noexcept { return Scalar((x > 0) - (x < 0)); }

    Vector direction(const Vector& force, Scalar y) const noexcept {
        return {sign(force[0]) * profile_.lever() * y, sign(force[1])};
    }

    Scalar neutral_axis_of_flow(const Vector& flow) const noexcept {
        const Scalar whole = profile_.lever() * std::abs(flow[1]);
        const Scalar offset = std::abs(flow[0]);
        return offset < whole ? offset / whole : Scalar(1);
    }

    Scalar neutral_axis(Scalar n, Scalar m) const noexcept {
        if (n == 0) return 0;
        if (m == 0) return 1;
        const Scalar a = profile_.lever();
        return solve([&](Scalar y) { return n * profile_.bending(y) - m * profile_.axial(y); },
                     [&](Scalar y) { return -profile_.density(y) * (n * a * y + m); });
    }

    /// Root in [0, 1] of a falling function: Newton, bisecting where that leaves the
    /// bracket or is slow.
    template <class Function, class Derivative>
    static Scalar solve(const Function& function, const Derivative& derivative) noexcept {
        constexpr Scalar epsilon = std::numeric_limits<Scalar>::epsilon();
        constexpr int max_steps = 100;
        Scalar low = 0;
        Scalar high = 1;
        Scalar y = Scalar(0.5);
        Scalar last = 1;
        for (int step = 0; step < max_steps; ++step) {
            const Scalar f = function(y);
            if (f == 0) return y;
            (f > 0 ? low : high) = y;
            Scalar next = y - f / derivative(y);
            if (!(next > low && next < high) || 2 * std::abs(next - y) > last) {
                next = (low + high) / 2;
            }
            last = std::abs(next - y);
            y = next;
            if (last <= epsilon * y || high - low <= epsilon * high) break;
        }
        return y;
    }

    Profile profile_;
};

} // namespace ductile
