// SPDX-License-Identifier: MIT
#include "ductile/surface/turned_box.hpp"

#include <catch2/catch.hpp>

#include <Eigen/Core>
#include <cmath>

#include "core/surface/cases.hpp"
#include "core/surface/enforced_rows.hpp"
#include "ductile/numeric/lu.hpp"
#include "ductile/surface/box_projection.hpp"

using namespace ductile;
using namespace ductile::test;

TEST_CASE("turned rows decouple, and slip along the normal", "[surface]") {
    const IAxialBending<double> surface(i_200<double>, BendingAxis::strong);
    const Eigen::Vector2d predicted{0.5, surface.moment(0.5)};
    const auto box = turned_box(surface, predicted, masses);
    const Eigen::Matrix2d inverse = numeric::inverse(box.basis);
    const Eigen::Matrix2d turned = inverse * masses * inverse.transpose();
    CHECK(std::abs(turned(0, 1)) < 1e-15 * turned(0, 0));
    // the trial was not quite where it was predicted, but within the window
    const Eigen::Vector2d trial =
        predicted + 0.02 * masses * surface.normal(predicted) + Eigen::Vector2d(-0.002, 0.003);
    const Eigen::Vector2d slip = numeric::inverse(masses) * (trial - enforce(box, trial, masses));
    const Eigen::Vector2d normal = surface.normal(predicted);
    CHECK(std::abs(slip[0] * normal[1] - slip[1] * normal[0]) < 1e-12 * slip.norm());
    CHECK(slip.dot(normal) > 0);
}
