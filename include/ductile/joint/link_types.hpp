// SPDX-License-Identifier: MIT
//
// What crosses the seam between a link and its engine: bodies as the engine shows them, frames
// fixed in them, the rows that the link asks for and the wrench that the engine answered.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>

#include "ductile/joint/inverse_mass.hpp"
#include "ductile/joint/joint_axis.hpp"
#include "ductile/vocabulary/row.hpp"
#include "ductile/vocabulary/vector.hpp"

namespace ductile {

/// A body as its engine shows it, world axes. Default: the static world.
template <std::floating_point S>
struct BodyState {
    Vector3<S> position = Vector3<S>::Zero();        ///< of the centre of mass [m]
    Matrix3<S> orientation = Matrix3<S>::Identity(); ///< columns: the body's axes
    Vector3<S> velocity = Vector3<S>::Zero();        ///< of the centre of mass [m/s]
    Vector3<S> spin = Vector3<S>::Zero();            ///< [rad/s]
    S inverse_mass = 0;                              ///< [1/kg]
    Matrix3<S> inverse_inertia = Matrix3<S>::Zero(); ///< about the centre of mass [1/(kg m²)]
};

/// A frame fixed in a body: origin from its centre of mass, axes as columns, both in the body's
/// axes.
template <std::floating_point S>
struct JointFrame {
    Vector3<S> origin = Vector3<S>::Zero();   ///< [m]
    Matrix3<S> axes = Matrix3<S>::Identity(); ///< orthonormal, right-handed
};

/// One row of the link: a force along, or a moment about, a direction.
template <std::floating_point S>
struct LinkRow {
    Vector3<S> direction = Vector3<S>::Zero(); ///< world; of unit length but for rows of ė
    bool turns = false;                        ///< moment row
    RowLimits<S> limits;                       ///< [N | N m], [m/s | rad/s]

    /// The same row along a direction of unit length.
    [[nodiscard]] LinkRow along_unit() const noexcept {
        const S length = norm(direction);
        return {scaled(1 / length, direction),
                turns,
                {.lower = limits.lower * length,
                 .upper = limits.upper * length,
                 .bias = limits.bias / length,
                 .compliance = limits.compliance / (length * length),
                 .softness = limits.softness / (length * length)}};
    }
};

/// Velocities of rows that come of the turning of their bodies, in the order of JointAxis
/// [m/s | rad/s].
template <std::floating_point S>
struct RowTurning {
    Vector6<S> across = Vector6<S>::Zero(); ///< w: less before the solve, more after it
    Vector6<S> along = Vector6<S>::Zero();  ///< o: the same before and after
    S turn = 0;   ///< of a body that turns further than this can tell, else 0 [rad]
    S swept = 0;  ///< then the speed of its arm [m/s]
    S driven = 0; ///< turn of a body that nothing can move [rad]

    /// Where the row is at rest 0 before the step and `drift` after it; their sum is that of u, u'.
    [[nodiscard]] Vector6<S> before(const Vector6<S>& u) const noexcept {
        return u - across - along;
    }
    [[nodiscard]] Vector6<S> after(const Vector6<S>& u) const noexcept {
        return u + across + along;
    }
    [[nodiscard]] Vector6<S> drift() const noexcept { return 2 * along; }
    /// u' of a row that is at rest after the step.
    [[nodiscard]] Vector6<S> target() const noexcept { return along - across; }
};

/// Force and moment on body A at the joint, world axes.
template <std::floating_point S>
struct JointWrench {
    Vector3<S> force = Vector3<S>::Zero();  ///< [N]
    Vector3<S> moment = Vector3<S>::Zero(); ///< about the joint [N m]
};

/// K along the axes of frame B, for rows in the order of JointAxis. `axes_in_world`: columns.
template <std::floating_point S>
[[nodiscard]] Matrix6<S> inverse_mass_of_rows(const BodyState<S>& a, const BodyState<S>& b,
                                              const Vector3<S>& joint,
                                              const Matrix3<S>& axes_in_world) noexcept {
    const auto along_axes = [&](const BodyState<S>& body) noexcept {
        const Matrix3<S> turned = transposed_times(axes_in_world, body.inverse_inertia);
        return BodyAtJoint<S>{body.inverse_mass, times(turned, axes_in_world),
                              transposed_times(axes_in_world, difference(joint, body.position))};
    };
    return inverse_mass_at_joint(along_axes(a), along_axes(b));
}

/// M of the rows of `axes` while the others hold, (K⁻¹)_pp; the identity where the bodies cannot
/// tell (both without mass on some axis).
template <std::floating_point S, std::size_t N>
[[nodiscard]] Eigen::Matrix<S, int(N), int(N)> mass_of_rows(
    const Matrix6<S>& k, const std::array<JointAxis, N>& axes) noexcept {
    const Matrix6<S> mass = inverse_by_blocks(k);
    Eigen::Matrix<S, int(N), int(N)> result;
    for (std::size_t i = 0; i < N; ++i) {
        for (std::size_t j = 0; j < N; ++j) {
            result(Eigen::Index(i), Eigen::Index(j)) =
                mass(Eigen::Index(index(axes[i])), Eigen::Index(index(axes[j])));
        }
    }
    for (std::size_t i = 0; i < N * N; ++i) {
        if (!std::isfinite(result.data()[i])) return Eigen::Matrix<S, int(N), int(N)>::Identity();
    }
    return result;
}

} // namespace ductile
