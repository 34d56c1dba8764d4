// SPDX-License-Identifier: MIT
//
// A mass on an elastic-perfectly plastic bar under a force that is applied at once and held
// (problem P04 of tests/reference).
//
//   u_y = R/k,   u_max = u_y/(2 (1 - F/R)),   u_p = u_max - u_y,   E = R u_p,   valid for R/2 <= F
//   < R
#pragma once

#include "scenes/scene.hpp"

namespace bench {

struct OscillatorParameters {
    double mass = 100;      ///< m [kg]
    double stiffness = 4e4; ///< k [N/m]
    double strength = 2000; ///< R [N]
    double load = 0.8;      ///< F/R, in [0.5, 1)
};

[[nodiscard]] inline Scene oscillator(const OscillatorParameters& p = {}) {
    const double yield = p.strength / p.stiffness;
    const double peak = yield / (2 * (1 - p.load));
    Scene scene;
    scene.name = "oscillator";
    scene.source = "P04";
    scene.bodies = {{.mass = p.mass,
                     .inertia = Vector::Constant(p.mass),
                     .force = {0, p.load * p.strength, 0}}};
    scene.joints = {{.a = 0,
                     .motion = Motion::slides,
                     .axis = Vector::UnitY(),
                     .strength = p.strength,
                     .stiffness = p.stiffness}};
    scene.duration = 12 / std::sqrt(p.stiffness / p.mass); // past the peak for F/R <= 0.9
    scene.quantities = {
        {"peak_travel", peak, [](const Observation& o) { return o.peak_travel[0]; }},
        absorbed_energy(p.strength * (peak - yield))};
    return scene;
}

} // namespace bench
