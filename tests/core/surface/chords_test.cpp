// SPDX-License-Identifier: MIT
#include "ductile/surface/chords.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <string>
#include <type_traits>

#include "core/surface/cases.hpp"
#include "support/property.hpp"

using namespace ductile;
using namespace ductile::test;

TEST_CASE("chords in closed form are those that Newton finds", "[surface]") {
    int closed = 0;
    for_every_surface<double>([&](const std::string& name, const auto& surface) {
        using T = std::decay_t<decltype(surface)>;
        using Vector = typename T::Vector;
        if constexpr (ChordedSurface<T>) {
            ++closed;
            test::prop(name, [&] {
                const auto ray = any_direction<Vector>();
                const Vector point = ray * (any_number(0.0, 1.0) / surface.value(ray));
                const auto [lower, upper] = surface.chords(point);
                for (int i = 0; i < T::dimension; ++i) {
                    const double up = point[i] + reach(surface, point, Vector(Vector::Unit(i)));
                    const double down = point[i] - reach(surface, point, Vector(-Vector::Unit(i)));
                    // where a line only touches, both have half the digits
                    const double tolerance = upper[i] - lower[i] < 1e-2 ? 1e-7 : 1e-12;
                    RC_ASSERT(std::abs(upper[i] - up) <= tolerance);
                    RC_ASSERT(std::abs(lower[i] - down) <= tolerance);
                }
            });
        }
    });
    CHECK(closed == 3); // ellipse, ellipsoid, independent axes
}

TEST_CASE("the ends of the chords take in a point that round-off put outside", "[surface]") {
    for_every_surface<float>([](const std::string& name, const auto& surface) {
        using T = std::decay_t<decltype(surface)>;
        using Vector = typename T::Vector;
        test::prop(name, [&] {
            const auto ray = any_direction<Vector>();
            const Vector point = ray * ((1 + on_surface<float>) / surface.value(ray));
            const auto [lower, upper] = chords_through(surface, point);
            for (int i = 0; i < T::dimension; ++i) {
                RC_ASSERT(lower[i] <= point[i]);
                RC_ASSERT(upper[i] >= point[i]);
            }
        });
    });
}
