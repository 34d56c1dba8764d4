// SPDX-License-Identifier: MIT
//
// Volume of the sand heap on a simple polygon, the integral of the distance to its boundary.
//
// A bar twisted until all of it flows has a stress function of slope tau_y that is zero on the
// boundary: a heap of sand on the section. The plastic torque is T_p = 2 tau_y V = tau_y W_T.
//
// Source: A. Nadai (1923), ZAMM 3, 442-454. The quadrature is ours:
//
// A point belongs to its nearest boundary point p. All points that belong to p lie on a ray along an
// inward normal n of the boundary at p, from 0 to the radius h of the largest disk that touches the
// boundary from inside at p. So
//
//   V = Σ_edges ∫ h²/2 ds  +  Σ_reflex vertices ∫ h³/3 dφ
//
// over the length s of each edge, and over the angle φ of n at each vertex where the polygon turns
// inwards. The disk is stopped by another part of the boundary, and h is the least of
//
//   by a vertex q              h = |q - p|² / (2 n·(q - p))
//   by a line with normal m    h = m·(p - q) / (1 - m·n),  if it is touched within the edge.
//
// Along an edge both are polynomials in s of degree <= 2. At a vertex both are (1 + u²)/Q(u) with Q
// quadratic in u = tan(φ/2). So where one takes over from another is a root of a quadratic; between
// such roots the first integral is done exactly and the second by Gauss-Legendre to round-off.
//
// Error: relative 1e-11 or better for outlines whose thinnest part is not thinner than 1e-6 of their
// size, see the tests. Arithmetic is at least double. O(n) for each of the O(n)
// pieces; allocates nothing.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <span>
#include <type_traits>

#include "ductile/section/inscribed_disks.hpp"
#include "ductile/section/point.hpp"

namespace ductile {

namespace detail {

template <class W>
inline constexpr W tolerance = W(1e-11); ///< relative, of radii that count as equal

/// Obstacle that stops the disk at u; `count` where none does.
template <class W, class Disks>
struct Nearest {
    std::size_t index;
    Stop<W> stop;

    Nearest(const Disks& disks, W u) noexcept : index(disks.count()) {
        for (std::size_t k = 0; k < disks.count(); ++k) {
            const Stop<W> candidate = disks.stop(k);
            if (candidate(u) < stop(u) && disks.holds(k, candidate, u)) {
                index = k;
                stop = candidate;
            }
        }
    }
};

/// Shrinks (low, high) around u to where `nearest` is not overtaken.
template <class W, class Disks>
void clip_to_piece(const Disks& disks, const Nearest<W, Disks>& nearest, W u, W& low,
                   W& high) noexcept {
    const auto clip = [&](W end) {
        if (end <= u) low = std::max(low, end);
        if (end > u) high = std::min(high, end);
    };
    for (const W end : nearest.stop.ends) clip(end);
    for (std::size_t k = 0; k < disks.count(); ++k) {
        const Stop<W> other = disks.stop(k);
        if (k == nearest.index || !(other.c0 < Stop<W>::nowhere)) continue;
        for (const W end : other.ends) {
            // A line takes over from the vertex it ends at without crossing it.
            const bool inside = end > low && end < high;
            const W stopped = nearest.stop(end);
            if (inside && other(end) - stopped <= tolerance<W> * std::abs(stopped)) clip(end);
        }
        // as polynomials in what is beyond u, where thin outlines lose no digits
        const W d0 = other(u) - nearest.stop(u);
        const W d1 = other.slope(u) - nearest.stop.slope(u);
        const W d2 = other.c2 - nearest.stop.c2;
        const W discriminant = d1 * d1 - 4 * d0 * d2;
        if (!(discriminant > 0)) continue; // they never cross
        const W q = -(d1 + std::copysign(std::sqrt(discriminant), d1)) / 2;
        for (const W root : {u + q / d2, u + d0 / q}) {
            if (root > low && root < high && disks.holds(k, other, root)) clip(root);
        }
    }
}

/// Volume over (a, b). Finds the piece around a point inside, integrates it, and goes on to both
/// sides. A tie at that point may pick the wrong side of a crossing: then the piece is cut there.
template <class W, class Disks>
[[nodiscard]] W heap_volume(const Disks& disks, W a, W b) noexcept {
    constexpr W inside = W(0.381966011250105152L); // golden, so that symmetric outlines rarely tie
    // Where edges meet, whether an obstacle is touched is lost in round-off: leave that length out.
    constexpr W smallest = 1000 * std::numeric_limits<W>::epsilon();
    if (!(b - a > smallest * (disks.last() - disks.first()))) return 0;
    const W u = a + inside * (b - a);
    const Nearest<W, Disks> nearest(disks, u);
    if (nearest.index == disks.count()) return 0; // in round-off of a corner, as above

    W low = a;
    W high = b;
    clip_to_piece(disks, nearest, u, low, high);
    const W middle = (low + high) / 2;
    const W least = Nearest<W, Disks>(disks, middle).stop(middle);
    if (std::abs(nearest.stop(middle) - least) > tolerance<W> * std::abs(least)) {
        return heap_volume(disks, a, u) + heap_volume(disks, u, b);
    }
    W volume = disks.volume(nearest.stop, low, high);
    if (low > a) volume += heap_volume(disks, a, low);
    if (high < b) volume += heap_volume(disks, high, b);
    return volume;
}

} // namespace detail

/// V [m³], the integral of the distance to the boundary over the simple polygon with these vertices
/// [m], in either orientation. Anything else than a simple polygon of positive area gives a number
/// without meaning.
template <std::floating_point S>
[[nodiscard]] S sand_heap_volume(std::span<const Point<S>> vertices) noexcept {
    using W = std::conditional_t<(sizeof(S) < sizeof(double)), double, S>;
    const detail::UnitOutline<W, S> outline(vertices);
    W volume = 0;
    for (std::size_t i = 0; i < outline.count(); ++i) {
        const detail::EdgeDisks<W, detail::UnitOutline<W, S>> edge(outline, i);
        volume += detail::heap_volume(edge, edge.first(), edge.last());
        const detail::VertexDisks<W, detail::UnitOutline<W, S>> vertex(outline, i);
        if (vertex.last() > 0) volume += detail::heap_volume(vertex, vertex.first(), vertex.last());
    }
    return static_cast<S>(volume * outline.size() * outline.size() * outline.size());
}

} // namespace ductile
