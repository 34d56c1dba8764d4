// SPDX-License-Identifier: MIT
//
// Largest disks that touch the boundary of a simple polygon from inside at a given point: the radii
// that sand_heap.hpp integrates, where they are derived. Not for direct use.
//
// Symbols
//   u  place along an edge (its length), or tan(φ/2) at a reflex vertex
//   h  radius of the disk
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <span>

#include "ductile/section/point.hpp"

namespace ductile {

namespace detail {

/// How far a disk may grow before one obstacle stops it, as c0 + c1 t + c2 t² to be minimised,
/// t = u - centre, and where along u the obstacle may begin or cease to count.
template <class W>
struct Stop {
    static constexpr W nowhere = std::numeric_limits<W>::infinity();

    W c0 = nowhere;
    W c1 = 0;
    W c2 = 0;
    W centre = 0;
    std::array<W, 3> ends{nowhere, nowhere, nowhere};

    [[nodiscard]] W operator()(W u) const noexcept {
        return c0 + (u - centre) * (c1 + (u - centre) * c2);
    }
    [[nodiscard]] W slope(W u) const noexcept { return c1 + 2 * c2 * (u - centre); }
};

/// 1 - a·b of unit vectors, also where they are nearly the same.
template <class W>
[[nodiscard]] W one_minus_dot(Point<W> a, Point<W> b) noexcept {
    return dot(a - b, a - b) / 2;
}

/// The outline, scaled to size 1 and counterclockwise, so that tolerances are plain numbers.
template <class W, std::floating_point S>
class UnitOutline {
  public:
    explicit UnitOutline(std::span<const Point<S>> vertices) noexcept : vertices_(vertices) {
        W twice_area = 0;
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            const Point<W> p = raw(i);
            size_ = std::max({size_, std::abs(p.x), std::abs(p.y)});
            twice_area += cross(p, raw(i + 1));
        }
        clockwise_ = twice_area < 0;
    }

    [[nodiscard]] std::size_t count() const noexcept { return vertices_.size(); }
    [[nodiscard]] W size() const noexcept { return size_; }

    /// Vertex i, in counterclockwise order, modulo the number of vertices.
    [[nodiscard]] Point<W> operator[](std::size_t i) const noexcept {
        const std::size_t index = i % count();
        return 1 / size_ * raw(clockwise_ ? count() - 1 - index : index);
    }

  private:
    [[nodiscard]] Point<W> raw(std::size_t i) const noexcept {
        const Point<S> p = vertices_[i % count()];
        return {W(p.x) - W(vertices_[0].x), W(p.y) - W(vertices_[0].y)};
    }

    std::span<const Point<S>> vertices_;
    W size_ = 0;
    bool clockwise_ = false;
};

/// Edge i of an outline: from vertex i to vertex i + 1, the section to its left.
template <class W>
struct Edge {
    Point<W> from;
    W length;
    Point<W> along;  ///< unit
    Point<W> inward; ///< unit

    template <class Outline>
    Edge(const Outline& outline, std::size_t i) noexcept : from(outline[i]) {
        const Point<W> span = outline[i + 1] - from;
        length = std::hypot(span.x, span.y);
        along = 1 / length * span;
        inward = {-along.y, along.x};
    }
};

/// Disks that touch one edge, over the length along it.
template <class W, class Outline>
class EdgeDisks {
  public:
    EdgeDisks(const Outline& outline, std::size_t edge) noexcept
        : outline_(outline), index_(edge), edge_(outline, edge) {}

    [[nodiscard]] W first() const noexcept { return 0; }
    [[nodiscard]] W last() const noexcept { return edge_.length; }
    [[nodiscard]] std::size_t count() const noexcept { return 2 * outline_.count(); }

    [[nodiscard]] Stop<W> stop(std::size_t k) const noexcept {
        const std::size_t n = outline_.count();
        return k < n ? by_edge(k) : by_vertex(k - n);
    }

    /// Volume between u = a and b where `stop` holds: exact, its integrand has degree 4.
    [[nodiscard]] W volume(const Stop<W>& stop, W a, W b) const noexcept {
        const W node = (b - a) / 2 * std::sqrt(W(0.6));
        const W middle = (a + b) / 2;
        const auto half_square = [&](W u) { return stop(u) * stop(u) / 2; };
        return (b - a) / 18 *
               (5 * half_square(middle - node) + 8 * half_square(middle) +
                5 * half_square(middle + node));
    }

    /// Whether obstacle k is touched within its edge, by a disk of positive radius.
    [[nodiscard]] bool holds(std::size_t k, const Stop<W>& stop, W u) const noexcept {
        const W radius = stop(u);
        if (!(radius > 0) || !(radius < Stop<W>::nowhere)) return false;
        if (k >= outline_.count()) return true;
        const Edge<W> other(outline_, k);
        const Point<W> centre = edge_.from + u * edge_.along + radius * edge_.inward;
        const W place = dot(other.along, centre - other.from);
        return place > -epsilon && place < other.length + epsilon;
    }

  private:
    [[nodiscard]] Stop<W> by_vertex(std::size_t k) const noexcept {
        const Point<W> offset = outline_[k] - edge_.from;
        const W height = dot(edge_.inward, offset);
        const bool own = k == index_ || k == (index_ + 1) % outline_.count();
        if (own || !(height > epsilon)) return {};
        return {.c0 = height / 2, .c2 = 1 / (2 * height), .centre = dot(edge_.along, offset)};
    }

    [[nodiscard]] Stop<W> by_edge(std::size_t k) const noexcept {
        if (k == index_) return {};
        const Edge<W> other(outline_, k);
        const W opening = one_minus_dot(other.inward, edge_.inward);
        if (!(opening > epsilon)) return {};
        const Point<W> offset = edge_.from - other.from;
        // Radius and place of touching are linear in s: t = t0 + t1 s, w = w0 + w1 s.
        const W t0 = dot(other.inward, offset) / opening;
        const W t1 = dot(other.inward, edge_.along) / opening;
        const W lean = dot(other.along, edge_.inward);
        const W w0 = dot(other.along, offset) + t0 * lean;
        const W w1 = dot(other.along, edge_.along) + t1 * lean;
        Stop<W> stop{.c0 = t0, .c1 = t1, .c2 = 0};
        stop.ends = {-t0 / t1, -w0 / w1, (other.length - w0) / w1};
        return stop;
    }

    static constexpr W epsilon = 64 * std::numeric_limits<W>::epsilon();

    const Outline& outline_;
    std::size_t index_;
    Edge<W> edge_;
};

/// Disks that touch one reflex vertex, over u = tan(φ/2), φ from the bisector of its two normals.
template <class W, class Outline>
class VertexDisks {
  public:
    VertexDisks(const Outline& outline, std::size_t vertex) noexcept
        : outline_(outline), index_(vertex), at_(outline[vertex]) {
        const Edge<W> before(outline, vertex + outline.count() - 1);
        const Edge<W> after(outline, vertex);
        const W turn = std::atan2(-cross(before.along, after.along), dot(before.along, after.along));
        last_ = std::tan(std::max(turn, W(0)) / 4);
        // Either difference may vanish, their sum does not.
        const Point<W> bisector = before.inward + after.inward + (before.along - after.along);
        bisector_ = 1 / std::hypot(bisector.x, bisector.y) * bisector;
        left_ = {-bisector_.y, bisector_.x};
    }

    [[nodiscard]] W first() const noexcept { return -last_; }
    [[nodiscard]] W last() const noexcept { return last_; }
    [[nodiscard]] std::size_t count() const noexcept { return 2 * outline_.count(); }

    /// Minimises -(1 + u²)/h.
    [[nodiscard]] Stop<W> stop(std::size_t k) const noexcept {
        const std::size_t n = outline_.count();
        return k < n ? by_edge(k) : by_vertex(k - n);
    }

    [[nodiscard]] bool holds(std::size_t k, const Stop<W>& stop, W u) const noexcept {
        const W radius = this->radius(stop, u);
        if (!(radius > 0) || !(radius < Stop<W>::nowhere)) return false;
        if (k >= outline_.count()) return true;
        const Edge<W> other(outline_, k);
        const W scale = 1 / (1 + u * u);
        const Point<W> normal = scale * ((1 - u * u) * bisector_ + 2 * u * left_);
        const W place = dot(other.along, at_ + radius * normal - other.from);
        return place > -epsilon && place < other.length + epsilon;
    }

    /// Volume between u = a and b where `stop` holds: 2/3 ∫ (1 + u²)²/Q³ du, halved until it settles.
    [[nodiscard]] W volume(const Stop<W>& stop, W a, W b) const noexcept {
        return settled(stop, a, b, gauss(stop, a, b), 24);
    }

  private:
    [[nodiscard]] W radius(const Stop<W>& stop, W u) const noexcept { return -(1 + u * u) / stop(u); }

    [[nodiscard]] Stop<W> by_vertex(std::size_t k) const noexcept {
        if (k == index_) return {};
        const Point<W> offset = outline_[k] - at_;
        const W factor = -2 / dot(offset, offset);
        const W ahead = factor * dot(bisector_, offset);
        return {.c0 = ahead, .c1 = 2 * factor * dot(left_, offset), .c2 = -ahead};
    }

    [[nodiscard]] Stop<W> by_edge(std::size_t k) const noexcept {
        const std::size_t n = outline_.count();
        if (k == index_ || (k + 1) % n == index_) return {};
        const Edge<W> other(outline_, k);
        const W height = dot(other.inward, at_ - other.from);
        if (!(height > epsilon)) return {};
        const Point<W> outward = W(-1) * other.inward;
        Stop<W> stop{.c0 = -one_minus_dot(other.inward, bisector_) / height,
                     .c1 = 2 * dot(other.inward, left_) / height,
                     .c2 = -one_minus_dot(outward, bisector_) / height};
        const auto end = [&](W place) {
            // Centre of the disk through the vertex that touches the line at `place`.
            const W reach = place - dot(other.along, at_ - other.from);
            const W radius = (height * height + reach * reach) / (2 * height);
            const Point<W> to = reach * other.along + (radius - height) * other.inward;
            return std::tan(std::atan2(dot(to, left_), dot(to, bisector_)) / 2);
        };
        stop.ends = {end(0), end(other.length), Stop<W>::nowhere};
        return stop;
    }

    [[nodiscard]] W gauss(const Stop<W>& stop, W a, W b) const noexcept {
        // Abramowitz and Stegun (1964), table 25.4, n = 8.
        constexpr std::array<W, 4> node{W(0.183434642495649805L), W(0.525532409916328986L),
                                        W(0.796666477413626740L), W(0.960289856497536232L)};
        constexpr std::array<W, 4> weight{W(0.362683783378361983L), W(0.313706645877887287L),
                                          W(0.222381034453374471L), W(0.101228536290376259L)};
        const auto density = [&](W u) {
            const W h = radius(stop, u);
            return h * h * h / (1 + u * u);
        };
        W sum = 0;
        for (std::size_t i = 0; i < node.size(); ++i) {
            const W reach = (b - a) / 2 * node[i];
            sum += weight[i] * (density((a + b) / 2 - reach) + density((a + b) / 2 + reach));
        }
        return (b - a) / 3 * sum;
    }

    [[nodiscard]] W settled(const Stop<W>& stop, W a, W b, W whole, int halvings) const noexcept {
        const W middle = (a + b) / 2;
        const W left = gauss(stop, a, middle);
        const W right = gauss(stop, middle, b);
        if (halvings == 0 || std::abs(left + right - whole) <= 1000 * epsilon * std::abs(whole)) {
            return left + right;
        }
        return settled(stop, a, middle, left, halvings - 1) +
               settled(stop, middle, b, right, halvings - 1);
    }

    static constexpr W epsilon = 64 * std::numeric_limits<W>::epsilon();

    const Outline& outline_;
    std::size_t index_;
    Point<W> at_;
    Point<W> bisector_{};
    Point<W> left_{};
    W last_ = 0;
};

} // namespace detail

} // namespace ductile
