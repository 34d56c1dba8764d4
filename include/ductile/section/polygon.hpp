// SPDX-License-Identifier: MIT
//
// Any section whose boundary is one simple polygon, given by its vertices in either orientation and
// any place. All of bending is exact to round-off, from sums over the edges:
//
//   A = ½ Σ p × q,  ∫ v dA = Σ ½ (p × q)(p_v + q_v)/3,  I_x = Σ ½ (p × q)(p_y² + p_y q_y + q_y²)/6
//
// for edges from p to q, and over the clipped edges for the part above a line; cutting lines add
// nothing where the origin lies on them. The height that halves the area lies between two vertices,
// where the width is linear and the area quadratic.
//
// W_T is the sand heap (sand_heap.hpp). Shear and elastic torsion are those of a solid section:
// A_v = A, A_s = 5/6 A, and J = A⁴/(40 (I_x + I_y)), St Venant's estimate (Roark, Formulas for Stress
// and Strain, ch. 10): 1 % low for a circle, 7 % high for a square, 13 % for an equilateral triangle.
// None of the three is meant for thin-walled shapes: take the section of that name.
//
// Source: C. Steger (1996), On the calculation of arbitrary moments of polygons, TU München FGBV-96-05.
//
// Symbols
//   θ    angle of a bending axis from x, counterclockwise       [rad]
//   u, v coordinates along and across that axis, from centroid  [m]
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "ductile/section/plane_cut.hpp"
#include "ductile/section/point.hpp"
#include "ductile/section/sand_heap.hpp"
#include "ductile/section/section.hpp"
#include "ductile/section/simple_polygon.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile {

template <std::floating_point S>
struct PolygonParameters {
    std::vector<Point<S>> vertices = {}; ///< at least three [m]; the last joins the first
};

/// Immutable; all members but the constructor and copies are noexcept and allocate nothing.
template <std::floating_point S>
class Polygon {
  public:
    using Scalar = S;

    /// O(n²).
    /// @throws std::invalid_argument where the vertices do not make a simple polygon of some area.
    explicit Polygon(PolygonParameters<S> parameters) : vertices_(std::move(parameters.vertices)) {
        check_simple_polygon<S>("Polygon", vertices_);
        move_to_centroid();
        vertices_.shrink_to_fit();
        second_moment_x_ = second_moment_of(&Point<W>::y, &Point<W>::y);
        second_moment_y_ = second_moment_of(&Point<W>::x, &Point<W>::x);
        product_ = second_moment_of(&Point<W>::x, &Point<W>::y);
        bending_x_ = plastic_bending_in(frame(SectionAxis::x));
        bending_y_ = plastic_bending_in(frame(SectionAxis::y));
        plastic_torsion_modulus_ = 2 * sand_heap_volume(vertices());
    }

    /// Counterclockwise, the centroid at the origin [m].
    [[nodiscard]] std::span<const Point<S>> vertices() const noexcept { return vertices_; }
    /// Centroid in the coordinates the polygon was given in [m].
    [[nodiscard]] Point<S> centroid() const noexcept { return centroid_; }

    [[nodiscard]] S area() const noexcept { return area_; }
    [[nodiscard]] S second_moment(SectionAxis axis = SectionAxis::x) const noexcept {
        return axis == SectionAxis::x ? second_moment_x_ : second_moment_y_;
    }
    [[nodiscard]] S product_of_inertia() const noexcept { return product_; }
    [[nodiscard]] S elastic_modulus(SectionAxis axis = SectionAxis::x) const noexcept {
        return second_moment(axis) / std::max(-lowest(axis), highest(axis));
    }
    [[nodiscard]] S plastic_modulus(SectionAxis axis = SectionAxis::x) const noexcept {
        return bending(axis).modulus;
    }
    /// Height of the plastic neutral axis parallel to `axis` from the centroid [m].
    [[nodiscard]] S equal_area_height(SectionAxis axis = SectionAxis::x) const noexcept {
        return bending(axis).height;
    }
    /// Fully plastic bending with the neutral axis at `angle` from x [rad]. O(n) to O(n²).
    [[nodiscard]] PlasticBending<S> plastic_bending(S angle) const noexcept {
        return plastic_bending_in({.cosine = std::cos(angle), .sine = std::sin(angle)});
    }

    [[nodiscard]] S shear_area(SectionAxis) const noexcept { return area_; }
    [[nodiscard]] S elastic_shear_area(SectionAxis) const noexcept { return 5 * area_ / 6; }
    [[nodiscard]] S torsion_constant() const noexcept {
        return area_ * area_ / (40 * (second_moment_x_ + second_moment_y_)) * area_ * area_;
    }
    [[nodiscard]] S plastic_torsion_modulus() const noexcept { return plastic_torsion_modulus_; }

    /// O(n).
    [[nodiscard]] S width_at(S height, SectionAxis axis = SectionAxis::x) const noexcept {
        return detail::chord(vertices(), frame(axis), height);
    }
    [[nodiscard]] S lowest(SectionAxis axis = SectionAxis::x) const noexcept {
        return axis == SectionAxis::x ? low_.y : low_.x;
    }
    [[nodiscard]] S highest(SectionAxis axis = SectionAxis::x) const noexcept {
        return axis == SectionAxis::x ? high_.y : high_.x;
    }

  private:
    using W = std::conditional_t<(sizeof(S) < sizeof(double)), double, S>;

    /// Heights are y about x, and x about y.
    static detail::Frame<S> frame(SectionAxis axis) noexcept {
        return axis == SectionAxis::x ? detail::Frame<S>{.cosine = 1, .sine = 0}
                                      : detail::Frame<S>{.cosine = 0, .sine = -1};
    }
    [[nodiscard]] const PlasticBending<S>& bending(SectionAxis axis) const noexcept {
        return axis == SectionAxis::x ? bending_x_ : bending_y_;
    }
    [[nodiscard]] PlasticBending<S> plastic_bending_in(detail::Frame<S> frame) const noexcept {
        return detail::plastic_bending(vertices(), area_, frame);
    }

    /// Sets area, centroid and extent; leaves the vertices counterclockwise around the centroid.
    void move_to_centroid() {
        const Point<W> origin = wide(vertices_[0]);
        W twice_area = 0;
        Point<W> moment{0, 0};
        Point<W> low{0, 0};
        Point<W> high{0, 0};
        for (std::size_t i = 0; i < vertices_.size(); ++i) {
            const Point<W> p = wide(vertices_[i]) - origin;
            const Point<W> q = wide(vertices_[(i + 1) % vertices_.size()]) - origin;
            twice_area += cross(p, q);
            moment = moment + cross(p, q) / 6 * (p + q);
            low = {std::min(low.x, p.x), std::min(low.y, p.y)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y)};
        }
        const W diameter = std::hypot(high.x - low.x, high.y - low.y);
        const W round_off = 64 * W(std::numeric_limits<S>::epsilon()) * diameter * diameter;
        area_ = static_cast<S>(std::abs(twice_area) / 2);
        if (!(std::abs(twice_area) / 2 > round_off)) {
            check::fail("Polygon.area", area_, "m^2", "> 0 beyond round-off");
        }
        const Point<W> centroid = 2 / twice_area * moment;
        for (Point<S>& vertex : vertices_) vertex = narrow(wide(vertex) - origin - centroid);
        if (twice_area < 0) std::reverse(vertices_.begin(), vertices_.end());
        centroid_ = narrow(centroid + origin);
        low_ = narrow(low - centroid);
        high_ = narrow(high - centroid);
    }

    /// ∫ a b dA for coordinates a and b.
    [[nodiscard]] S second_moment_of(W Point<W>::*a, W Point<W>::*b) const noexcept {
        W sum = 0;
        for (std::size_t i = 0; i < vertices_.size(); ++i) {
            const Point<W> p = wide(vertices_[i]);
            const Point<W> q = wide(vertices_[(i + 1) % vertices_.size()]);
            sum += cross(p, q) * (p.*a * (2 * p.*b + q.*b) + q.*a * (2 * q.*b + p.*b));
        }
        return static_cast<S>(sum / 24);
    }

    static Point<W> wide(Point<S> p) noexcept { return {W(p.x), W(p.y)}; }
    static Point<S> narrow(Point<W> p) noexcept { return {static_cast<S>(p.x), static_cast<S>(p.y)}; }

    std::vector<Point<S>> vertices_;
    Point<S> centroid_{};
    Point<S> low_{};
    Point<S> high_{};
    S area_ = 0;
    S second_moment_x_ = 0;
    S second_moment_y_ = 0;
    S product_ = 0;
    PlasticBending<S> bending_x_{};
    PlasticBending<S> bending_y_{};
    S plastic_torsion_modulus_ = 0;
};

template <std::floating_point S>
Polygon(PolygonParameters<S>) -> Polygon<S>;

static_assert(FullSection<Polygon<double>> && FullSection<Polygon<float>>);

} // namespace ductile
