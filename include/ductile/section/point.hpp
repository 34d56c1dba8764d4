// SPDX-License-Identifier: MIT
//
// A point in the plane of a section, and the outlines made of them.
#pragma once

#include <concepts>
#include <limits>

namespace ductile {

template <std::floating_point S>
struct Point {
    S x = std::numeric_limits<S>::quiet_NaN(); ///< to the right [m]
    S y = std::numeric_limits<S>::quiet_NaN(); ///< up [m]

    bool operator==(const Point&) const = default;
};

/// Twice the area of the triangle 0, a, b; positive where b lies to the left of a.
template <std::floating_point S>
[[nodiscard]] constexpr S cross(Point<S> a, Point<S> b) noexcept {
    return a.x * b.y - a.y * b.x;
}

template <std::floating_point S>
[[nodiscard]] constexpr S dot(Point<S> a, Point<S> b) noexcept {
    return a.x * b.x + a.y * b.y;
}

template <std::floating_point S>
[[nodiscard]] constexpr Point<S> operator-(Point<S> a, Point<S> b) noexcept {
    return {a.x - b.x, a.y - b.y};
}

template <std::floating_point S>
[[nodiscard]] constexpr Point<S> operator+(Point<S> a, Point<S> b) noexcept {
    return {a.x + b.x, a.y + b.y};
}

template <std::floating_point S>
[[nodiscard]] constexpr Point<S> operator*(S factor, Point<S> a) noexcept {
    return {factor * a.x, factor * a.y};
}

} // namespace ductile
