// SPDX-License-Identifier: MIT
//
// A vehicle runs against a lamp-post that has a plastic hinge at its base.
//
// The vehicle, mass m, is guided along x and carries a bumper edge at height h. The post is a thin
// rod (its faces lie in the plane through the hinge), length L, mass m_p, I = m_p L²/3 about its
// base. While they touch, the edge is at x = h tan θ, so one degree of freedom is left:
//
//   v = h θ' / cos²θ,   T = (m h²/cos⁴θ + I) θ'²/2,   U = m_p g (L/2) cos θ
//
// First contact is perfectly inelastic; momentum about the base, with no impulse of the hinge:
//
//   θ'₀ = m v₀ h/(m h² + I),   E₁ = (m v₀ h)²/(2 (m h² + I))
//
// and all of E₁ and of what the post's weight adds goes into the hinge, at rest:
//
//   M_p θ = E₁ + m_p g (L/2)(1 - cos θ)                                                       (*)
//
// Two conditions, which `lamp_post` checks along the whole motion: the contact pushes, and the edge
// stays on the post. With W = m_p g L/2,
//
//   v' < 0  <=>  M_p > 2 I θ'² tan θ + W sin θ,   h/cos θ < L
//
// Limits: m_p → 0 gives E₁ = m v₀²/2; g = 0 gives θ = E₁/M_p.
#pragma once

#include <cmath>
#include <stdexcept>

#include "scenes/scene.hpp"

namespace bench {

struct LampPostParameters {
    double vehicle = 1000;        ///< m [kg]
    double speed = 10;            ///< v₀ [m/s]
    double bumper = 0.6;          ///< h [m]
    double post_mass = 60;        ///< m_p [kg]
    double post_length = 5;       ///< L [m]
    double plastic_moment = 25e3; ///< M_p [N m]
    double gravity = 9.81;        ///< g [m/s²]
    double approach = 0.3;        ///< way to the post at the start [m]
};

/// @throws std::invalid_argument where the closed form does not hold.
[[nodiscard]] inline Scene lamp_post(const LampPostParameters& p = {}) {
    const double post_inertia = p.post_mass * p.post_length * p.post_length / 3;
    const double both = p.vehicle * p.bumper * p.bumper + post_inertia;
    const double momentum = p.vehicle * p.speed * p.bumper;
    const double after = momentum * momentum / (2 * both);
    const double weight = p.post_mass * p.gravity * p.post_length / 2;
    // (*): M_p > W makes this a contraction
    double angle = after / p.plastic_moment;
    for (int i = 0; i < 200; ++i) {
        angle = (after + weight * (1 - std::cos(angle))) / p.plastic_moment;
    }
    double time = p.approach / p.speed;
    constexpr int pieces = 1000;
    for (int i = 0; i < pieces; ++i) {
        const double theta = angle * (i + 0.5) / pieces;
        const double moving = after + weight * (1 - std::cos(theta)) - p.plastic_moment * theta;
        const double inertia =
            p.vehicle * std::pow(p.bumper / std::pow(std::cos(theta), 2), 2) + post_inertia;
        const double rate = std::sqrt(2 * moving / inertia);
        time += angle / pieces / rate;
        const bool pushes = p.plastic_moment > 2 * post_inertia * rate * rate * std::tan(theta) +
                                                   weight * std::sin(theta);
        if (!pushes || p.bumper / std::cos(theta) > p.post_length) {
            throw std::invalid_argument("lamp_post: the vehicle leaves the post before it stops");
        }
    }

    Scene scene;
    scene.name = "lamp-post";
    scene.source = "closed form in lamp_post.hpp";
    scene.gravity = {0, -p.gravity, 0};
    const double about_centre = p.post_mass * p.post_length * p.post_length / 12;
    scene.bodies = {
        {.mass = p.vehicle,
         .inertia = Vector::Constant(p.vehicle),
         .start = {.position = {-2 - p.approach, p.bumper, 0}, .velocity = {p.speed, 0, 0}},
         .radius = 2},
        {.mass = p.post_mass,
         .inertia = Vector::Constant(about_centre),
         .start = {.position = {0, p.post_length / 2, 0}},
         .radius = p.post_length / 2}};
    scene.guides = {{.body = 0,
                     .motion = Motion::slides,
                     .anchor = {-2 - p.approach, p.bumper, 0},
                     .axis = Vector::UnitX()}};
    // leans towards +x: turns about -z
    scene.joints = {{.a = 1, .axis = -Vector::UnitZ(), .strength = p.plastic_moment}};
    const Vector edge(2, 0, 0);
    const auto gap = [edge](const BodyState& vehicle, const BodyState& post) {
        const Vector normal = -post.rotation.col(0);
        return normal.dot(vehicle.point(edge) - post.position);
    };
    scene.contacts = {
        {.a = 0,
         .b = 1,
         .thickness = 0.2,
         .touch =
             [edge, gap](const BodyState& vehicle, const BodyState& post, double margin) {
                 charpy::EdgeContact contact;
                 const double apart = gap(vehicle, post);
                 if (apart > margin) return contact;
                 contact.count = 1;
                 contact.points[0] = {vehicle.point(edge), -post.rotation.col(0), apart};
                 return contact;
             },
         .approach =
             [edge, gap](const BodyState& vehicle, const BodyState& post) {
                 const Vector at = vehicle.point(edge);
                 const Vector closing = vehicle.velocity_at(at) - post.velocity_at(at);
                 return Approach{gap(vehicle, post), closing.dot(post.rotation.col(0))};
             }}};
    scene.duration = 1.3 * time;
    scene.quantities = {{"rotation", angle, [](const Observation& o) { return o.travel[0]; }},
                        absorbed_energy(p.plastic_moment * angle)};
    return scene;
}

} // namespace bench
