// SPDX-License-Identifier: MIT
//
// A polygon cut by a line: what lies above it, the length of the cut, and fully plastic bending with
// the line as neutral axis. polygon.hpp says how.
//
// Symbols
//   u, v  coordinates along and across the line, from the centroid [m]
//   v_p   height that halves the area                              [m]
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <span>

#include "ductile/section/point.hpp"

namespace ductile {

/// Fully plastic bending: stress f_y above the neutral axis, -f_y below. The moments over f_y are
/// `modulus` about the neutral axis and `companion` across it; where the companion is not zero the
/// section must be held sideways, or its neutral axis turns.
template <std::floating_point S>
struct PlasticBending {
    S modulus = 0;   ///< ∫ |v - v_p| dA [m³]
    S companion = 0; ///< ∫ sign(v - v_p) u dA [m³], signed
    S height = 0;    ///< v_p [m]
};

namespace detail {

/// Axes u, v at an angle from x, y.
template <std::floating_point S>
struct Frame {
    S cosine = 1;
    S sine = 0;

    [[nodiscard]] S along(Point<S> p) const noexcept { return cosine * p.x + sine * p.y; }
    [[nodiscard]] S across(Point<S> p) const noexcept { return cosine * p.y - sine * p.x; }
};

/// Part of a polygon above a line.
template <std::floating_point S>
struct Above {
    S area = 0;     ///< [m²]
    S moment_u = 0; ///< ∫ u dA [m³]
    S moment_v = 0; ///< ∫ (height above the line) dA [m³]
};

/// `vertices` counterclockwise.
template <std::floating_point S>
[[nodiscard]] Above<S> above(std::span<const Point<S>> vertices, Frame<S> frame, S height) noexcept {
    Above<S> sum;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const Point<S> from = vertices[i];
        const Point<S> to = vertices[(i + 1) % vertices.size()];
        Point<S> p{frame.along(from), frame.across(from) - height};
        Point<S> q{frame.along(to), frame.across(to) - height};
        if (p.y <= 0 && q.y <= 0) continue;
        if (p.y < 0) p = {p.x + (q.x - p.x) * (p.y / (p.y - q.y)), 0};
        else if (q.y < 0) q = {q.x + (p.x - q.x) * (q.y / (q.y - p.y)), 0};
        const S area = cross(p, q) / 2;
        sum.area += area;
        sum.moment_u += area * (p.x + q.x) / 3;
        sum.moment_v += area * (p.y + q.y) / 3;
    }
    return sum;
}

/// Total length of the line inside the polygon, 0 outside. At a height where the length jumps, its
/// limit from above, at the top its limit from below.
template <std::floating_point S>
[[nodiscard]] S chord(std::span<const Point<S>> vertices, Frame<S> frame, S height) noexcept {
    S above = 0;
    S below = 0;
    bool top = true;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const Point<S> from = vertices[i];
        const Point<S> to = vertices[(i + 1) % vertices.size()];
        const S p = frame.across(from);
        const S q = frame.across(to);
        if (p > height) top = false;
        if (p == q) continue;
        // Upward edges bound the section at their right, downward ones at their left.
        const S at = frame.along(from) + (height - p) / (q - p) * (frame.along(to) - frame.along(from));
        if ((p <= height) != (q <= height)) above += p < q ? at : -at;
        if ((p < height) != (q < height)) below += p < q ? at : -at;
    }
    return std::max(top ? below : above, S(0));
}

/// `vertices` counterclockwise around the centroid.
template <std::floating_point S>
[[nodiscard]] PlasticBending<S> plastic_bending(std::span<const Point<S>> vertices, S area,
                                                Frame<S> frame) noexcept {
    // The two vertices between which the area is halved.
    S low = -std::numeric_limits<S>::infinity();
    S high = std::numeric_limits<S>::infinity();
    S surplus = 0; // area above `low` beyond the half
    for (const Point<S>& vertex : vertices) {
        const S height = frame.across(vertex);
        if (!(height > low && height < high)) continue;
        const S beyond = above(vertices, frame, height).area - area / 2;
        if (beyond >= 0) {
            low = height;
            surplus = beyond;
        }
        if (beyond <= 0) high = height;
    }
    S axis = high;
    if (low < high) {
        const S step = high - low;
        const S early = chord(vertices, frame, low + step / 4);
        const S late = chord(vertices, frame, low + 3 * step / 4);
        const S first = early - (late - early) / 2; // width just above `low`
        const S growth = 2 * (late - early) / step;
        const S root = std::sqrt(std::max(first * first + 2 * growth * surplus, S(0)));
        const S rise = first + root > 0 ? 2 * surplus / (first + root) : S(0);
        axis = low + std::clamp(rise, S(0), step);
    }
    const Above<S> part = above(vertices, frame, axis);
    return {.modulus = 2 * part.moment_v + axis * area,
            .companion = 2 * part.moment_u,
            .height = axis};
}

} // namespace detail

} // namespace ductile
