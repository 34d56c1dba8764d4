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
// Source: Bullo and Murray (1995), Proportional derivative control on the Euclidean group; Solà et
// al. (2018), A micro Lie theory, eq. (133)-(135), arXiv:1812.01537. The logarithm is taken through
// the unit quaternion, which is accurate for small and for large angles; the angles of a joint that
// holds are so small that the series of asin and of sin and cos are exact to round-off after a few
// terms, without a square root.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <concepts>

namespace ductile {

namespace detail {

/// Largest square of a sine, or of half an angle, for which the series below are exact to
/// round-off: their first neglected term is below 4e-18 of the result.
template <std::floating_point S>
inline constexpr S small_square = S(1e-4);

} // namespace detail

/// Rotation vector of a rotation matrix, of length in [0, π] [rad].
template <std::floating_point S>
[[nodiscard]] Eigen::Matrix<S, 3, 1> rotation_vector(
    const Eigen::Matrix<S, 3, 3>& rotation) noexcept {
    // sin θ times the axis; θ/sin θ = asin(s)/s = 1 + s²/6 + 3 s⁴/40 + 15 s⁶/336 + ...
    const Eigen::Matrix<S, 3, 1> turned(rotation(2, 1) - rotation(1, 2),
                                        rotation(0, 2) - rotation(2, 0),
                                        rotation(1, 0) - rotation(0, 1));
    const S square = turned.squaredNorm() / 4;
    if (square <= detail::small_square<S> && rotation.trace() > 1) {
        return turned *
               (S(0.5) + square * (S(1) / 12 + square * (S(3) / 80 + square * S(5) / 224)));
    }
    const Eigen::Quaternion<S> q(rotation);
    const Eigen::Matrix<S, 3, 1> v = std::copysign(S(1), q.w()) * q.vec();
    const S sine = v.norm();
    const S cosine = std::abs(q.w());
    if (!(sine > 0)) return 2 * v;
    return v * (2 * std::atan2(sine, cosine) / sine);
}

/// `rotation` turned on by the rotation vector `turn` in the frame in which it is given:
/// exp([turn]ₓ) rotation, kept orthonormal.
template <std::floating_point S>
[[nodiscard]] Eigen::Matrix<S, 3, 3> turned_by(const Eigen::Matrix<S, 3, 1>& turn,
                                               const Eigen::Matrix<S, 3, 3>& rotation) noexcept {
    const S half_square = turn.squaredNorm() / 4;
    Eigen::Quaternion<S> by;
    if (half_square <= detail::small_square<S>) {
        by.w() = 1 - half_square * (S(0.5) - half_square * (S(1) / 24 - half_square / 720));
        by.vec() =
            turn *
            (S(0.5) - half_square * (S(1) / 12 - half_square * (S(1) / 240 - half_square / 10080)));
    } else {
        const S angle = turn.norm();
        by = Eigen::AngleAxis<S>(angle, turn / angle);
    }
    return (by * Eigen::Quaternion<S>(rotation)).normalized().toRotationMatrix();
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
