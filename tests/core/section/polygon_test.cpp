// SPDX-License-Identifier: MIT
//
// Polygons: the same as the named sections of the same outline, the same wherever they lie and
// however they are turned.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include "core/section/shapes.hpp"
#include "ductile/section/channel.hpp"
#include "ductile/section/i_section.hpp"
#include "ductile/section/l_section.hpp"
#include "ductile/section/principal.hpp"
#include "ductile/section/rectangle.hpp"
#include "ductile/section/t_section.hpp"
#include "support/property.hpp"
#include "support/throws.hpp"

using namespace ductile;
using namespace ductile::test;

namespace {

constexpr auto x = SectionAxis::x;
constexpr auto y = SectionAxis::y;

/// Relative, of two ways to the same number with some thousand roundings.
constexpr double round_off = 1e-11;

bool close(double a, double b, double scale, double tolerance = round_off) {
    return std::abs(a - b) <= tolerance * scale;
}

/// A length between 1 mm and 1 m.
double any_length() { return *rc::gen::inRange(1, 1000) * 1e-3; }
/// A fraction in (0, 1).
double any_fraction() { return *rc::gen::inRange(1, 100) * 1e-2; }
Outline<double> any_star() {
    return star(static_cast<std::size_t>(*rc::gen::inRange(3, 20)),
                *rc::gen::arbitrary<unsigned>());
}
double any_angle() { return *rc::gen::inRange(-314, 315) * 1e-2; }

/// All but shear and elastic torsion, which a polygon takes as solid.
template <class T>
void agrees_with_its_outline(const T& section) {
    const auto polygon = polygon_of(section);
    const double size =
        std::max({section.highest(x), section.highest(y), -section.lowest(x), -section.lowest(y)});
    RC_ASSERT(close(polygon.area(), section.area(), section.area()));
    RC_ASSERT(std::hypot(polygon.centroid().x, polygon.centroid().y) < round_off * size);
    for (const SectionAxis axis : {x, y}) {
        RC_ASSERT(close(polygon.second_moment(axis), section.second_moment(axis),
                        section.second_moment(axis)));
        RC_ASSERT(close(polygon.elastic_modulus(axis), section.elastic_modulus(axis),
                        section.elastic_modulus(axis)));
        RC_ASSERT(close(polygon.plastic_modulus(axis), section.plastic_modulus(axis),
                        section.plastic_modulus(axis)));
        RC_ASSERT(close(polygon.lowest(axis), section.lowest(axis), size));
        RC_ASSERT(close(polygon.highest(axis), section.highest(axis), size));
        const double height = section.lowest(axis) +
                              std::numbers::inv_pi * (section.highest(axis) - section.lowest(axis));
        RC_ASSERT(close(polygon.width_at(height, axis), section.width_at(height, axis), size));
    }
    RC_ASSERT(close(polygon.product_of_inertia(), section.product_of_inertia(),
                    section.second_moment(x) + section.second_moment(y)));
    RC_ASSERT(close(polygon.plastic_torsion_modulus(), section.plastic_torsion_modulus(),
                    section.plastic_torsion_modulus()));
}

std::string message_for(std::vector<Point<double>> vertices) {
    return message_of([&] { Polygon<double>({.vertices = std::move(vertices)}); });
}

} // namespace

TEST_CASE("a polygon has the properties of the named section with its outline", "[section]") {
    test::prop("rectangle", [] {
        const Rectangle<double> section({.width = any_length(), .height = any_length()});
        agrees_with_its_outline(section);
        const auto polygon = polygon_of(section);
        RC_ASSERT(close(polygon.shear_area(x), section.shear_area(x), section.area()));
        RC_ASSERT(
            close(polygon.elastic_shear_area(x), section.elastic_shear_area(x), section.area()));
    });
    test::prop("I", [] {
        const double b = any_length();
        const double h = any_length();
        agrees_with_its_outline(ISection<double>({.width = b,
                                                  .height = h,
                                                  .web_thickness = b * any_fraction(),
                                                  .flange_thickness = h / 2 * any_fraction()}));
    });
    test::prop("T", [] {
        const double b = any_length();
        const double h = any_length();
        agrees_with_its_outline(TSection<double>({.width = b,
                                                  .height = h,
                                                  .web_thickness = b * any_fraction(),
                                                  .flange_thickness = h * any_fraction()}));
    });
    test::prop("L", [] {
        const double b = any_length();
        const double h = any_length();
        agrees_with_its_outline(LSection<double>(
            {.width = b, .height = h, .thickness = std::min(b, h) * any_fraction()}));
    });
    test::prop("channel", [] {
        const double b = any_length();
        const double h = any_length();
        agrees_with_its_outline(Channel<double>({.width = b,
                                                 .height = h,
                                                 .web_thickness = b * any_fraction(),
                                                 .flange_thickness = h / 2 * any_fraction()}));
    });
}

TEST_CASE("the plastic torsion of a flat outline keeps its digits", "[section]") {
    // 261 × 1 mm: parabolas around vertices that are 100 radii away from an edge's end
    const auto torsion = [](auto width) {
        using S = decltype(width);
        return ISection<S>({.width = width,
                            .height = S(0.001),
                            .web_thickness = width * S(0.23),
                            .flange_thickness = S(0.0002)})
            .plastic_torsion_modulus();
    };
    const long double reference = torsion(0.261L);
    CHECK(double(torsion(0.261) / reference - 1) == Approx(0).margin(round_off));
}

TEST_CASE("a polygon is the same wherever it lies and in either orientation", "[section]") {
    test::prop("", [] {
        const auto outline = any_star();
        const Point<double> by{*rc::gen::inRange(-10, 10) * 1.0, *rc::gen::inRange(-10, 10) * 1.0};
        const Polygon<double> here({.vertices = outline});
        const Polygon<double> there({.vertices = reversed(moved(outline, by))});
        RC_ASSERT(there.area() > 0);
        RC_ASSERT(close(here.area(), there.area(), 1));
        RC_ASSERT(close(there.centroid().x - here.centroid().x, by.x, 1));
        RC_ASSERT(close(there.centroid().y - here.centroid().y, by.y, 1));
        for (const SectionAxis axis : {x, y}) {
            RC_ASSERT(close(here.second_moment(axis), there.second_moment(axis), 1));
            RC_ASSERT(close(here.elastic_modulus(axis), there.elastic_modulus(axis), 1));
            RC_ASSERT(close(here.plastic_modulus(axis), there.plastic_modulus(axis), 1));
            RC_ASSERT(close(here.equal_area_height(axis), there.equal_area_height(axis), 1));
        }
        RC_ASSERT(close(here.product_of_inertia(), there.product_of_inertia(), 1));
        RC_ASSERT(close(here.plastic_torsion_modulus(), there.plastic_torsion_modulus(), 1));
    });
}

TEST_CASE("a quarter turn of a polygon swaps its axes", "[section]") {
    test::prop("", [] {
        const auto outline = any_star();
        Outline<double> quarter;
        for (const auto& p : outline) quarter.push_back({-p.y, p.x});
        const Polygon<double> here({.vertices = outline});
        const Polygon<double> there({.vertices = quarter});
        RC_ASSERT(close(here.second_moment(x), there.second_moment(y), 1));
        RC_ASSERT(close(here.second_moment(y), there.second_moment(x), 1));
        RC_ASSERT(close(here.product_of_inertia(), -there.product_of_inertia(), 1));
        RC_ASSERT(close(here.plastic_modulus(x), there.plastic_modulus(y), 1));
        RC_ASSERT(close(here.plastic_modulus(y), there.plastic_modulus(x), 1));
        RC_ASSERT(close(here.elastic_modulus(x), there.elastic_modulus(y), 1));
        // what was up is now at the left
        RC_ASSERT(close(here.highest(x), -there.lowest(y), 1));
        RC_ASSERT(close(here.equal_area_height(x), -there.equal_area_height(y), 1));
        const double height = here.highest(x) * 0.37;
        RC_ASSERT(close(here.width_at(height, x), there.width_at(-height, y), 1));
    });
}

TEST_CASE("bending about an axis at an angle is bending of the polygon turned back", "[section]") {
    test::prop("", [] {
        const auto outline = any_star();
        const double angle = any_angle();
        const Polygon<double> here({.vertices = outline});
        const Polygon<double> turned_back({.vertices = turned(outline, -angle)});
        const auto one = here.plastic_bending(angle);
        const auto other = turned_back.plastic_bending(0);
        RC_ASSERT(close(one.modulus, other.modulus, 1));
        RC_ASSERT(close(one.companion, other.companion, 1));
        RC_ASSERT(close(one.height, other.height, 1));
        RC_ASSERT(close(here.plastic_torsion_modulus(), turned_back.plastic_torsion_modulus(), 1));
        RC_ASSERT(close(here.second_moment(x) + here.second_moment(y),
                        turned_back.second_moment(x) + turned_back.second_moment(y), 1));
        const auto principal = principal_axes(here);
        const auto turned_principal = principal_axes(turned_back);
        RC_ASSERT(close(principal.major, turned_principal.major, 1));
        RC_ASSERT(close(principal.minor, turned_principal.minor, 1));
        // about its principal axes a section has no product of inertia
        const Polygon<double> straight({.vertices = turned(outline, -principal.angle)});
        RC_ASSERT(close(straight.product_of_inertia(), 0, 1));
        RC_ASSERT(close(straight.second_moment(x), principal.major, 1));
        RC_ASSERT(close(straight.second_moment(y), principal.minor, 1));
    });
}

TEST_CASE("the width of a polygon at its flat top and bottom is that of the edge there",
          "[section]") {
    const LSection<double> angle({.width = 0.3, .height = 0.2, .thickness = 0.01});
    const auto polygon = polygon_of(angle);
    CHECK(polygon.width_at(polygon.highest()) == Approx(0.01).epsilon(1e-12));
    CHECK(polygon.width_at(polygon.lowest()) == Approx(0.3).epsilon(1e-12));
    CHECK(polygon.width_at(polygon.highest(y), y) == Approx(0.01).epsilon(1e-12));
    CHECK(polygon.width_at(polygon.lowest(y), y) == Approx(0.2).epsilon(1e-12));
    CHECK(angle.width_at(angle.highest()) == 0.01);
    CHECK(angle.width_at(angle.lowest()) == 0.3);
}

TEST_CASE("the moments of a polygon are those of its cells", "[section]") {
    const auto outline = star(13, 3);
    const Polygon<double> polygon({.vertices = outline});
    const Point<double> centroid = polygon.centroid();
    const auto bending = polygon.plastic_bending(0.3);
    const auto sum = [&](auto density) {
        return over_cells(outline, 700, [&](Point<double> q) {
            return is_inside(q, outline) ? density(q - centroid) : 0.0;
        });
    };
    // cells of 1/350 that the boundary cuts: a relative error of about 1e-4
    const double tolerance = 5e-4;
    CHECK(polygon.area() == Approx(sum([](auto) { return 1.0; })).epsilon(tolerance));
    CHECK(polygon.second_moment(x) ==
          Approx(sum([](auto p) { return p.y * p.y; })).epsilon(tolerance));
    CHECK(polygon.second_moment(y) ==
          Approx(sum([](auto p) { return p.x * p.x; })).epsilon(tolerance));
    CHECK(polygon.product_of_inertia() == Approx(sum([](auto p) {
                                              return p.x * p.y;
                                          })).margin(tolerance * polygon.second_moment(x)));
    const auto height = [&](Point<double> p) {
        return std::cos(0.3) * p.y - std::sin(0.3) * p.x - bending.height;
    };
    CHECK(sum([&](auto p) { return height(p) > 0 ? 1.0 : -1.0; }) ==
          Approx(0).margin(2 * tolerance * polygon.area()));
    CHECK(bending.modulus ==
          Approx(sum([&](auto p) { return std::abs(height(p)); })).epsilon(tolerance));
    CHECK(bending.companion == Approx(sum([&](auto p) {
                                   const double u = std::cos(0.3) * p.x + std::sin(0.3) * p.y;
                                   return height(p) > 0 ? u : -u;
                               })).margin(2 * tolerance * bending.modulus));
}

TEST_CASE("a polygon in single precision far from the origin keeps its accuracy", "[section]") {
    // 4 m away coordinates are known to 2.4e-7 m: 1e-5 of the thickness, twice for its cube
    const auto outline =
        outline_of(LSection<float>({.width = 0.1f, .height = 0.1f, .thickness = 0.02f}));
    const Polygon<float> here({.vertices = outline});
    const Polygon<float> there({.vertices = moved(outline, {4.0f, -4.0f})});
    CHECK(there.area() == Approx(here.area()).epsilon(5e-5));
    CHECK(there.second_moment() == Approx(here.second_moment()).epsilon(5e-5));
    CHECK(there.plastic_modulus() == Approx(here.plastic_modulus()).epsilon(5e-5));
    CHECK(there.plastic_torsion_modulus() == Approx(here.plastic_torsion_modulus()).epsilon(5e-5));
}

TEST_CASE("St Venant's estimate of J is near the truth for compact polygons", "[section]") {
    const double square = Polygon<double>({.vertices = regular(4)}).torsion_constant();
    CHECK(square / (0.140577 * 16) == Approx(1.067).epsilon(1e-3));
    const double circle = Polygon<double>({.vertices = regular(200)}).torsion_constant();
    CHECK(circle / (std::numbers::pi / 2) == Approx(0.987).epsilon(1e-3));
    const double side = 2 * std::sqrt(3.0); // of the triangle with inscribed radius 1
    const double triangle = Polygon<double>({.vertices = regular(3)}).torsion_constant();
    CHECK(triangle / (std::sqrt(3.0) / 80 * std::pow(side, 4)) == Approx(1.125).epsilon(1e-3));
}

TEST_CASE("a polygon says what is wrong with its vertices", "[section]") {
    CHECK(message_for({}) == "Polygon.vertices = 0: must be at least 3 points");
    CHECK(message_for({{0, 0}, {1, 0}}) == "Polygon.vertices = 2: must be at least 3 points");
    CHECK(message_for({{0, 0}, {1, 0}, {std::numeric_limits<double>::quiet_NaN(), 0}}) ==
          "Polygon.vertices[2].x = nan m: must be finite");
    CHECK(message_for({{0, 0}, {1, std::numeric_limits<double>::infinity()}, {0, 1}}) ==
          "Polygon.vertices[1].y = inf m: must be finite");
    CHECK(message_for({{0, 0}, {1, 0}, {1, 0}, {0, 1}}) ==
          "Polygon.edges[1] = 0 m: must be longer than 0");
    CHECK(message_for({{0, 0}, {1, 0}, {0, 1}, {0, 0}}) ==
          "Polygon.edges[3] = 0 m: must be longer than 0");
    // bow tie
    CHECK(message_for({{0, 0}, {1, 1}, {1, 0}, {0, 1}}) ==
          "Polygon.vertices = edges 0 and 2 touching: must be a simple polygon");
    // a vertex on another edge
    CHECK(message_for({{0, 0}, {2, 0}, {2, 2}, {1, 0}, {0, 2}}) ==
          "Polygon.vertices = edges 0 and 2 touching: must be a simple polygon");
    // a spike that folds back, and a flat triangle
    CHECK(message_for({{0, 0}, {2, 0}, {1, 0}, {1, 1}}) ==
          "Polygon.vertices = edges 0 and 1 touching: must be a simple polygon");
    CHECK(message_for({{0, 0}, {1, 0}, {2, 0}}) ==
          "Polygon.vertices = edges 0 and 2 touching: must be a simple polygon");
    CHECK(message_for({{1, 0}, {2, 0}, {0, 0}}) ==
          "Polygon.vertices = edges 0 and 1 touching: must be a simple polygon");
    CHECK(message_for({{0, 0}, {1, 0}, {2, 1e-16}}) ==
          "Polygon.area = 5e-17 m^2: must be > 0 beyond round-off");
    // vertices along an edge are fine
    CHECK(message_for({{0, 0}, {1, 0}, {2, 0}, {2, 1}, {0, 1}}) == "nothing thrown");
}
