// SPDX-License-Identifier: MIT
//
// The words a plastic joint and a physics engine share.
//
// An engine solves, each step, rows of the form
//
//     u' + C λ = b,    lower dt ≤ λ ≤ upper dt
//
// A joint rules the numbers of its row before the solve (RowLimits) and books what happened after
// it (Reaction). Forces and moments cross the seam with dt, never impulses, because engines
// disagree about impulses.
//
// Symbols
//   u, u'  relative velocity of the row at the start and end of the step   [m/s | rad/s]
//   λ      impulse of the row, positive where it increases u               [N s | N m s]
//   C      compliance                                                      [1/kg | 1/(kg m²)]
//   b      target velocity                                                 [m/s | rad/s]
//   dt     step                                                            [s]
//
// "x | y" reads: x for a translational row, y for a rotational one.
#pragma once

#include <concepts>
#include <limits>
#include <string_view>

namespace ductile {

/// What a joint asks of its row for the coming step.
template <std::floating_point Scalar>
struct RowLimits {
    Scalar lower = -std::numeric_limits<Scalar>::infinity(); ///< smallest force [N | N m]
    Scalar upper = std::numeric_limits<Scalar>::infinity();  ///< largest force [N | N m]
    Scalar bias = 0;                                         ///< target velocity b [m/s | rad/s]
    Scalar compliance = 0;                                   ///< C [1/kg | 1/(kg m²)]
    /// Least C for a solver of rows that repeat each other, as those of a beam held at both ends:
    /// by it they share their forces; 0: not known [1/kg | 1/(kg m²)].
    Scalar softness = 0;

    bool operator==(const RowLimits&) const = default;
};

/// The row at the start of a step, before this step's external impulses.
template <std::floating_point Scalar>
struct Motion {
    Scalar position = 0; ///< q, not wrapped: a hinge may turn many times [m | rad]
    Scalar velocity = 0; ///< u [m/s | rad/s]
    /// m = 1/(J M⁻¹ Jᵀ) with the joint's rigid rows holding; read only by rows with an elastic
    /// part, 0: not known, infinite: driven [kg | kg m²]
    Scalar mass = 0;
    /// The bodies are half a step ahead (frame/README.md): q is that in the middle of the step, and
    /// they will end it at q + u' dt/2.
    bool ahead = false;
    Scalar before = 0; ///< then q at the start of the step; else not read [m | rad]
    /// Change of velocity between steps that is nobody's doing: the row turns with its bodies
    /// [m/s | rad/s].
    Scalar turning = 0;
    Scalar drift = 0;   ///< velocity at which the row is at rest after the step [m/s | rad/s]
    Scalar damping = 0; ///< least τ of an elastic part in this step [s]
};

/// What the engine did to the row in the step.
template <std::floating_point Scalar>
struct Reaction {
    Scalar force = 0;    ///< λ/dt, positive where it increases the velocity [N | N m]
    Scalar velocity = 0; ///< u' after the solve [m/s | rad/s]
    Scalar position = 0; ///< q after the engine moved the bodies, not wrapped [m | rad]
};

/// State of a joint after a step. `unreliable` says that the solver left the row unsolved, or that
/// the joint gives its bodies energy it never took, or that they turned further than it could
/// follow: neither motion nor force of this step should be believed.
enum class Outcome { elastic, yielding, broken, unreliable };

[[nodiscard]] constexpr std::string_view to_string(Outcome outcome) noexcept {
    switch (outcome) {
        case Outcome::elastic:
            return "elastic";
        case Outcome::yielding:
            return "yielding";
        case Outcome::broken:
            return "broken";
        case Outcome::unreliable:
            return "unreliable";
    }
    return "unknown";
}

} // namespace ductile
