// SPDX-License-Identifier: MIT
//
// How far one force may go while the others stay: the chords of a yield surface through a point, in
// closed form where the surface has one, else by Newton.
//
//   reach(p, b) = max { t ≥ 0 : γ(p + t b) ≤ 1 }
//
// Newton from outside, where the line leaves the tangent plane: γ is convex along it, so that t falls
// towards the root and never passes it.
//
// Symbols
//   p   a force on the surface or inside   [N | N m]
//   b   direction, of any length           [N | N m]
//   γ   gauge of the surface               [-]
//
// Source: derived here.
#pragma once

#include "ductile/surface/surface.hpp"

namespace ductile {

/// Largest t ≥ 0 with `point` + t·`along` not outside; `point` not outside. `along` of any length.
/// By Newton from outside, where the line leaves the tangent plane: 4-8 normals where it crosses
/// the surface, up to 60 where it only touches.
template <YieldSurface T>
[[nodiscard]] typename T::Scalar reach(const T& surface, const typename T::Vector& point,
                                       const typename T::Vector& along) noexcept {
    using S = typename T::Scalar;
    constexpr int max_steps = 100;
    const S rate = surface.value(along);
    if (!(rate > 0)) return 0;
    S t = (1 + surface.value(point)) / rate; // γ(p + t b) ≥ t γ(b) - γ(p) = 1: outside
    for (int step = 0; step < max_steps; ++step) {
        const typename T::Vector normal = surface.normal(point + t * along);
        const S next = (1 - normal.dot(point)) / normal.dot(along);
        if (!(next < t)) break; // convex: falls until round-off
        if (!(next > 0)) return 0;
        t = next;
    }
    return t;
}

/// The chords of the surface through `point` along the axes, in closed form where the surface has
/// one, else by `reach` in both directions. `point` not outside by more than round-off, and never
/// left out by the chords' own: lower ≤ point ≤ upper.
template <YieldSurface T>
[[nodiscard]] Chords<typename T::Vector> chords_through(const T& surface,
                                                        const typename T::Vector& point) noexcept {
    using Vector = typename T::Vector;
    if constexpr (ChordedSurface<T>) {
        const auto [lower, upper] = surface.chords(point);
        return {lower.cwiseMin(point), upper.cwiseMax(point)};
    } else {
        Chords<Vector> chords{point, point};
        for (int i = 0; i < T::dimension; ++i) {
            chords.upper[i] += reach(surface, point, Vector(Vector::Unit(i)));
            chords.lower[i] -= reach(surface, point, Vector(-Vector::Unit(i)));
        }
        return chords;
    }
}

} // namespace ductile
