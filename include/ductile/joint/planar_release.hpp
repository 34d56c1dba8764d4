// SPDX-License-Identifier: MIT
//
// The energy that a breaking hinge took in excess, given back to its two bodies in an engine of the
// plane: the equal and opposite impulses (P, L) at the pin that change how fast the hinge turns and
// leave the pin closed. release_impulse of pair.hpp does the same in space.
//
// An impulse (P, L) on A, and its opposite on B, changes the velocity v of A relative to B at the
// pin and its spin ω by
//
//   Δv = K P + k L,   Δω = k·P + (i_A + i_B) L,
//   K = w 1 + i_A n_A n_Aᵀ + i_B n_B n_Bᵀ,   k = i_A n_A + i_B n_B,   w = w_A + w_B
//
// Δv = 0 gives P = -K⁻¹ k L and Δω = L/I, where
//
//   det K = w (w + i_A r_A² + i_B r_B²) + i_A i_B (r_A × r_B)²
//   1/I   = w (w (i_A + i_B) + i_A i_B |r_A - r_B|²) / det K
//
// and the energy E needs |Δω| = 2 (E/I) / (|ω| + √(ω² + 2 E/I)), so that ω'² = ω² + 2 E/I.
//
// Limit cases. Pin at both centres of mass, or no mass to move (w → ∞): 1/I = i_A + i_B and, at the
// centres, P = 0. B cannot move: I = 1/i_A + m_A r_A², the inertia of A about the pin. Neither can
// turn, or the centres of both are fixed away from the pin: 1/I = 0, and nothing can be given back.
//
// Symbols ("_A", "_B": of that body)
//   w    1/m; 0: the centre of mass cannot move          [1/kg]
//   i    inverse inertia about the centre of mass        [1/(kg m²)]
//   r    arm, joint minus centre of mass; n = (-r_y, r_x) [m]
//   I    inertia the hinge feels while its pin holds     [kg m²]
//   ω    spin of A minus that of B                       [rad/s]
//
// Source: as release_impulse of pair.hpp, whose K without its rows out of the plane this is; the
// closed form of 1/I is the Schur complement of K, written out here.
#pragma once

#include <cmath>
#include <concepts>

namespace ductile {

/// One body's part in a joint of the plane. Default: a body that cannot move.
template <std::floating_point S>
struct PlanarBody {
    S inverse_mass = 0;     ///< w [1/kg]
    S inverse_inertia = 0;  ///< i, about the centre of mass [1/(kg m²)]
    S arm_x = 0, arm_y = 0; ///< r, world axes [m]
};

/// Change of a body's velocities.
template <std::floating_point S>
struct PlanarChange {
    S x = 0, y = 0; ///< of the centre of mass, world axes [m/s]
    S spin = 0;     ///< [rad/s]
};

/// What a break hands back to its two bodies, once, at the end of the breaking step.
template <std::floating_point S>
struct PlanarRelease {
    PlanarChange<S> a, b;
};

/// The changes that give `energy` >= 0 [J] to a hinge that turns at `spin` ω [rad/s] and whose pin
/// stays closed. It never turns the motion round; a hinge at rest is turned forwards. Momentum is
/// kept where both bodies can move. No change where the hinge cannot turn.
template <std::floating_point S>
[[nodiscard]] PlanarRelease<S> planar_release(const PlanarBody<S>& a, const PlanarBody<S>& b,
                                              S spin, S energy) noexcept {
    const S i_a = a.inverse_inertia, i_b = b.inverse_inertia;
    const S w = a.inverse_mass + b.inverse_mass;
    const S square_a = a.arm_x * a.arm_x + a.arm_y * a.arm_y;
    const S square_b = b.arm_x * b.arm_x + b.arm_y * b.arm_y;
    const S cross = a.arm_x * b.arm_y - a.arm_y * b.arm_x;
    const S apart_x = a.arm_x - b.arm_x, apart_y = a.arm_y - b.arm_y;
    const S off_centre = i_a * square_a + i_b * square_b;
    const S determinant = w * (w + off_centre) + i_a * i_b * cross * cross;

    const bool centred = off_centre == 0; // the pin plays no part
    const S apart = apart_x * apart_x + apart_y * apart_y;
    const S ease = centred ? i_a + i_b // 1/I
                   : w > 0 ? w * (w * (i_a + i_b) + i_a * i_b * apart) / determinant
                           : S(0);
    const S gain = 2 * energy * ease;
    if (!(gain > 0)) return {};
    const S change = std::copysign(gain / (std::abs(spin) + std::sqrt(spin * spin + gain)), spin);

    const S moment = change / ease; // L
    S push_x = 0, push_y = 0;       // P
    if (!centred) {
        const S k_x = -(i_a * a.arm_y + i_b * b.arm_y), k_y = i_a * a.arm_x + i_b * b.arm_x;
        const S k_xx = w + i_a * a.arm_y * a.arm_y + i_b * b.arm_y * b.arm_y;
        const S k_yy = w + i_a * a.arm_x * a.arm_x + i_b * b.arm_x * b.arm_x;
        const S k_xy = -(i_a * a.arm_x * a.arm_y + i_b * b.arm_x * b.arm_y);
        push_x = -moment * (k_yy * k_x - k_xy * k_y) / determinant;
        push_y = -moment * (k_xx * k_y - k_xy * k_x) / determinant;
    }
    const auto answer = [&](const PlanarBody<S>& body, S sign) noexcept {
        const S turned = body.arm_x * push_y - body.arm_y * push_x + moment;
        return PlanarChange<S>{sign * body.inverse_mass * push_x, sign * body.inverse_mass * push_y,
                               sign * body.inverse_inertia * turned};
    };
    return {answer(a, S(1)), answer(b, S(-1))};
}

} // namespace ductile
