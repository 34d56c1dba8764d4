// SPDX-License-Identifier: MIT
//
// Finite rotation by increments: a joint's angles are the sum of the rotation vectors from step to
// step, in the joint's frame. No Euler angles, no wrap; a joint may turn many times as long as it
// turns less than π in one step.
//
//   R(t + dt) = R(t) exp([δ]ₓ),   δ = log(R(t)ᵀ R(t + dt)),   q += δ
//
// For rotation about one axis q is the angle itself. Otherwise q is the integral of the relative
// angular velocity in the frame of body A, which is what the work of a moment needs; it is not a
// function of the orientation alone.
//
// Source: Bullo and Murray (1995), Proportional derivative control on the Euclidean group; Solà et al.
// (2018), A micro Lie theory, eq. (133)-(135), arXiv:1812.01537. The logarithm is taken through the
// unit quaternion, which is accurate for small and for large angles.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <concepts>

namespace ductile {

/// Rotation vector of a rotation matrix, of length in [0, π] [rad].
template <std::floating_point S>
[[nodiscard]] Eigen::Matrix<S, 3, 1> rotation_vector(const Eigen::Matrix<S, 3, 3>& rotation) noexcept {
    const Eigen::Quaternion<S> q(rotation);
    const Eigen::Matrix<S, 3, 1> v = std::copysign(S(1), q.w()) * q.vec();
    const S sine = v.norm();
    const S cosine = std::abs(q.w());
    if (!(sine > 0)) return 2 * v;
    return v * (2 * std::atan2(sine, cosine) / sine);
}

/// Follows the relative orientation of two frames. Plain value.
template <std::floating_point S>
struct RotationTracker {
    Eigen::Matrix<S, 3, 3> last = Eigen::Matrix<S, 3, 3>::Identity(); ///< orientation seen last
    Eigen::Matrix<S, 3, 1> total = Eigen::Matrix<S, 3, 1>::Zero();    ///< q [rad]

    /// Adds the increment that leads to `now` and returns the total [rad].
    const Eigen::Matrix<S, 3, 1>& follow(const Eigen::Matrix<S, 3, 3>& now) noexcept {
        total += rotation_vector<S>(last.transpose() * now);
        last = now;
        return total;
    }

    bool operator==(const RotationTracker&) const = default;
};

} // namespace ductile
