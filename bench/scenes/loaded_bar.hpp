// SPDX-License-Identifier: MIT
//
// A moving mass on a yielding bar that a constant force below the bar's strength keeps pulling
// (problem P22 of tests/reference with an initial speed): it comes to a stop and must then hold
// still under load.
//
//   a = (R - F)/m,   travel = v₀²/(2 a),   t = v₀/a,   E = R travel,   valid for F < R
#pragma once

#include <algorithm>

#include "scenes/scene.hpp"

namespace bench {

struct LoadedBarParameters {
    double mass = 100;          ///< m [kg]
    double speed = 10;          ///< v₀ [m/s]
    double area = 1e-4;         ///< of the bar [m²]
    double yield_stress = 50e6; ///< [Pa]; R = area × yield stress
    double load = 4000;         ///< F [N]
    double rest = 0.1;          ///< duration after the stop, at least [s]
};

/// Time from the start to the stop [s].
[[nodiscard]] inline double stop_time(const LoadedBarParameters& p) {
    return p.speed * p.mass / (p.area * p.yield_stress - p.load);
}

[[nodiscard]] inline Scene loaded_bar(const LoadedBarParameters& p = {}) {
    const double strength = p.area * p.yield_stress;
    const double stop = stop_time(p);
    const double travel = p.speed * stop / 2;
    Scene scene;
    scene.name = "loaded-bar";
    scene.source = "P22 with an initial speed";
    scene.bodies = {{.mass = p.mass,
                     .inertia = Vector::Constant(p.mass),
                     .start = {.velocity = {0, p.speed, 0}},
                     .force = {0, p.load, 0}}};
    scene.joints = {
        {.a = 0, .motion = Motion::slides, .axis = Vector::UnitY(), .strength = strength}};
    scene.duration = stop + p.rest;
    scene.quantities = {{"travel", travel, [](const Observation& o) { return o.travel[0]; }},
                        absorbed_energy(strength * travel)};
    return scene;
}

} // namespace bench
