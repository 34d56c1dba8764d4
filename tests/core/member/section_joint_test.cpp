// SPDX-License-Identifier: MIT
#include "ductile/member/section_joint.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

#include "ductile/material/named.hpp"
#include "ductile/section/rectangle.hpp"
#include "ductile/surface/rectangle_axial_bending.hpp"
#include "support/throws.hpp"

using namespace ductile;
using ductile::test::message_of;

namespace {

// 20 mm wide, 30 mm high, S355
const Rectangle<double> bar({.width = 0.02, .height = 0.03});
const Material<double> steel(s355<double>());
constexpr double plastic = 355e6 * 0.02 * 0.03 * 0.03 / 4; // M_p about x [N m]

} // namespace

TEST_CASE("a hinge of a section is as strong as its plastic modulus", "[member]") {
    CHECK(section_hinge(bar, steel).strength() == Approx(plastic));
    CHECK(section_hinge(bar, steel, {}, SectionAxis::y).strength() == Approx(plastic * 2 / 3));
    CHECK(std::isinf(section_hinge(bar, steel).parameters().stiffness));
    const auto elastic = section_hinge(bar, steel, {.length = 0.1, .elastic = true});
    CHECK(elastic.parameters().stiffness == Approx(210e9 * 0.02 * std::pow(0.03, 3) / 12 / 0.1));
    CHECK(section_hinge(bar, steel, {.largest_rotation = 0.3}).criterion().limit() == 0.3);
}

TEST_CASE("a joint of a section flows at each capacity alone and counts life as rotation",
          "[member]") {
    const auto joint = section_joint(bar, steel, {.length = 0.1});
    const auto of = joint_capacity(bar, steel, {.length = 0.1});
    for (int i = 0; i < 6; ++i) {
        const Eigen::Matrix<double, 6, 1> force =
            Eigen::Matrix<double, 6, 1>::Unit(i) * of.capacity[std::size_t(i)];
        CHECK(joint.surface().value(force) == Approx(1));
        CHECK(std::isinf(joint.parameters().stiffness[i]));
    }
    CHECK(joint.law().value(0) == Approx(plastic));
    const auto elastic = section_joint(bar, steel, {.length = 0.1, .elastic = true});
    for (int i = 0; i < 6; ++i) {
        CHECK(elastic.parameters().stiffness[i] == Approx(of.stiffness[std::size_t(i)]));
    }
}

TEST_CASE("under axial force and bending the ellipsoid is at most 2/√3 stronger than a rectangle",
          "[member]") {
    const auto joint = section_joint(bar, steel, {.length = 0.1});
    const auto of = joint_capacity(bar, steel, {.length = 0.1});
    const RectangleAxialBending<double> exact;
    double worst = 0;
    for (int i = 1; i < 1000; ++i) {
        const double angle = i * std::acos(0.0) / 1000;
        const Eigen::Vector2d n_m(std::sin(angle), std::cos(angle));
        Eigen::Matrix<double, 6, 1> force = Eigen::Matrix<double, 6, 1>::Zero();
        force[2] = n_m.x() * of.capacity[2];
        force[3] = n_m.y() * of.capacity[3];
        CHECK(joint.surface().value(force) == Approx(1));
        worst = std::max(worst, exact.value(n_m));
        CHECK(exact.value(n_m) >= 1 - 1e-9);
    }
    CHECK(worst == Approx(2 / std::sqrt(3.0)).epsilon(1e-4));
}

TEST_CASE("a joint of a section names what is missing", "[member]") {
    CHECK(message_of([] {
              (void)section_joint(bar, steel, {});
          }).starts_with("Capacity.length = nan"));
    CHECK(message_of([] {
              (void)section_hinge(bar, steel, {.elastic = true});
          }).starts_with("SectionHinge.length = nan"));
    CHECK(message_of([] {
              (void)section_hinge(bar, steel, {.largest_rotation = -1});
          }).starts_with("TravelLimit.limit = -1"));
}
