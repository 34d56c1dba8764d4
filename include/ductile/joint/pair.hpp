// SPDX-License-Identifier: MIT
//
// Two rigid bodies seen from the point that joins them: the mass one axis of the joint feels while
// the other five hold, and the impulse that changes the motion along that axis alone.
//
// With the relative twist at the joint, t = (v, ω) of body A minus that of body B, an impulse
// pair λ = (P, L) acting on A at the joint and opposite on B changes t by K λ,
//
//   K = K_A + K_B,   K_X = [ 1/m - [r]ₓ I⁻¹ [r]ₓ    -[r]ₓ I⁻¹ ]
//                          [ I⁻¹ [r]ₓ                 I⁻¹     ]
//
// An impulse that changes only the component along the unit axis e by Δu is λ = K⁻¹ e Δu, and the
// effective mass is m = (eᵀ K⁻¹ e) for a joint whose other five axes are rigid. A body that cannot
// move has zero inverse mass and inertia.
//
// Symbols
//   r    joint minus centre of mass, world axes          [m], 3-vector
//   I⁻¹  inverse inertia about the centre of mass, world [1/(kg m²)], 3×3
//   e    axis: three linear, then three angular entries  [-], 6-vector
//
// Source: Featherstone (2008), Rigid Body Dynamics Algorithms, section 2.8 (inverse inertia of a
// rigid body at a point); written out here.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <concepts>

namespace ductile {

template <std::floating_point S>
using Vector3 = Eigen::Matrix<S, 3, 1>;
template <std::floating_point S>
using Matrix3 = Eigen::Matrix<S, 3, 3>;
template <std::floating_point S>
using Vector6 = Eigen::Matrix<S, 6, 1>;
template <std::floating_point S>
using Matrix6 = Eigen::Matrix<S, 6, 6>;

/// One body's part in a joint. Default: a body that cannot move.
template <std::floating_point S>
struct BodyAtJoint {
    S inverse_mass = 0;                              ///< 1/m [1/kg]
    Matrix3<S> inverse_inertia = Matrix3<S>::Zero(); ///< I⁻¹, world axes [1/(kg m²)]
    Vector3<S> arm = Vector3<S>::Zero();             ///< r, world axes [m]
};

/// Impulse on body A at the joint, world axes; body B takes the opposite.
template <std::floating_point S>
struct JointImpulse {
    Vector3<S> linear = Vector3<S>::Zero();  ///< P [N s]
    Vector3<S> angular = Vector3<S>::Zero(); ///< L [N m s]
};

/// Change of a body's velocities by an impulse (P, L) at its joint.
template <std::floating_point S>
struct VelocityChange {
    Vector3<S> linear;  ///< of the centre of mass [m/s]
    Vector3<S> angular; ///< [rad/s]
};

template <std::floating_point S>
[[nodiscard]] VelocityChange<S> velocity_change(const BodyAtJoint<S>& body,
                                                const JointImpulse<S>& impulse) noexcept {
    return {body.inverse_mass * impulse.linear,
            body.inverse_inertia * (body.arm.cross(impulse.linear) + impulse.angular)};
}

/// K [1/kg and 1/(kg m²)]: what the pair's relative twist at the joint answers to an impulse.
template <std::floating_point S>
[[nodiscard]] Matrix6<S> inverse_mass_at_joint(const BodyAtJoint<S>& a,
                                               const BodyAtJoint<S>& b) noexcept {
    Matrix3<S> moving = Matrix3<S>::Identity() * (a.inverse_mass + b.inverse_mass);
    Matrix3<S> turned = Matrix3<S>::Zero(); // [r]ₓ I⁻¹; its transpose is -I⁻¹ [r]ₓ
    for (const BodyAtJoint<S>* body : {&a, &b}) {
        Matrix3<S> own;
        for (int i = 0; i < 3; ++i) own.col(i) = body->arm.cross(body->inverse_inertia.col(i));
        turned += own;
        // [r]ₓ ([r]ₓ I⁻¹)ᵀ = -[r]ₓ I⁻¹ [r]ₓ
        for (int i = 0; i < 3; ++i) {
            const Vector3<S> row = own.row(i);
            moving.col(i) += body->arm.cross(row);
        }
    }
    Matrix6<S> k;
    k.template topLeftCorner<3, 3>() = moving;
    k.template topRightCorner<3, 3>() = -turned;
    k.template bottomLeftCorner<3, 3>() = -turned.transpose();
    k.template bottomRightCorner<3, 3>() = a.inverse_inertia + b.inverse_inertia;
    return k;
}

/// Inverse of a symmetric, positive definite 6×6 matrix such as K, by its 3×3 blocks; not finite
/// where it has none.
///
///   [ P  Q  ]⁻¹   [  Z           -Z Q R⁻¹             ]
///   [ Qᵀ R  ]   = [ -R⁻¹ Qᵀ Z    R⁻¹ + R⁻¹ Qᵀ Z Q R⁻¹ ],   Z = (P - Q R⁻¹ Qᵀ)⁻¹
template <std::floating_point S>
[[nodiscard]] Matrix6<S> inverse_by_blocks(const Matrix6<S>& k) noexcept {
    const Matrix3<S> q = k.template topRightCorner<3, 3>();
    const Matrix3<S> r = k.template bottomRightCorner<3, 3>().inverse();
    const Matrix3<S> qr = q * r;
    const Matrix3<S> z =
        Matrix3<S>(k.template topLeftCorner<3, 3>() - qr * q.transpose()).inverse();
    const Matrix3<S> zqr = z * qr;
    Matrix6<S> result;
    result.template topLeftCorner<3, 3>() = z;
    result.template topRightCorner<3, 3>() = -zqr;
    result.template bottomLeftCorner<3, 3>() = -zqr.transpose();
    result.template bottomRightCorner<3, 3>() = r + qr.transpose() * zqr;
    return result;
}

/// h: impulse that changes the velocity along the unit `axis` by one, changes none along the
/// columns of `held` (unit, at right angles to `axis` and each other), and has no part along any
/// other direction. Its share along the axis, e·h, is the mass m that the row feels [kg | kg m²].
/// Not finite where neither body can move.
///
///   h = B (Bᵀ K B)⁻¹ (0, ..., 0, 1)ᵀ,   B = (held, e);   with five axes held h = K⁻¹ e
template <std::floating_point S, class Held>
[[nodiscard]] Vector6<S> axis_response(const Matrix6<S>& k, const Vector6<S>& axis,
                                       const Eigen::MatrixBase<Held>& held) noexcept {
    using Basis = Eigen::Matrix<S, 6, Eigen::Dynamic, Eigen::ColMajor, 6, 6>;
    using Square = Eigen::Matrix<S, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 6, 6>;
    using Column = Eigen::Matrix<S, Eigen::Dynamic, 1, Eigen::ColMajor, 6, 1>;
    const Eigen::Index n = held.cols();
    Basis basis(6, n + 1);
    basis.leftCols(n) = held;
    basis.col(n) = axis;
    const Square projected = basis.transpose() * k * basis;
    const Column unit = Column::Unit(n + 1, n);
    return basis * projected.ldlt().solve(unit);
}

/// Impulse that gives `energy` >= 0 [J] to the motion along `axis` and leaves alone the axes that
/// `response` h leaves alone (see axis_response). `twist` is the relative twist (v, ω) of A minus B
/// at the joint, world axes. With the momentum p = h · twist and the mass m = e · h, the change Δu
/// of the velocity along the axis does the work p Δu + m Δu²/2, so
///
///   Δu = sign(p) 2 energy / (|p| + √(p² + 2 m energy)),
///
/// which never turns the motion round. Where the other axes are at rest p = m u, and this is
/// u'² = u² + 2 energy / m. Zero where neither body can move along the axis.
template <std::floating_point S>
[[nodiscard]] JointImpulse<S> release_impulse(const Vector6<S>& response, const Vector6<S>& axis,
                                              const Vector6<S>& twist, S energy) noexcept {
    const S mass = axis.dot(response);
    const S momentum = twist.dot(response);
    const S root = std::sqrt(momentum * momentum + 2 * mass * energy);
    if (!(mass > 0) || !std::isfinite(mass) || !(root > 0)) return {};
    const S change = std::copysign(2 * energy / (std::abs(momentum) + root), momentum);
    const Vector6<S> impulse = response * change;
    return {impulse.template head<3>(), impulse.template tail<3>()};
}

/// The same for a joint whose other five axes are rigid, h = K⁻¹ e.
template <std::floating_point S>
[[nodiscard]] JointImpulse<S> release_impulse(const BodyAtJoint<S>& a, const BodyAtJoint<S>& b,
                                              const Vector6<S>& axis, const Vector6<S>& twist,
                                              S energy) noexcept {
    const Vector6<S> response = inverse_mass_at_joint(a, b).ldlt().solve(axis);
    return release_impulse(response, axis, twist, energy);
}

/// What a break handed back to its two bodies, once, at the end of the breaking step.
template <std::floating_point S>
struct BreakRelease {
    S energy = 0; ///< [J]; zero: nothing was handed back
    VelocityChange<S> a{Vector3<S>::Zero(), Vector3<S>::Zero()};
    VelocityChange<S> b{Vector3<S>::Zero(), Vector3<S>::Zero()};
};

/// What an impulse on A, and its opposite on B, that gives `energy` [J] back does to the two
/// bodies.
template <std::floating_point S>
[[nodiscard]] BreakRelease<S> break_release(const BodyAtJoint<S>& a, const BodyAtJoint<S>& b,
                                            const JointImpulse<S>& impulse, S energy) noexcept {
    return {energy, velocity_change(a, impulse),
            velocity_change(b, JointImpulse<S>{-impulse.linear, -impulse.angular})};
}

/// The velocity changes that give `energy` [J] back along `axis`; see release_impulse.
template <std::floating_point S>
[[nodiscard]] BreakRelease<S> break_release(const BodyAtJoint<S>& a, const BodyAtJoint<S>& b,
                                            const Vector6<S>& axis, const Vector6<S>& twist,
                                            S energy) noexcept {
    return break_release(a, b, release_impulse(a, b, axis, twist, energy), energy);
}

} // namespace ductile
