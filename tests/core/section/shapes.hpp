// SPDX-License-Identifier: MIT
//
// Outlines for the tests of sections, and what the tests measure them with.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "ductile/section/polygon.hpp"

namespace ductile::test {

template <class S>
using Outline = std::vector<Point<S>>;

template <class T>
Outline<typename T::Scalar> outline_of(const T& section) {
    const auto corners = section.outline();
    return {corners.begin(), corners.end()};
}

template <class T>
Polygon<typename T::Scalar> polygon_of(const T& section) {
    return Polygon<typename T::Scalar>({.vertices = outline_of(section)});
}

template <class S>
Outline<S> turned(Outline<S> outline, S angle) {
    for (Point<S>& p : outline) {
        p = {std::cos(angle) * p.x - std::sin(angle) * p.y,
             std::sin(angle) * p.x + std::cos(angle) * p.y};
    }
    return outline;
}

template <class S>
Outline<S> moved(Outline<S> outline, Point<S> by) {
    for (Point<S>& p : outline) p = p + by;
    return outline;
}

template <class S>
Outline<S> scaled(Outline<S> outline, S factor) {
    for (Point<S>& p : outline) p = factor * p;
    return outline;
}

template <class S>
Outline<S> reversed(Outline<S> outline) {
    std::reverse(outline.begin(), outline.end());
    return outline;
}

/// Regular polygon with inscribed radius 1.
inline Outline<double> regular(std::size_t corners) {
    Outline<double> outline;
    const double step = 2 * std::numbers::pi / static_cast<double>(corners);
    for (std::size_t i = 0; i < corners; ++i) {
        const double angle = step * static_cast<double>(i);
        const double radius = 1 / std::cos(step / 2);
        outline.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    }
    return outline;
}

/// Spiky, never convex for many corners, always simple.
inline Outline<double> star(std::size_t corners, unsigned seed) {
    std::mt19937 generator(seed);
    Outline<double> outline;
    for (std::size_t i = 0; i < corners; ++i) {
        const double angle =
            2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(corners);
        const double radius = 0.2 + 0.8 * static_cast<double>(generator()) / 4294967296.0;
        outline.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    }
    return outline;
}

inline double distance_to_segment(Point<double> q, Point<double> a, Point<double> b) {
    const Point<double> e = b - a;
    const double along = std::clamp(dot(q - a, e) / dot(e, e), 0.0, 1.0);
    const Point<double> r = q - (a + along * e);
    return std::hypot(r.x, r.y);
}

inline double distance_to_outline(Point<double> q, const Outline<double>& outline) {
    double distance = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < outline.size(); ++i) {
        distance = std::min(
            distance, distance_to_segment(q, outline[i], outline[(i + 1) % outline.size()]));
    }
    return distance;
}

inline bool is_inside(Point<double> q, const Outline<double>& outline) {
    bool inside = false;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const Point<double> a = outline[i];
        const Point<double> b = outline[(i + 1) % outline.size()];
        if ((a.y > q.y) != (b.y > q.y) && q.x < (b.x - a.x) * (q.y - a.y) / (b.y - a.y) + a.x) {
            inside = !inside;
        }
    }
    return inside;
}

/// ∫ f dA over the outline's bounding box by midpoints of n × n cells.
template <class F>
double over_cells(const Outline<double>& outline, int n, F f) {
    Point<double> low = outline[0];
    Point<double> high = outline[0];
    for (const Point<double>& p : outline) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    const Point<double> cell{(high.x - low.x) / n, (high.y - low.y) / n};
    double sum = 0;
    for (int i = 0; i < n; ++i) {
        for (int k = 0; k < n; ++k) {
            sum += f(Point<double>{low.x + (i + 0.5) * cell.x, low.y + (k + 0.5) * cell.y});
        }
    }
    return sum * cell.x * cell.y;
}

/// The sand heap by brute force.
inline double heap_by_cells(const Outline<double>& outline, int n) {
    return over_cells(outline, n, [&](Point<double> q) {
        return is_inside(q, outline) ? distance_to_outline(q, outline) : 0.0;
    });
}

} // namespace ductile::test
