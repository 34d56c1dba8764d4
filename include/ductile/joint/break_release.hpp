// SPDX-License-Identifier: MIT
//
// What a joint that breaks hands back to its two bodies: the impulse that gives an energy to the
// motion along one axis and leaves alone the axes that are held.
//
// Along the axis e with the response h (inverse_mass.hpp: axis_response) the pair has the momentum
// p = h · t and the mass m = e · h, and the impulse h Δu does the work p Δu + m Δu²/2.
//
// Symbols
//   t    relative twist (v, ω) of A minus B at the joint, world axes   [m/s, rad/s]
//   e    axis: three linear, then three angular entries, unit          [-]
//   h    impulse that changes the velocity along e by one              [kg | kg m²]
//
// Source: derived here; the mass of inverse_mass.hpp.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <concepts>

#include "ductile/joint/inverse_mass.hpp"
#include "ductile/numeric/ldlt.hpp"
#include "ductile/vocabulary/vector.hpp"

namespace ductile {

/// Impulse that gives `energy` >= 0 [J] to the motion along `axis` and leaves alone the axes that
/// `response` h leaves alone; `twist` is t. From p Δu + m Δu²/2 = energy,
///
///   Δu = sign(p) 2 energy / (|p| + √(p² + 2 m energy)),
///
/// which never turns the motion round. Where the other axes are at rest p = m u, and this is
/// u'² = u² + 2 energy / m. Zero where neither body can move along the axis.
template <std::floating_point S>
[[nodiscard]] JointImpulse<S> release_impulse(const Vector6<S>& response, const Vector6<S>& axis,
                                              const Vector6<S>& twist, S energy) noexcept {
    const S mass = dot(axis, response);
    const S momentum = dot(twist, response);
    const S root = std::sqrt(momentum * momentum + 2 * mass * energy);
    if (!(mass > 0) || !std::isfinite(mass) || !(root > 0)) return {};
    const S change = std::copysign(2 * energy / (std::abs(momentum) + root), momentum);
    return {scaled(change, linear(response)), scaled(change, angular(response))};
}

/// The same for a joint whose other five axes are rigid, h = K⁻¹ e.
template <std::floating_point S>
[[nodiscard]] JointImpulse<S> release_impulse(const BodyAtJoint<S>& a, const BodyAtJoint<S>& b,
                                              const Vector6<S>& axis, const Vector6<S>& twist,
                                              S energy) noexcept {
    const Vector6<S> response = numeric::solve_semidefinite(inverse_mass_at_joint(a, b), axis);
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
            velocity_change(
                b, JointImpulse<S>{scaled(-1, impulse.linear), scaled(-1, impulse.angular)})};
}

/// The velocity changes that give `energy` [J] back along `axis`; see release_impulse.
template <std::floating_point S>
[[nodiscard]] BreakRelease<S> break_release(const BodyAtJoint<S>& a, const BodyAtJoint<S>& b,
                                            const Vector6<S>& axis, const Vector6<S>& twist,
                                            S energy) noexcept {
    return break_release(a, b, release_impulse(a, b, axis, twist, energy), energy);
}

} // namespace ductile
