// SPDX-License-Identifier: MIT
//
// Check that vertices make a simple polygon: edges meet only at the vertex that neighbours share.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>

#include "ductile/section/point.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile {

namespace detail {

/// Whether the closed boxes around segments a-b and c-d meet.
template <std::floating_point S>
[[nodiscard]] bool boxes_meet(Point<S> a, Point<S> b, Point<S> c, Point<S> d) noexcept {
    return std::max(a.x, b.x) >= std::min(c.x, d.x) && std::max(c.x, d.x) >= std::min(a.x, b.x) &&
           std::max(a.y, b.y) >= std::min(c.y, d.y) && std::max(c.y, d.y) >= std::min(a.y, b.y);
}

/// Whether the closed segments a-b and c-d have a point in common, up to round-off.
template <std::floating_point S>
[[nodiscard]] bool segments_meet(Point<S> a, Point<S> b, Point<S> c, Point<S> d) noexcept {
    if (!boxes_meet(a, b, c, d)) return false;
    const auto on_both_sides = [](Point<S> from, Point<S> to, Point<S> p, Point<S> q) {
        const S side_p = cross(to - from, p - from);
        const S side_q = cross(to - from, q - from);
        return !((side_p > 0 && side_q > 0) || (side_p < 0 && side_q < 0));
    };
    return on_both_sides(a, b, c, d) && on_both_sides(c, d, a, b);
}

/// Whether a-b-c turns back on itself.
template <std::floating_point S>
[[nodiscard]] bool folds_back(Point<S> a, Point<S> b, Point<S> c) noexcept {
    return cross(b - a, c - b) == 0 && dot(b - a, c - b) < 0;
}

} // namespace detail

/// `name` is what messages call the polygon. O(n²).
/// @throws std::invalid_argument where there are less than three vertices, one is not finite,
/// neighbours coincide, or edges touch that should not.
template <std::floating_point S>
void check_simple_polygon(const std::string& name, std::span<const Point<S>> vertices) {
    const std::size_t n = vertices.size();
    if (n < 3) check::fail(name + ".vertices", static_cast<S>(n), "", "at least 3 points");
    for (std::size_t i = 0; i < n; ++i) {
        const std::string vertex = name + ".vertices[" + std::to_string(i) + "]";
        if (!std::isfinite(vertices[i].x)) check::fail(vertex + ".x", vertices[i].x, "m", "finite");
        if (!std::isfinite(vertices[i].y)) check::fail(vertex + ".y", vertices[i].y, "m", "finite");
    }
    for (std::size_t i = 0; i < n; ++i) {
        if (vertices[i] == vertices[(i + 1) % n]) {
            check::fail(name + ".edges[" + std::to_string(i) + "]", S(0), "m", "longer than 0");
        }
    }
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t k = i + 1; k < n; ++k) {
            const Point<S> a = vertices[i];
            const Point<S> b = vertices[(i + 1) % n];
            const Point<S> c = vertices[k];
            const Point<S> d = vertices[(k + 1) % n];
            bool touch = false;
            if (k == i + 1) {
                touch = detail::folds_back(a, b, d);
            } else if (i == 0 && k == n - 1) {
                touch = detail::folds_back(c, a, b);
            } else {
                touch = detail::segments_meet(a, b, c, d);
            }
            if (touch) {
                throw std::invalid_argument(name + ".vertices = edges " + std::to_string(i) + " and " +
                                            std::to_string(k) +
                                            " touching: must be a simple polygon");
            }
        }
    }
}

} // namespace ductile
