// SPDX-License-Identifier: MIT
#include "ductile/frame/part_settings.hpp"

#include <catch2/catch.hpp>

namespace {

using namespace ductile;

TEST_CASE("Part settings: a spring of a frame is the same in a part of any length") {
    constexpr double frame = 1.0 / 60, stiffness = 2e3, damping = 40;
    constexpr double both = frame * stiffness + damping;
    const Softness usual{.erp = frame * stiffness / both, .compliance = 1 / both};
    for (const double h : {frame, 1e-2, 1e-3, 1e-5, 1e-7}) {
        CAPTURE(h);
        const Softness part = part_spring(usual, h, frame);
        CHECK(part.erp / (h * part.compliance) == Approx(stiffness));
        CHECK((1 - part.erp) / part.compliance == Approx(damping));
    }
}

TEST_CASE("Part settings: what is hard is not pushed back faster than rigid rows are") {
    constexpr double frame = 1.0 / 60;
    for (const double erp : {0.2, 0.99, 1.0}) {
        for (const double h : {1e-3, 1e-5, 1e-7}) {
            CAPTURE(erp, h);
            CHECK(part_spring({.erp = erp, .compliance = 0}, h, frame).erp <= h / 5e-3 * 1.0001);
        }
    }
}

} // namespace
