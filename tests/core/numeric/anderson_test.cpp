// SPDX-License-Identifier: MIT
#include "ductile/numeric/anderson.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstddef>
#include <vector>

using ductile::numeric::Anderson;

namespace {

/// Steps until x <- G(x) is within `least` of `fixed`, 100 at most.
template <class Map>
int steps(Anderson& anderson, std::vector<double> x, const std::vector<double>& fixed,
          const Map& map, double least) {
    for (int step = 0; step < 100; ++step) {
        double off = 0;
        for (std::size_t i = 0; i < x.size(); ++i) off = std::max(off, std::abs(x[i] - fixed[i]));
        if (off <= least) return step;
        anderson.advance(x, map(x));
    }
    return 100;
}

} // namespace

TEST_CASE("Anderson: an affine map is done after as many steps as it has directions") {
    // x' = s (x - 1) + 1 by component: alone it takes 2,300 steps to 1e-10
    const auto map = [](const std::vector<double>& x) {
        const std::vector<double> shrinks{0.99, 0.9, -0.7, 0.99};
        std::vector<double> image(x.size());
        for (std::size_t i = 0; i < x.size(); ++i) image[i] = shrinks[i] * (x[i] - 1) + 1;
        return image;
    };
    Anderson anderson;
    const std::vector<double> ones(4, 1.0);
    CHECK(steps(anderson, {0, 0, 0, 0}, ones, map, 1e-10) <= 5); // three directions
    anderson.restart();
    CHECK(steps(anderson, {5, -3, 2, 8}, ones, map, 1e-9) <= 5);
}

TEST_CASE("Anderson: after a restart what was before is forgotten") {
    const auto to = [](double fixed) {
        return [fixed](const std::vector<double>& x) {
            return std::vector<double>{0.9 * (x[0] - fixed) + fixed};
        };
    };
    Anderson anderson, fresh;
    steps(anderson, {0}, {1}, to(1), 1e-12);
    anderson.restart();
    std::vector<double> x{3}, y{3};
    for (int i = 0; i < 3; ++i) {
        anderson.advance(x, to(-2)(x));
        fresh.advance(y, to(-2)(y));
        CHECK(x[0] == y[0]);
    }
    CHECK(x[0] == Approx(-2).margin(1e-12));
}

TEST_CASE("Anderson: another length is another problem; one that stands stays") {
    Anderson anderson;
    std::vector<double> x{1, 2};
    anderson.advance(x, {2, 3});
    anderson.advance(x, {2.5, 3.5});
    std::vector<double> y{1, 2, 3};
    anderson.advance(y, {4, 5, 6});
    CHECK(y == std::vector<double>{4, 5, 6});
    for (int i = 0; i < 8; ++i) anderson.advance(y, std::vector<double>(y)); // differences are none
    CHECK(y == std::vector<double>{4, 5, 6});
}
