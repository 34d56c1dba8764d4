// SPDX-License-Identifier: MIT
//
// A rotor on a plastic hinge that breaks in mid-motion (problem P02b of tests/reference): what
// spins on afterwards shows how much energy the joint really took.
//
//   α = M_p/I,   ω_res = √(ω₀² - 2 α θ_max),   E = M_p θ_max
#pragma once

#include <cmath>

#include "scenes/scene.hpp"

namespace bench {

struct BreakingHingeParameters {
    double inertia = 2;          ///< I [kg m²]
    double plastic_moment = 40;  ///< M_p [N m]
    double spin = 10;            ///< ω₀ [rad/s]
    double limit = 1.3;          ///< θ_max [rad]
    double stiffness = infinity; ///< [N m/rad]
};

[[nodiscard]] inline Scene breaking_hinge(const BreakingHingeParameters& p = {}) {
    const double left = p.spin * p.spin - 2 * p.plastic_moment / p.inertia * p.limit;
    const double residual = std::sqrt(std::max(left, 0.0));
    Scene scene;
    scene.name = "breaking-hinge";
    scene.source = "P02 b";
    scene.bodies = {
        {.mass = 1, .inertia = Vector::Constant(p.inertia), .start = {.spin = {0, 0, p.spin}}}};
    scene.joints = {
        {.a = 0, .strength = p.plastic_moment, .stiffness = p.stiffness, .limit = p.limit}};
    scene.duration = 2 * (p.spin - residual) * p.inertia / p.plastic_moment;
    scene.quantities = {
        {"residual_speed", residual, [](const Observation& o) { return o.bodies[0].spin.z(); }},
        absorbed_energy(p.plastic_moment * p.limit)};
    return scene;
}

} // namespace bench
