// SPDX-License-Identifier: MIT
//
// A mass dropped on the head of a crushing column (problem P25a of tests/reference), through an
// inelastic contact.
//
//   V₀ = √(2 g H),   V₁ = V₀ m/(m + m_h),   a = R/(m + m_h) - g,   crush = V₁²/(2 a),   E = R crush
#pragma once

#include "scenes/scene.hpp"

namespace bench {

struct DroppedMassParameters {
    double mass = 500;      ///< m [kg]
    double head = 50;       ///< m_h [kg]
    double height = 2;      ///< H [m]
    double strength = 30e3; ///< R [N]
    double gravity = 9.81;  ///< g [m/s²]
};

[[nodiscard]] inline Scene dropped_mass(const DroppedMassParameters& p = {}) {
    constexpr double touching = 0.5; // distance of the centres at contact [m]
    const double total = p.mass + p.head;
    const double common = std::sqrt(2 * p.gravity * p.height) * p.mass / total;
    const double deceleration = p.strength / total - p.gravity;
    const double crush = common * common / (2 * deceleration);
    Scene scene;
    scene.name = "dropped-mass";
    scene.source = "P25 a";
    scene.gravity = {0, -p.gravity, 0};
    scene.bodies = {{.mass = p.head, .inertia = Vector::Constant(p.head / 10)},
                    {.mass = p.mass,
                     .inertia = Vector::Constant(p.mass / 10),
                     .start = {.position = {0, touching + p.height, 0}}}};
    scene.joints = {
        {.a = 0, .motion = Motion::slides, .axis = Vector::UnitY(), .strength = p.strength}};
    scene.contacts = {{.a = 1,
                       .b = 0,
                       .thickness = touching,
                       .touch =
                           [](const BodyState& top, const BodyState& head, double margin) {
                               charpy::EdgeContact contact;
                               const double gap = top.position.y() - head.position.y() - touching;
                               if (gap > margin) return contact;
                               contact.count = 1;
                               contact.points[0] = {top.position - Vector(0, touching / 2, 0),
                                                    Vector::UnitY(), gap};
                               return contact;
                           },
                       .approach =
                           [](const BodyState& top, const BodyState& head) {
                               return Approach{top.position.y() - head.position.y() - touching,
                                               head.velocity.y() - top.velocity.y()};
                           }}};
    scene.duration = std::sqrt(2 * p.height / p.gravity) + 2 * common / deceleration;
    scene.quantities = {{"crush", crush, [](const Observation& o) { return -o.travel[0]; }},
                        absorbed_energy(p.strength * crush)};
    return scene;
}

} // namespace bench
