// SPDX-License-Identifier: MIT
//
// The blow of the Charpy test (problem P17 of tests/reference): numbers, contact geometry and
// expected values of examples/charpy, which begins when the nose is 20 mm from the specimen.
#pragma once

#include <Eigen/Geometry>

#include "charpy/reference.hpp"
#include "charpy/scenario.hpp"
#include "scenes/scene.hpp"

namespace bench {

struct CharpyParameters {
    charpy::Scenario scenario = {};
    double after = 0.008; ///< duration from first contact on [s]
};

namespace detail {

inline void add_specimen(Scene& scene, const charpy::Scenario& s) {
    const double length = s.length / s.parts;
    const double mass = s.specimen_mass() / s.parts;
    const Vector square = Vector(s.height, s.width, length).cwiseAbs2();
    const double y = charpy::Scenario::specimen_bottom + s.width / 2;
    for (int i = 0; i < s.parts; ++i) {
        const double z = -s.length / 2 + (i + 0.5) * length;
        scene.bodies.push_back({.mass = mass,
                                .inertia = mass / 12 * (Vector::Constant(square.sum()) - square),
                                .start = {.position = {s.height / 2, y, z}},
                                .weightless = true,
                                .radius = std::hypot(s.height, s.width, length) / 2});
        if (i == 0) continue;
        const bool notched = i == s.parts / 2;
        scene.joints.push_back({.a = i,
                                .b = i + 1,
                                .anchor = {s.height / 2, y, z - length / 2},
                                .axis = Vector::UnitY(),
                                .strength = notched ? s.notched_moment() : s.full_moment(),
                                .limit = s.max_plastic_rotation});
    }
}

inline void add_contacts(Scene& scene, const charpy::Scenario& s, const Vector& nose) {
    const Vector half = Vector(s.height, s.width, s.length / s.parts) / 2;
    const double y = charpy::Scenario::specimen_bottom + s.width / 2;
    const auto against = [half](const charpy::Edge& edge, double side) {
        return [=](const BodyState& striker, const BodyState& part, double margin) {
            return charpy::touch({striker.point(edge.from), striker.point(edge.to)},
                                 {part.position, part.rotation, half, side}, margin);
        };
    };
    const double thickness = s.height;
    const auto approach = [nose, thickness](const BodyState& hammer, const BodyState& part) {
        const Vector tip = hammer.point(nose);
        return Approach{tip.x() - part.position.x() - thickness / 2,
                        part.velocity.x() - hammer.velocity_at(tip).x()};
    };
    for (int part = 1; part <= s.parts; ++part) {
        for (const double side : {-1.0, 1.0}) {
            const Vector up(0, s.hammer_height / 2, 0);
            const Vector at = nose + Vector(0, 0, side * s.nose_width / 2);
            scene.contacts.push_back({.a = 0,
                                      .b = part,
                                      .thickness = thickness,
                                      .touch = against({at - up, at + up}, 1),
                                      .approach = approach});
            const Vector high(0, 2.5 * s.width, 0);
            const Vector anvil(0, y, side * s.anvil_gap / 2);
            scene.contacts.push_back({.a = ground,
                                      .b = part,
                                      .thickness = thickness,
                                      .touch = against({anvil - high, anvil + high}, -1)});
        }
    }
}

} // namespace detail

[[nodiscard]] inline Scene charpy_blow(const CharpyParameters& p = {}) {
    const charpy::Scenario& s = p.scenario;
    const charpy::Reference expected = charpy::reference(s);
    const double centre = s.hammer_centre(), mass = s.total_hammer_mass();
    const double angle = s.angle_before_strike(); // small: the nose's way is straight
    const double spin = s.spin_before_strike();

    Scene scene;
    scene.name = "charpy";
    scene.source = "P17";
    scene.gravity = {0, -s.gravity, 0};
    scene.contact_compliance = 1e-7; // 10 kN yield at 1 mm/s
    scene.duration = charpy::Scenario::approach / expected.strike_speed + p.after;

    const Vector pivot(s.pivot_x(), s.pivot_y(), 0);
    const Rotation raised = Eigen::AngleAxisd(angle, Vector::UnitZ()).toRotationMatrix();
    const Vector arm = raised * Vector(0, -centre, 0);
    const Vector turning(0, 0, spin);
    const double about_centre = s.hammer_inertia() - mass * centre * centre;
    scene.bodies = {{.mass = mass,
                     .inertia = Vector::Constant(about_centre),
                     .start = {.position = pivot + arm,
                               .rotation = raised,
                               .velocity = turning.cross(arm),
                               .spin = turning}}};
    scene.guides = {{.body = 0, .anchor = pivot}};
    detail::add_specimen(scene, s);
    const Vector nose(-s.hammer_width / 2 - s.nose_length, centre - charpy::Scenario::swing_radius,
                      0);
    detail::add_contacts(scene, s, nose);

    const BodySpec hammer = scene.bodies[0];
    const double start = kinetic(hammer, hammer.start) + potential(scene, hammer, hammer.start);
    const std::size_t middle = std::size_t(s.parts / 2 - 1);
    const Vector gravity = scene.gravity;
    scene.quantities = {{"hammer_loss", expected.hammer_loss,
                         [=](const Observation& o) {
                             const double now = kinetic(hammer, o.bodies[0]) -
                                                hammer.mass * gravity.dot(o.bodies[0].position);
                             return start - now;
                         }},
                        absorbed_energy(expected.plastic_work),
                        {"rotation", expected.rotation,
                         [middle](const Observation& o) { return std::abs(o.travel[middle]); }}};
    return scene;
}

} // namespace bench
