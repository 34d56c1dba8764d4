// SPDX-License-Identifier: MIT
//
// One contract for every section, about both axes: the width at every height must add up to the area,
// the centroid and the moments that the section claims; and properties scale as powers of length.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "core/section/shapes.hpp"
#include "ductile/section/box.hpp"
#include "ductile/section/channel.hpp"
#include "ductile/section/circle.hpp"
#include "ductile/section/i_section.hpp"
#include "ductile/section/l_section.hpp"
#include "ductile/section/notched_rectangle.hpp"
#include "ductile/section/principal.hpp"
#include "ductile/section/rectangle.hpp"
#include "ductile/section/t_section.hpp"
#include "ductile/section/tube.hpp"

using namespace ductile;
using namespace ductile::test;

namespace {

/// Calls `use` with one section of every kind, `size` times a size of about 1.
template <class S, class Use>
void for_every_section(S size, Use use) {
    use(Rectangle<S>({.width = size * S(0.3), .height = size * S(0.7)}));
    use(NotchedRectangle<S>(
        {.width = size * S(0.7), .height = size * S(0.4), .notch = size * S(0.1)}));
    use(Circle<S>({.radius = size * S(0.5)}));
    use(Tube<S>({.outer_radius = size * S(0.5), .inner_radius = size * S(0.35)}));
    use(Box<S>({.width = size * S(0.6),
                .height = size * S(0.9),
                .web_thickness = size * S(0.05),
                .flange_thickness = size * S(0.08)}));
    use(ISection<S>({.width = size * S(0.5),
                     .height = size * S(0.9),
                     .web_thickness = size * S(0.07),
                     .flange_thickness = size * S(0.11)}));
    use(TSection<S>({.width = size * S(0.8),
                     .height = size * S(0.6),
                     .web_thickness = size * S(0.09),
                     .flange_thickness = size * S(0.12)}));
    use(LSection<S>({.width = size * S(0.5), .height = size * S(0.9), .thickness = size * S(0.1)}));
    use(Channel<S>({.width = size * S(0.4),
                    .height = size * S(0.9),
                    .web_thickness = size * S(0.06),
                    .flange_thickness = size * S(0.1)}));
    Outline<S> outline;
    for (const Point<double>& p : star(11, 5)) {
        outline.push_back({size * static_cast<S>(p.x), size * static_cast<S>(p.y)});
    }
    use(Polygon<S>({.vertices = outline}));
}

} // namespace

TEMPLATE_TEST_CASE("the width of every section adds up to its area, centroid and moments",
                   "[section]", float, double) {
    using S = TestType;
    for_every_section<S>(1, [](const auto& section) {
        for (const SectionAxis axis : {SectionAxis::x, SectionAxis::y}) {
            const double low = section.lowest(axis);
            const double high = section.highest(axis);
            REQUIRE(low < 0);
            REQUIRE(high > 0);
            // Midpoints of 20000 layers miss at most one layer at each jump of the width.
            constexpr int layers = 20000;
            constexpr double tolerance = 5e-4;
            const double step = (high - low) / layers;
            double area = 0;
            double moment = 0;
            double second_moment = 0;
            for (int i = 0; i < layers; ++i) {
                const double height = low + (i + 0.5) * step;
                const double slice = step * section.width_at(static_cast<S>(height), axis);
                area += slice;
                moment += slice * height;
                second_moment += slice * height * height;
            }
            CHECK(section.area() == Approx(area).epsilon(tolerance));
            CHECK(std::abs(moment) < tolerance * area * (high - low));
            CHECK(section.second_moment(axis) == Approx(second_moment).epsilon(tolerance));
            CHECK(section.elastic_modulus(axis) ==
                  Approx(second_moment / std::max(high, -low)).epsilon(tolerance));
            // equal-area axis, then the first moment about it
            double below = 0;
            double axis_height = low;
            while (below < area / 2) {
                below += step * section.width_at(static_cast<S>(axis_height + step / 2), axis);
                axis_height += step;
            }
            double plastic = 0;
            for (int i = 0; i < layers; ++i) {
                const double height = low + (i + 0.5) * step;
                plastic += step * section.width_at(static_cast<S>(height), axis) *
                           std::abs(height - axis_height);
            }
            CHECK(section.plastic_modulus(axis) == Approx(plastic).epsilon(tolerance));
            // shape factor
            CHECK(section.plastic_modulus(axis) > section.elastic_modulus(axis));
            CHECK(section.shear_area(axis) > 0);
            CHECK(section.shear_area(axis) <= section.area());
            CHECK(section.elastic_shear_area(axis) <= section.shear_area(axis));
        }
        CHECK(section.torsion_constant() > 0);
        CHECK(section.plastic_torsion_modulus() > 0);
    });
}

TEMPLATE_TEST_CASE("the width of every section is 0 outside", "[section]", float, double) {
    using S = TestType;
    for_every_section<S>(1, [](const auto& section) {
        for (const SectionAxis axis : {SectionAxis::x, SectionAxis::y}) {
            const S high = section.highest(axis);
            const S low = section.lowest(axis);
            CHECK(section.width_at(high + S(1e-3), axis) == 0);
            CHECK(section.width_at(low - S(1e-3), axis) == 0);
            CHECK(section.width_at(std::numeric_limits<S>::infinity(), axis) == 0);
            CHECK(section.width_at(high, axis) >= 0);
            CHECK(section.width_at(low, axis) >= 0);
        }
        CHECK(section.width_at(S(0.01)) == section.width_at(S(0.01), SectionAxis::x));
        CHECK(section.lowest() == section.lowest(SectionAxis::x));
        CHECK(section.highest() == section.highest(SectionAxis::x));
    });
}

TEMPLATE_TEST_CASE("properties of every section scale as powers of length", "[section]", float,
                   double) {
    using S = TestType;
    // a power of two: scaling changes no digit, but for roundings where sizes are multiplied out
    const S factor = S(0.125);
    constexpr double tolerance = 64 * std::numeric_limits<S>::epsilon();
    std::vector<std::vector<double>> properties[2];
    for (const int index : {0, 1}) {
        for_every_section<S>(index == 0 ? S(1) : factor, [&](const auto& s) {
            std::vector<double> values;
            const double length = index == 0 ? 1 : factor;
            const auto add = [&](double value, int power) {
                values.push_back(value / std::pow(length, power));
            };
            for (const SectionAxis axis : {SectionAxis::x, SectionAxis::y}) {
                add(s.highest(axis), 1);
                add(s.shear_area(axis), 2);
                add(s.elastic_shear_area(axis), 2);
                add(s.elastic_modulus(axis), 3);
                add(s.plastic_modulus(axis), 3);
                add(s.second_moment(axis), 4);
            }
            add(s.area(), 2);
            add(s.plastic_torsion_modulus(), 3);
            add(s.torsion_constant(), 4);
            add(s.product_of_inertia(), 4);
            properties[index].push_back(values);
        });
    }
    for (std::size_t i = 0; i < properties[0].size(); ++i) {
        for (std::size_t k = 0; k < properties[0][i].size(); ++k) {
            CHECK(properties[0][i][k] == Approx(properties[1][i][k]).epsilon(tolerance));
        }
    }
}

TEST_CASE("only an L and an irregular polygon have a product of inertia", "[section]") {
    int unsymmetric = 0;
    for_every_section<double>(1, [&](const auto& section) {
        if (section.product_of_inertia() != 0) ++unsymmetric;
    });
    CHECK(unsymmetric == 2);
}

TEST_CASE("principal axes of a symmetric section are x and y", "[section]") {
    const auto wide = principal_axes(Rectangle<double>({.width = 2, .height = 1}));
    CHECK(wide.angle == Approx(std::numbers::pi / 2)); // strong about y
    CHECK(wide.major == Approx(8.0 / 12));
    CHECK(wide.minor == Approx(2.0 / 12));
    CHECK(principal_axes(Rectangle<double>({.width = 1, .height = 2})).angle == 0);
    CHECK(principal_axes(Circle<double>({.radius = 1})).angle == 0);
}

TEST_CASE("a type that cannot say its width is no full section", "[section]") {
    struct Bending {
        using Scalar = double;
        double area() const { return 1; }
        double second_moment() const { return 1; }
        double elastic_modulus() const { return 1; }
        double plastic_modulus() const { return 1; }
    };
    STATIC_REQUIRE(Section<Bending>);
    STATIC_REQUIRE_FALSE(BiaxialSection<Bending>);
    STATIC_REQUIRE_FALSE(ShearSection<Bending>);
    STATIC_REQUIRE_FALSE(SectionWidth<Bending>);
    STATIC_REQUIRE_FALSE(FullSection<Bending>);
    STATIC_REQUIRE_FALSE(Section<int>);
}
