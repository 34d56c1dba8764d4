// SPDX-License-Identifier: MIT
//
// What a body's spin changes of itself in a part of a frame. Engines solve I (ω' - ω) + h ω' × Iω'
// = 0 by an implicit rule, which takes energy of first order in the part: of a top of 10 rad/s that
// a plastic joint stops, a fifth at 1/30 s. The implicit midpoint rule takes none:
//
//   I (ω' - ω) + h ω̄ × Iω̄ = 0,   ω̄ = (ω + ω')/2,   as ω̄·(ω̄ × Iω̄) = 0
//
//   ω, ω'  spin before and after, world axes [rad/s]
//   I      inertia as it is in the middle of the part, world axes [kg m²]
//
// h -> 0: that of the engines. A body that turns about a principal axis, a sphere: zero.
#pragma once

#include "ductile/numeric/lu.hpp"
#include "ductile/vocabulary/vector.hpp"

namespace ductile {

/// I (ω' - ω) [N m s] in a part of `dt` [s]; no number where the body cannot turn, or where it
/// turns too far in that for there to be one.
[[nodiscard]] inline Vector3<double> gyroscopic_midpoint(const Matrix3<double>& inertia,
                                                         const Vector3<double>& spin,
                                                         double dt) noexcept {
    constexpr double exact = 1e-14; // of the spin
    constexpr int most = 20;
    Vector3<double> change(0, 0, 0);
    for (int i = 0; i < most; ++i) {
        const Vector3<double> middle = sum(spin, scaled(0.5, change));
        const Vector3<double> momentum = times(inertia, middle);
        const Vector3<double> left =
            sum(times(inertia, change), scaled(dt, cross(middle, momentum)));
        const Matrix3<double> jacobian =
            sum(inertia, scaled(dt / 2, difference(times(skew(middle), inertia), skew(momentum))));
        const Vector3<double> step = numeric::Lu<double, 3>(jacobian).solve(left);
        change = difference(change, step);
        if (!(norm(step) > exact * norm(spin))) return times(inertia, change);
    }
    const double none = std::nan("");
    return {none, none, none};
}

/// Whether an engine's rule takes anything of note in a part of `dt` [s].
[[nodiscard]] inline bool turns_far(const Vector3<double>& spin, double dt) noexcept {
    constexpr double turn = 1e-4; // [rad]: of its energy an engine's rule takes turn² a part
    return norm(spin) * dt > turn;
}

/// More than round-off: not where a body turns about a principal axis, nor a sphere's.
[[nodiscard]] inline bool wobbles(const Matrix3<double>& inertia,
                                  const Vector3<double>& spin) noexcept {
    constexpr double round_off = 1e-14;
    const Vector3<double> momentum = times(inertia, spin);
    return norm(cross(spin, momentum)) > round_off * norm(spin) * norm(momentum);
}

/// What has to be added to the `engine`'s own [N m s]; zero where there is no better one.
[[nodiscard]] inline Vector3<double> gyroscopic_rest(const Vector3<double>& engine,
                                                     const Matrix3<double>& inertia,
                                                     const Vector3<double>& spin,
                                                     double dt) noexcept {
    if (is_zero(engine)) return engine; // also where the engine is told to leave it out
    const Vector3<double> rest = difference(gyroscopic_midpoint(inertia, spin, dt), engine);
    return is_finite(rest) ? rest : Vector3<double>(0, 0, 0);
}

} // namespace ductile
