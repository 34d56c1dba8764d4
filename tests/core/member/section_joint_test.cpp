// SPDX-License-Identifier: MIT
#include "ductile/member/section_joint.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ductile/material/named.hpp"
#include "ductile/section/i_section.hpp"
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
    CHECK(section_hinge(bar, steel, {.largest_bending = 0.3}).criterion().limit() == 0.3);
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
              (void)section_hinge(bar, steel, {.largest_bending = -1});
          }).starts_with("TravelLimit.limit = -1"));
    CHECK(message_of([] {
              (void)section_hinge(bar, steel, {.largest_twist = 1});
          }).starts_with("SectionHinge.largest_twist = 1"));
    CHECK(message_of([] {
              (void)section_joint(bar, steel, {.length = 0.1, .largest_twist = 0});
          }).starts_with("SectionJoint.largest_twist = 0"));
}

namespace {

/// Turns about the axis given until it breaks, against a hand or by itself; plastic rotation about it [rad].
template <class Section>
double turned(const Section& section, const Eigen::Vector3d& axis, double dt, bool driven,
              bool elastic) {
    auto joint = section_joint(
        section, steel,
        {.length = 0.1, .largest_bending = 0.3, .largest_twist = 0.8, .elastic = elastic});
    using Vector = Eigen::Matrix<double, 6, 1>;
    const double inertia = 5e4; // flies 1 rad
    Vector position = Vector::Zero(), velocity = Vector::Zero();
    velocity.tail<3>() = axis;
    for (int i = 0; i < 100000 && !joint.state().broken; ++i) {
        if (driven) velocity.tail<3>() = axis;
        const auto rows = joint.prepare({.position = position,
                                         .velocity = velocity,
                                         .mass = inertia * Eigen::Matrix<double, 6, 6>::Identity()},
                                        dt);
        Vector force;
        for (int a = 0; a < 6; ++a) {
            const auto& row = rows[std::size_t(a)];
            const double wanted = (row.bias - velocity[a]) / (1 / inertia + row.compliance);
            const double impulse = std::clamp(wanted, row.lower * dt, row.upper * dt);
            velocity[a] += impulse / inertia;
            force[a] = impulse / dt;
        }
        position += velocity * dt;
        joint.commit({.force = force, .velocity = velocity, .position = position}, dt);
    }
    CHECK(joint.state().broken);
    CHECK(joint.governing() == CriterionKind::plastic_travel);
    // plastic rotation, of all the work done at the capacity of one axis
    const auto of = joint_capacity(section, steel, {.length = 0.1});
    const double capacity = std::abs(axis.x()) * of.capacity[3] + std::abs(axis.y()) * of.capacity[4] +
                            std::abs(axis.z()) * of.capacity[5];
    return joint.state().plastic_work / capacity;
}

} // namespace

TEST_CASE("a joint of a section breaks at its largest bending, about any axis, and at its largest twist",
          "[member][break]") {
    const double dt = GENERATE(1.0 / 60, 1.0 / 1000);
    const bool driven = GENERATE(true, false), elastic = GENERATE(true, false);
    INFO("dt = 1/" << 1 / dt << (driven ? ", driven" : ", free") << (elastic ? ", elastic" : ""));
    const double exact = elastic ? 1e-2 : 1e-9; // the elastic row's slip is geometric in part
    const ISection<double> thin(
        {.width = 0.1, .height = 0.2, .web_thickness = 0.0056, .flange_thickness = 0.0085});
    CHECK(turned(bar, {1, 0, 0}, dt, driven, elastic) == Approx(0.3).epsilon(exact));
    CHECK(turned(bar, {0, -1, 0}, dt, driven, elastic) == Approx(0.3).epsilon(exact));
    CHECK(turned(bar, {0, 0, 1}, dt, driven, elastic) == Approx(0.8).epsilon(exact));
    CHECK(turned(thin, {1, 0, 0}, dt, driven, elastic) == Approx(0.3).epsilon(exact));
    CHECK(turned(thin, {0, 0, -1}, dt, driven, elastic) == Approx(0.8).epsilon(exact));
}
