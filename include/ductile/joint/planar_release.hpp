// SPDX-License-Identifier: MIT
//
// The energy that a breaking hinge took in excess, given back to its two bodies in an engine of the
// plane: the equal and opposite impulses (P, L) at the pin that change how fast the hinge turns and
// not the velocity at its pin. release_impulse of break_release.hpp does the same in space.
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
// The impulse does the work (p + I Δω/2) Δω, with the momentum p = I (ω - v·K⁻¹ k), so that the
// energy E needs
//
//   Δω = sign(p) 2 E / (|p| + √(p² + 2 I E)).
//
// Arms in line, r_A × r_B = 0: K k = (w + i_A r_A² + i_B r_B²) k, so that w cancels and may be
// zero.
//
// Limit cases. The pin moves as one, v = 0: p = I ω and ω'² = ω² + 2 E/I. After a step that turned
// the bodies it does not quite, v = O(dt), and without that term the energy would be wrong by as
// much. Pin at both centres of mass: 1/I = i_A + i_B, P = 0. B cannot move: I = 1/i_A + m_A r_A²,
// the inertia of A about the pin. Neither can turn, or the pin holds what is left: 1/I = 0, and
// nothing can be given back.
//
// Symbols ("_A", "_B": of that body)
//   w    1/m; 0: the centre of mass cannot move           [1/kg]
//   i    inverse inertia about the centre of mass         [1/(kg m²)]
//   r    arm, joint minus centre of mass; n = (-r_y, r_x) [m]
//   I    inertia the hinge feels while its pin holds      [kg m²]
//   v, ω velocity at the pin and spin of A minus B's      [m/s, rad/s]
//
// Source: as release_impulse of break_release.hpp, whose K without its rows out of the plane this
// is; the closed form of 1/I is the Schur complement of K, written out here.
#pragma once

#include <cmath>
#include <concepts>

#include "ductile/vocabulary/finite.hpp"

namespace ductile {

template <std::floating_point S>
struct PlanarVelocity {
    S x = 0, y = 0; ///< of the centre of mass, world axes [m/s]
    S spin = 0;     ///< [rad/s]
};

/// One body's part in a joint of the plane. Default: a body that cannot move.
template <std::floating_point S>
struct PlanarBody {
    S inverse_mass = 0;              ///< w [1/kg]
    S inverse_inertia = 0;           ///< i, about the centre of mass [1/(kg m²)]
    S arm_x = 0, arm_y = 0;          ///< r, world axes [m]
    PlanarVelocity<S> velocity = {}; ///< at the end of the breaking step
};

/// What a break adds to the velocities of its two bodies, once, at the end of the breaking step.
template <std::floating_point S>
struct PlanarRelease {
    PlanarVelocity<S> a, b;
};

/// The changes that give `energy` >= 0 [J] to a hinge and leave the velocity at its pin as it is.
/// They never turn the motion round; at rest A is turned forwards. Momentum is kept where both
/// bodies can move. No change where the hinge cannot turn, or a number is not finite.
template <std::floating_point S>
[[nodiscard]] PlanarRelease<S> planar_release(const PlanarBody<S>& a, const PlanarBody<S>& b,
                                              S energy) noexcept {
    const S i_a = a.inverse_inertia, i_b = b.inverse_inertia;
    const S w = a.inverse_mass + b.inverse_mass;
    const S square_a = a.arm_x * a.arm_x + a.arm_y * a.arm_y;
    const S square_b = b.arm_x * b.arm_x + b.arm_y * b.arm_y;
    const S cross = a.arm_x * b.arm_y - a.arm_y * b.arm_x;
    const S apart_x = a.arm_x - b.arm_x, apart_y = a.arm_y - b.arm_y;
    const S apart = apart_x * apart_x + apart_y * apart_y;
    const S scale = w + i_a * square_a + i_b * square_b;
    const S determinant = w * scale + i_a * i_b * cross * cross;
    const S moves = w * (i_a + i_b) + i_a * i_b * apart;
    const S k_x = -(i_a * a.arm_y + i_b * b.arm_y), k_y = i_a * a.arm_x + i_b * b.arm_x;

    S ease = i_a + i_b, push_x = 0, push_y = 0; // 1/I; P per L
    if (cross != 0) {
        const S k_xx = w + i_a * a.arm_y * a.arm_y + i_b * b.arm_y * b.arm_y;
        const S k_yy = w + i_a * a.arm_x * a.arm_x + i_b * b.arm_x * b.arm_x;
        const S k_xy = -(i_a * a.arm_x * a.arm_y + i_b * b.arm_x * b.arm_y);
        ease = w * moves / determinant;
        push_x = -(k_yy * k_x - k_xy * k_y) / determinant;
        push_y = -(k_xx * k_y - k_xy * k_x) / determinant;
    } else if (scale > 0) { // arms in line
        ease = moves / scale;
        push_x = -k_x / scale;
        push_y = -k_y / scale;
    }
    if (!(ease > 0)) return {};
    const S inertia = 1 / ease;
    const PlanarVelocity<S>& of_a = a.velocity;
    const PlanarVelocity<S>& of_b = b.velocity;
    const S pin_x = of_a.x - of_a.spin * a.arm_y - of_b.x + of_b.spin * b.arm_y;
    const S pin_y = of_a.y + of_a.spin * a.arm_x - of_b.y - of_b.spin * b.arm_x;
    const S momentum = inertia * (of_a.spin - of_b.spin + push_x * pin_x + push_y * pin_y);
    const S root = std::sqrt(momentum * momentum + 2 * inertia * energy);
    if (!(root > 0)) return {};
    // L, of a change of the spin by 2 E / (|p| + √(p² + 2 I E))
    const S moment = std::copysign(2 * inertia * energy / (std::abs(momentum) + root), momentum);
    if (!are_finite(moment, push_x, push_y)) return {};

    const auto answer = [&](const PlanarBody<S>& body, S by) noexcept {
        const S turn = body.arm_x * push_y - body.arm_y * push_x + 1;
        return PlanarVelocity<S>{by * body.inverse_mass * push_x, by * body.inverse_mass * push_y,
                                 by * body.inverse_inertia * turn};
    };
    return {answer(a, moment), answer(b, -moment)};
}

} // namespace ductile
