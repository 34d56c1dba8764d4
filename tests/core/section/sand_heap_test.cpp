// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>
#include <span>

#include "core/section/shapes.hpp"
#include "ductile/section/box.hpp"
#include "ductile/section/sand_heap.hpp"
#include "support/property.hpp"

using namespace ductile;
using namespace ductile::test;

namespace {

double heap(const Outline<double>& outline) {
    return sand_heap_volume(std::span<const Point<double>>(outline));
}

/// The integral is exact but for roundings.
constexpr double round_off = 1e-11;

Outline<double> any_triangle() {
    const auto coordinate = [] { return *rc::gen::inRange(0, 1000) * 1e-3; };
    const Outline<double> t{
        {coordinate(), coordinate()}, {coordinate(), coordinate()}, {coordinate(), coordinate()}};
    RC_PRE(std::abs(cross(t[1] - t[0], t[2] - t[0])) > 1e-3);
    return t;
}

} // namespace

TEST_CASE("the sand heap on a polygon with an inscribed circle is a pyramid", "[section]") {
    // V = A r/3; a regular polygon of inscribed radius 1 has area n tan(π/n)
    for (const std::size_t corners : {3u, 4u, 5u, 6u, 7u, 12u, 50u}) {
        const double n = static_cast<double>(corners);
        CHECK(heap(regular(corners)) ==
              Approx(n * std::tan(std::numbers::pi / n) / 3).epsilon(round_off));
    }
    test::prop("any triangle", [] {
        const auto t = any_triangle();
        double perimeter = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const auto edge = t[(i + 1) % 3] - t[i];
            perimeter += std::hypot(edge.x, edge.y);
        }
        const double area = std::abs(cross(t[1] - t[0], t[2] - t[0])) / 2;
        const double expected = area * (2 * area / perimeter) / 3;
        RC_ASSERT(std::abs(heap(t) - expected) < 1e-10 * expected);
    });
}

TEST_CASE("the search along an edge survives a tie of two obstacles where it starts", "[section]") {
    // The first obstacle rises with u, the second falls, and they tie exactly at the golden
    // section, where the search looks first and takes the first of them.
    struct Tied {
        double at;
        double first() const { return 0; }
        double last() const { return 1; }
        std::size_t count() const { return 2; }
        detail::Stop<double> stop(std::size_t k) const {
            return {.c0 = k == 0 ? 0 : 2 * at, .c1 = k == 0 ? 1.0 : -1.0, .c2 = 0};
        }
        bool holds(std::size_t, const detail::Stop<double>&, double) const { return true; }
        double volume(const detail::Stop<double>& stop, double a, double b) const {
            return (b - a) * stop((a + b) / 2);
        }
    };
    const double golden = 0.381966011250105152;
    const double expected =
        golden * golden / 2 + 2 * golden * (1 - golden) - (1 - golden * golden) / 2;
    CHECK(detail::heap_volume(Tied{golden}, 0.0, 1.0) == Approx(expected).epsilon(1e-14));
}

TEST_CASE("the sand heap on an L is two hipped roofs and their corner", "[section]") {
    // Two straight legs of length a - t, each a roof t²/4 per length less t³/24 at the hip of its
    // free end, and the square they share, where the height is the least of the distances to the
    // two outer sides and to the re-entrant corner. Over the square cells of 1/2000 are good to
    // 1e-7.
    const double t = 1;
    const double a = 4;
    const Outline<double> outline{{0, 0}, {a, 0}, {a, t}, {t, t}, {t, a}, {0, a}};
    const double straight = (a - t) * t * t / 4 - t * t * t / 24;
    const Outline<double> square{{0, 0}, {t, 0}, {t, t}, {0, t}};
    const double corner = over_cells(square, 2000, [&](Point<double> q) {
        return std::min({q.x, q.y, std::hypot(t - q.x, t - q.y)});
    });
    CHECK(heap(outline) == Approx(2 * straight + corner).epsilon(1e-7));
}

TEST_CASE("the sand heap on a polygon with many reflex corners is that of its cells", "[section]") {
    // midpoint cells on a continuous integrand: second order in the cell
    for (const std::size_t corners : {5u, 8u, 13u, 30u}) {
        const auto outline = star(corners, static_cast<unsigned>(corners));
        CHECK(heap(outline) == Approx(heap_by_cells(outline, 400)).epsilon(5e-6));
    }
    const Outline<double> comb{{0, 0},   {7, 0},   {7, 3}, {6, 3}, {6, 1}, {5, 1},
                               {5, 2.5}, {3, 2.5}, {3, 1}, {2, 1}, {2, 4}, {0, 4}};
    CHECK(heap(comb) == Approx(heap_by_cells(comb, 700)).epsilon(5e-5));
}

TEST_CASE("the sand heap does not depend on place, turn, orientation or first vertex",
          "[section]") {
    test::prop("", [] {
        const auto outline = star(static_cast<std::size_t>(*rc::gen::inRange(3, 25)),
                                  *rc::gen::arbitrary<unsigned>());
        const double volume = heap(outline);
        RC_ASSERT(volume > 0);
        const double angle = *rc::gen::inRange(-314, 315) * 1e-2;
        const auto same = [&](const Outline<double>& other) {
            return std::abs(heap(other) - volume) < round_off * volume;
        };
        RC_ASSERT(same(turned(outline, angle)));
        RC_ASSERT(same(moved(outline, {3, -2})));
        RC_ASSERT(same(reversed(outline)));
        auto rotated = outline;
        std::rotate(rotated.begin(), rotated.begin() + 1, rotated.end());
        RC_ASSERT(same(rotated));
        RC_ASSERT(std::abs(heap(scaled(outline, 1e-3)) - 1e-9 * volume) <
                  round_off * 1e-9 * volume);
    });
}

TEST_CASE("a vertex along an edge does not change the sand heap", "[section]") {
    test::prop("", [] {
        const auto outline = turned(star(9, *rc::gen::arbitrary<unsigned>()), 0.7);
        Outline<double> halved;
        for (std::size_t i = 0; i < outline.size(); ++i) {
            halved.push_back(outline[i]);
            halved.push_back(0.5 * (outline[i] + outline[(i + 1) % outline.size()]));
        }
        const double volume = heap(outline);
        RC_ASSERT(std::abs(heap(halved) - volume) < 1e-9 * volume);
    });
}

TEST_CASE("a slit opens the sand heap", "[section]") {
    // a square with a slit of width 2e-6 to its middle: the limit is that of the slit as a line
    const double slit = 1e-6;
    const Outline<double> outline{{0, 0},          {1, 0},     {1, 1},         {0, 1},
                                  {0, 0.5 + slit}, {0.5, 0.5}, {0, 0.5 - slit}};
    const Outline<double> square{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    const double cells = over_cells(square, 1000, [&](Point<double> q) {
        return std::min(distance_to_outline(q, square),
                        distance_to_segment(q, {0, 0.5}, {0.5, 0.5}));
    });
    CHECK(heap(outline) == Approx(cells).epsilon(1e-5));
}

TEST_CASE("the plastic torque of a box is that of the heap with a flat top over its hole",
          "[section]") {
    // The heap is the least of the distance to the outer boundary and the plateau t plus the
    // distance to the hole; t is the thinner wall.
    const auto by_cells = [](double b, double h, double tw, double tf) {
        const Outline<double> outer{{0, 0}, {b, 0}, {b, h}, {0, h}};
        return 2 * over_cells(outer, 1200, [&](Point<double> q) {
                   const double ax = std::max({tw - q.x, q.x - (b - tw), 0.0});
                   const double ay = std::max({tf - q.y, q.y - (h - tf), 0.0});
                   return std::min(distance_to_outline(q, outer),
                                   std::min(tw, tf) + std::hypot(ax, ay));
               });
    };
    const auto closed = [](double b, double h, double tw, double tf) {
        return Box<double>({.width = b, .height = h, .web_thickness = tw, .flange_thickness = tf})
            .plastic_torsion_modulus();
    };
    // thin webs, thin flanges, equal, and a hole narrower than the ridge is wide
    const double sizes[][4] = {{1, 2, 0.1, 0.3},
                               {1, 2, 0.3, 0.1},
                               {1, 2, 0.2, 0.2},
                               {0.5, 2, 0.1, 0.9},
                               {2, 0.6, 0.9, 0.05}};
    for (const auto& s : sizes) {
        CHECK(closed(s[0], s[1], s[2], s[3]) ==
              Approx(by_cells(s[0], s[1], s[2], s[3])).epsilon(1e-5));
    }
}
