// SPDX-License-Identifier: MIT
//
// A surface grown or shrunk about the origin by a factor, as isotropic hardening does: a view made
// for a moment, where Scaled is a surface of its own with other axes.
//
//   γ_g(f) = γ(f)/by
#pragma once

#include "ductile/surface/chords.hpp"
#include "ductile/surface/surface.hpp"

namespace ductile {

/// Models YieldSurface; refers to a surface that must outlive it. Members as in surface.hpp.
template <YieldSurface Surface>
struct Grown {
    using Scalar = typename Surface::Scalar;
    static constexpr int dimension = Surface::dimension;
    using Vector = typename Surface::Vector;
    using Matrix = typename Surface::Matrix;

    [[nodiscard]] Scalar value(const Vector& f) const noexcept { return surface.value(f) / by; }
    [[nodiscard]] Vector normal(const Vector& f) const noexcept { return surface.normal(f) / by; }
    [[nodiscard]] Vector support(const Vector& flow) const noexcept {
        return surface.support(flow) * by;
    }
    [[nodiscard]] Vector project(const Vector& f, const Matrix& stiffness) const noexcept {
        return surface.project(Vector(f / by), stiffness) * by;
    }

    [[nodiscard]] Chords<Vector> chords(const Vector& point) const noexcept {
        const Vector inside = point / by;
        if constexpr (ChordedSurface<Surface>) {
            const auto [lower, upper] = surface.chords(inside);
            return {lower * by, upper * by};
        } else {
            const auto [lower, upper] = chords_through(surface, inside);
            return {lower * by, upper * by};
        }
    }

    const Surface& surface;
    Scalar by; ///< > 0 [-]
};

} // namespace ductile
