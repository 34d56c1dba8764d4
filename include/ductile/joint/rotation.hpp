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
// al. (2018), A micro Lie theory, eq. (133)-(135), (146), arXiv:1812.01537. The logarithm is taken
// through the unit quaternion, which is accurate for small and for large angles; the angles of a
// joint that holds are so small that the series of asin and of sin and cos are exact to round-off
// after a few terms, without a square root.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <concepts>

#include "ductile/vocabulary/vector.hpp"

namespace ductile {

namespace detail {

/// Square of half an angle, below which series are exact to round-off [rad²].
template <std::floating_point S>
inline constexpr S small_square = S(1e-4);

/// Unit quaternion: cosine of half the angle, and its sine times the axis.
template <std::floating_point S>
struct UnitQuaternion {
    S cosine;
    Vector3<S> sine;
};

/// By the largest of the four components, so that none is lost (Shepperd 1978).
template <std::floating_point S>
[[nodiscard]] UnitQuaternion<S> to_quaternion(const Matrix3<S>& r) noexcept {
    const S trace = r(0, 0) + r(1, 1) + r(2, 2);
    if (trace > 0) {
        const S root = std::sqrt(trace + 1), share = S(0.5) / root;
        return {root / 2,
                {(r(2, 1) - r(1, 2)) * share, (r(0, 2) - r(2, 0)) * share,
                 (r(1, 0) - r(0, 1)) * share}};
    }
    int i = r(1, 1) > r(0, 0) ? 1 : 0;
    if (r(2, 2) > r(i, i)) i = 2;
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const S root = std::sqrt(r(i, i) - r(j, j) - r(k, k) + 1), share = S(0.5) / root;
    UnitQuaternion<S> q{(r(k, j) - r(j, k)) * share, Vector3<S>::Zero()};
    q.sine[i] = root / 2;
    q.sine[j] = (r(j, i) + r(i, j)) * share;
    q.sine[k] = (r(k, i) + r(i, k)) * share;
    return q;
}

/// The turn a after the turn b.
template <std::floating_point S>
[[nodiscard]] UnitQuaternion<S> product(const UnitQuaternion<S>& a,
                                        const UnitQuaternion<S>& b) noexcept {
    const Vector3<S> mixed = sum(scaled(a.cosine, b.sine), scaled(b.cosine, a.sine));
    return {a.cosine * b.cosine - dot(a.sine, b.sine), sum(mixed, cross(a.sine, b.sine))};
}

/// Of a quaternion of any length but zero.
template <std::floating_point S>
[[nodiscard]] Matrix3<S> to_matrix(const UnitQuaternion<S>& q) noexcept {
    const S two = 2 / (q.cosine * q.cosine + dot(q.sine, q.sine));
    const S w = q.cosine, x = q.sine[0], y = q.sine[1], z = q.sine[2];
    Matrix3<S> r;
    r(0, 0) = 1 - two * (y * y + z * z);
    r(0, 1) = two * (x * y - w * z);
    r(0, 2) = two * (x * z + w * y);
    r(1, 0) = two * (x * y + w * z);
    r(1, 1) = 1 - two * (x * x + z * z);
    r(1, 2) = two * (y * z - w * x);
    r(2, 0) = two * (x * z - w * y);
    r(2, 1) = two * (y * z + w * x);
    r(2, 2) = 1 - two * (x * x + y * y);
    return r;
}

} // namespace detail

/// Rotation vector of a rotation matrix, of length in [0, π] [rad].
template <std::floating_point S>
[[nodiscard]] Vector3<S> rotation_vector(const Matrix3<S>& rotation) noexcept {
    // sin θ times the axis; θ/sin θ = asin(s)/s = 1 + s²/6 + 3 s⁴/40 + 15 s⁶/336 + ...
    const Vector3<S> turned(rotation(2, 1) - rotation(1, 2), rotation(0, 2) - rotation(2, 0),
                            rotation(1, 0) - rotation(0, 1));
    const S square = dot(turned, turned) / 4;
    if (square <= detail::small_square<S> && rotation(0, 0) + rotation(1, 1) + rotation(2, 2) > 1) {
        return scaled(S(0.5) + square * (S(1) / 12 + square * (S(3) / 80 + square * S(5) / 224)),
                      turned);
    }
    const detail::UnitQuaternion<S> q = detail::to_quaternion(rotation);
    const Vector3<S> v = scaled(std::copysign(S(1), q.cosine), q.sine);
    const S sine = norm(v);
    const S cosine = std::abs(q.cosine);
    if (!(sine > 0)) return scaled(2, v);
    return scaled(2 * std::atan2(sine, cosine) / sine, v);
}

/// G of ė = G ω: how the rotation vector e of exp([e]ₓ) changes as that is turned on at the angular
/// velocity ω, G = J_l⁻¹(e) = 1 - [e]ₓ/2 + c [e]ₓ², c = (1 - (θ/2) cot(θ/2))/θ². A moment s
/// conjugate to e is then the moment Gᵀ s = s + e × s/2 + c e × (e × s). θ = |e| < 2 π.
template <std::floating_point S>
[[nodiscard]] Matrix3<S> rotation_vector_rate(const Vector3<S>& e) noexcept {
    const S square = dot(e, e);
    S c = S(1) / 12 + square * (S(1) / 720 + square * (S(1) / 30240 + square / 1209600));
    if (square > S(0.01)) {
        const S half = std::sqrt(square) / 2;
        c = (1 - half * std::cos(half) / std::sin(half)) / square;
    }
    Matrix3<S> rate;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) rate(i, j) = c * e[i] * e[j];
        rate(i, i) += 1 - c * square;
    }
    const Vector3<S> half = scaled(S(0.5), e);
    rate(0, 1) += half[2];
    rate(0, 2) -= half[1];
    rate(1, 0) -= half[2];
    rate(1, 2) += half[0];
    rate(2, 0) += half[1];
    rate(2, 1) -= half[0];
    return rate;
}

/// `rotation` turned on by the rotation vector `turn` in the frame in which it is given:
/// exp([turn]ₓ) rotation, kept orthonormal.
template <std::floating_point S>
[[nodiscard]] Matrix3<S> turned_by(const Vector3<S>& turn, const Matrix3<S>& rotation) noexcept {
    const S half_square = dot(turn, turn) / 4;
    detail::UnitQuaternion<S> by;
    if (half_square <= detail::small_square<S>) {
        by.cosine = 1 - half_square * (S(0.5) - half_square * (S(1) / 24 - half_square / 720));
        by.sine = scaled(
            S(0.5) - half_square * (S(1) / 12 - half_square * (S(1) / 240 - half_square / 10080)),
            turn);
    } else {
        const S angle = norm(turn);
        by.cosine = std::cos(angle / 2);
        by.sine = scaled(std::sin(angle / 2) / angle, turn);
    }
    return detail::to_matrix(detail::product(by, detail::to_quaternion(rotation)));
}

/// Follows the relative orientation of two frames. Plain value.
template <std::floating_point S>
struct RotationTracker {
    Matrix3<S> last = Matrix3<S>::Identity(); ///< orientation seen last
    Vector3<S> total = Vector3<S>::Zero();    ///< q [rad]

    /// Adds the increment that leads to `now` and returns the total [rad]. What is not finite is
    /// not followed, and the answer is NaN.
    Vector3<S> follow(const Matrix3<S>& now) noexcept {
        if (!is_finite(now)) return Vector3<S>::Constant(std::numeric_limits<S>::quiet_NaN());
        total = sum(total, rotation_vector<S>(transposed_times(last, now)));
        last = now;
        return total;
    }

    bool operator==(const RotationTracker&) const = default;
};

} // namespace ductile
