// SPDX-License-Identifier: MIT
//
// Two rigid bodies seen from the point that joins them: how their relative motion there answers to
// an impulse, and the mass that one axis of the joint feels while others hold.
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

#include <Eigen/Core>
#include <concepts>

#include "ductile/numeric/ldlt.hpp"
#include "ductile/numeric/lu.hpp"
#include "ductile/vocabulary/vector.hpp"

namespace ductile {

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
    const Vector3<S> moment = sum(cross(body.arm, impulse.linear), impulse.angular);
    return {scaled(body.inverse_mass, impulse.linear), times(body.inverse_inertia, moment)};
}

/// K [1/kg and 1/(kg m²)]: what the pair's relative twist at the joint answers to an impulse.
template <std::floating_point S>
[[nodiscard]] Matrix6<S> inverse_mass_at_joint(const BodyAtJoint<S>& a,
                                               const BodyAtJoint<S>& b) noexcept {
    Matrix6<S> k = Matrix6<S>::Zero();
    for (int i = 0; i < 3; ++i) k(i, i) = a.inverse_mass + b.inverse_mass;
    for (const BodyAtJoint<S>* body : {&a, &b}) {
        const Matrix3<S>& inertia = body->inverse_inertia;
        Matrix3<S> turned; // [r]ₓ I⁻¹; its transpose is -I⁻¹ [r]ₓ
        for (int j = 0; j < 3; ++j) {
            const Vector3<S> turn = cross(body->arm, column(inertia, j));
            for (int i = 0; i < 3; ++i) {
                turned(i, j) = turn[i];
                k(i, 3 + j) -= turn[i];
                k(3 + j, i) -= turn[i];
                k(3 + i, 3 + j) += inertia(i, j);
            }
        }
        // [r]ₓ ([r]ₓ I⁻¹)ᵀ = -[r]ₓ I⁻¹ [r]ₓ
        for (int j = 0; j < 3; ++j) {
            const Vector3<S> row(turned(j, 0), turned(j, 1), turned(j, 2));
            const Vector3<S> moved = cross(body->arm, row);
            for (int i = 0; i < 3; ++i) k(i, j) += moved[i];
        }
    }
    return k;
}

/// Inverse of a symmetric, positive definite 6×6 matrix such as K, by its 3×3 blocks; not finite
/// where it has none.
///
///   [ P  Q  ]⁻¹   [  Z           -Z Q R⁻¹             ]
///   [ Qᵀ R  ]   = [ -R⁻¹ Qᵀ Z    R⁻¹ + R⁻¹ Qᵀ Z Q R⁻¹ ],   Z = (P - Q R⁻¹ Qᵀ)⁻¹
template <std::floating_point S>
[[nodiscard]] Matrix6<S> inverse_by_blocks(const Matrix6<S>& k) noexcept {
    const Matrix3<S> q = block(k, 0, 3);
    const Matrix3<S> r = numeric::inverse(block(k, 3, 3));
    const Matrix3<S> qr = times(q, r);
    const Matrix3<S> z = numeric::inverse(difference(block(k, 0, 0), times_transposed(qr, q)));
    const Matrix3<S> zqr = scaled(-1, times(z, qr));
    Matrix6<S> result;
    set_block(result, 0, 0, z);
    set_block(result, 0, 3, zqr);
    set_block(result, 3, 0, transposed(zqr));
    set_block(result, 3, 3, difference(r, transposed_times(qr, zqr)));
    return result;
}

/// h: impulse that changes the velocity along the unit `axis` by one, changes none along the
/// first `count` <= 5 columns of `held` (unit, at right angles to `axis` and each other), and has no
/// part along any other direction. Its share along the axis, e·h, is the mass m that the row feels [kg | kg m²].
/// Zero where neither body can move.
///
///   h = B (Bᵀ K B)⁻¹ (0, ..., 0, 1)ᵀ,   B = (held, e);   with five axes held h = K⁻¹ e
template <std::floating_point S>
[[nodiscard]] Vector6<S> axis_response(const Matrix6<S>& k, const Vector6<S>& axis,
                                       const Matrix6<S>& held, int count) noexcept {
    const auto basis = [&](int i, int j) { return j < count ? held(i, j) : axis[i]; };
    Matrix6<S> projected = Matrix6<S>::Zero(); // directions that are free ask for nothing
    for (int j = 0; j <= count; ++j) {
        Vector6<S> moved = Vector6<S>::Zero(); // K b_j
        for (int l = 0; l < 6; ++l) {
            for (int i = 0; i < 6; ++i) moved[i] += k(i, l) * basis(l, j);
        }
        for (int i = 0; i <= count; ++i) {
            for (int l = 0; l < 6; ++l) projected(i, j) += basis(l, i) * moved[l];
        }
    }
    Vector6<S> wanted = Vector6<S>::Zero(), result = Vector6<S>::Zero();
    wanted[count] = 1;
    const Vector6<S> shares = numeric::solve_semidefinite(projected, wanted);
    for (int j = 0; j <= count; ++j) {
        for (int i = 0; i < 6; ++i) result[i] += basis(i, j) * shares[j];
    }
    return result;
}

} // namespace ductile
