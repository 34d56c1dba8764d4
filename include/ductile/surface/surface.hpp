// SPDX-License-Identifier: MIT
//
// How the forces of several axes combine: what every yield surface offers.
//
// A yield surface bounds the convex set Ω of forces a joint can carry; the origin is inside. It is
// given by its gauge, the factor by which a force exceeds the surface along its own direction:
//
//   γ(f) = min { s ≥ 0 : f ∈ s Ω },   f ∈ Ω  ⇔  γ(f) ≤ 1,   γ(s f) = s γ(f) for s ≥ 0
//
// A gauge is convex, so ∇γ is the outward normal, and ∇γ(f)·f = γ(f) (Euler). With associated flow,
//
//   flow = μ ∇γ(f),  μ ≥ 0,   dissipated work f·flow = μ  on the surface,
//
// the multiplier is the dissipated work itself. The support point of a flow is the force that it
// meets, the one of the largest work (maximum dissipation); support(flow)·flow is the dissipation
// function. All surfaces here are symmetric to the origin: γ(-f) = γ(f).
//
// Symbols
//   f      force, one entry per axis                            [N | N m], or [-] where normalised
//   flow   plastic flow or flow rate, conjugate to f            [m | rad]
//   K      stiffness: elastic, or the effective mass of the rows; symmetric, positive definite.
//          Its size does not matter to a projection, only its shape.  [N/m | N m/rad | ...]
//
// Source: gauge and support function: Rockafellar (1970), Convex Analysis, sections 13-15; maximum
// dissipation: Hill (1948), doi:10.1093/qjmam/1.1.18.
#pragma once

#include <Eigen/Core>
#include <concepts>
#include <limits>

namespace ductile {

/// `value(f)`   γ(f) ≥ 0, 1 on the surface.
/// `normal(f)`  ∇γ(f), the same along a ray, not of unit length: [1/N | 1/(N m)]. Zero at f = 0;
///              in a corner the middle of the fan, as a central difference gives it.
/// `support(flow)`  the force on the surface whose normal is `flow`, of any length; zero at zero.
/// `project(f, stiffness)`  f where it is inside, else the force on the surface closest to f in the
///              metric of the inverse stiffness, f - stiffness·flow with associated flow.
/// All are noexcept, allocate nothing and may be called from several threads.
template <class T>
concept YieldSurface = requires(const T surface, const typename T::Vector& vector,
                                const typename T::Matrix& stiffness) {
    requires std::floating_point<typename T::Scalar>;
    requires(T::dimension > 0);
    { surface.value(vector) } noexcept -> std::same_as<typename T::Scalar>;
    { surface.normal(vector) } noexcept -> std::same_as<typename T::Vector>;
    { surface.support(vector) } noexcept -> std::same_as<typename T::Vector>;
    { surface.project(vector, stiffness) } noexcept -> std::same_as<typename T::Vector>;
};

/// Where the lines through a point along the axes leave the surface: force i alone may go from
/// lower[i] to upper[i] while the others stay. Plain value [N | N m].
template <class Vector>
struct Chords {
    Vector lower, upper;
};

/// A surface that knows its chords in closed form; others leave them to Newton (chords.hpp).
/// `chords(point)`  for a point not outside by more than round-off.
template <class T>
concept ChordedSurface = YieldSurface<T> && requires(const T surface,
                                                     const typename T::Vector& point) {
    { surface.chords(point) } noexcept -> std::same_as<Chords<typename T::Vector>>;
};

/// A gauge this little above 1 is on the surface: room for the round-off of one evaluation, so that
/// a projected force is not projected again.
template <std::floating_point S>
inline constexpr S on_surface = 16 * std::numeric_limits<S>::epsilon();

/// f where it is inside, else f/γ(f): the radial return. It is the closest point where the surface
/// is an ellipsoid in the metric of the stiffness, else its flow is not associated.
template <YieldSurface T>
[[nodiscard]] typename T::Vector project_radially(const T& surface,
                                                  const typename T::Vector& force) noexcept {
    const auto value = surface.value(force);
    if (!(value > 1 + on_surface<typename T::Scalar>)) return force;
    return force / value;
}

} // namespace ductile
