// SPDX-License-Identifier: MIT
//
// What bench/stability runs: per grid a scene with a known answer and two numbers that are varied,
// one of them the step or the iterations. The same scenes and tolerances for every method.
//
// Symbols
//   x, y          the two numbers of a cell
//   motion_time   duration t of the plastic motion, or of its first phase [s]. An engine that moves
//                 with the velocity at the end of a step leaves a travel of v₀ t/2 short by
//                 v₀ dt/2: 5 % where dt = t/20. Coarser cells are wrong with exact rows in any such
//                 engine and are counted apart ("coarse").
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "engines/settings.hpp"
#include "scenes/all.hpp"
#include "scenes/loaded_bar.hpp"
#include "scenes/still_cantilever.hpp"

namespace bench::stability {

/// One cell's scene and what the classes need to know of it.
struct Trial {
    Scene scene;
    double motion_time;           ///< [s]; infinite where nothing should move
    double rest_after = infinity; ///< from then on all joints should be at rest [s]
    double rest_scale = 1;        ///< of joint travel at rest [rad | m]
    double energy_scale = 1;      ///< of the energy gained [J]
};

struct Grid {
    std::string name;
    std::string x_name; ///< "step_s" or "iterations"
    std::vector<double> x;
    std::string y_name;
    std::vector<double> y;
    std::function<Trial(double dt, double y)> trial;
    bool elastic = false; ///< methods without an elastic part have no answer to it

    [[nodiscard]] bool over_iterations() const { return x_name == "iterations"; }
};

/// So many steps are run after the motion, so that rest can be told from jitter and drift.
inline constexpr double steps_at_rest = 12;

[[nodiscard]] inline Trial charpy_trial(double, double yield_stress) {
    CharpyParameters p;
    p.scenario.yield_stress = yield_stress;
    p.after = 0.012; // the hammer at 800 MPa is slow
    Trial t{.scene = charpy_blow(p), .motion_time = 4.4e-3};
    t.energy_scale = t.scene.quantities[0].expected;
    return t;
}

[[nodiscard]] inline Trial bar_trial(double dt, double yield_stress) {
    LoadedBarParameters p{.yield_stress = yield_stress};
    p.rest = std::max(p.rest, steps_at_rest * dt);
    Trial t{.scene = loaded_bar(p), .motion_time = stop_time(p)};
    t.rest_after = t.motion_time + 2 * dt;
    t.rest_scale = t.scene.quantities[0].expected;
    t.energy_scale = p.mass * p.speed * p.speed / 2;
    return t;
}

/// A light rotor between the ground and a heavy one; first comes the rotation of the hinge that
/// stops them both.
[[nodiscard]] inline Trial rotors_trial(double dt, double ratio) {
    RotorsInSeriesParameters p;
    p.first_inertia = p.second_inertia / ratio;
    Trial t{.scene = rotors_in_series(p), .motion_time = 0};
    t.motion_time = t.scene.duration / 1.2;
    t.scene.duration = std::max(t.scene.duration, t.motion_time + steps_at_rest * dt);
    std::swap(t.scene.quantities[0], t.scene.quantities[1]);
    t.rest_after = t.motion_time + 2 * dt;
    t.rest_scale = t.scene.quantities[0].expected;
    t.energy_scale = p.second_inertia * p.spin * p.spin / 2;
    return t;
}

[[nodiscard]] inline Trial struck_trial(double dt, double segments) {
    const double stop = segments > 1 ? 0.0416 : 0.04; // P13 a, all N
    constexpr double first_phase = 6.7e-3; // t₁ of P13 a; with one segment there is one phase
    Trial t{.scene = struck_cantilever({.segments = int(segments)}),
            .motion_time = segments > 1 ? first_phase : stop};
    t.scene.duration = std::max(t.scene.duration, stop + steps_at_rest * dt);
    t.rest_after = 1.05 * stop + 2 * dt;
    t.rest_scale = 0.04;
    t.energy_scale = t.scene.quantities.back().expected;
    return t;
}

[[nodiscard]] inline Trial still_trial(double dt, double segments) {
    StillCantileverParameters p{.segments = int(segments)};
    p.duration = std::max(p.duration, steps_at_rest * dt);
    Trial t{.scene = still_cantilever(p), .motion_time = infinity, .rest_after = 2 * dt};
    t.rest_scale = free_fall(p) / p.length;
    t.energy_scale = t.scene.joints[0].strength * t.rest_scale;
    return t;
}

[[nodiscard]] inline Trial oscillator_trial(double, double stiffness) {
    const OscillatorParameters p{.stiffness = stiffness};
    const double period = std::sqrt(p.mass / stiffness);
    Trial t{.scene = oscillator(p), .motion_time = 5.7 * period}; // P04: 0.285 s at 20 rad/s
    t.energy_scale = p.load * p.strength * t.scene.quantities[0].expected;
    return t;
}

[[nodiscard]] inline std::vector<Grid> grids(bool quick) {
    using List = std::vector<double>;
    const List steps =
        quick ? List{1e-4, 1e-3, 1.0 / 60}
              : List{5e-5, 1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 1.0 / 240, 1.0 / 120, 1.0 / 60, 1.0 / 30};
    const auto either = [quick](List few, List many) { return quick ? few : many; };
    return {
        {"charpy", "step_s", steps, "yield_stress_Pa",
         either({50e6, 400e6, 800e6}, {50e6, 100e6, 200e6, 400e6, 600e6, 800e6}), charpy_trial},
        {"loaded-bar", "step_s", steps, "yield_stress_Pa",
         either({50e6, 400e6, 2e9}, {50e6, 100e6, 200e6, 400e6, 800e6, 1.4e9, 2e9}), bar_trial},
        {"oscillator", "step_s", steps, "stiffness_N_per_m",
         either({4e4, 4e6}, {4e3, 4e4, 4e5, 4e6, 4e7}), oscillator_trial, true},
        {"rotors-in-series", "step_s", steps, "mass_ratio",
         either({1, 100, 1e4}, {1, 3, 10, 30, 100, 1e3, 1e4}), rotors_trial},
        {"struck-cantilever", "step_s", steps, "segments", either({1, 5, 10}, {1, 2, 3, 5, 10, 20}),
         struck_trial},
        {"still-cantilever", "step_s", steps, "segments", either({1, 5, 20}, {1, 2, 5, 10, 20, 50}),
         still_trial},
        {"struck-cantilever", "iterations", either({1, 10, 200}, {1, 2, 4, 10, 20, 50, 100, 200}),
         "segments", either({1, 5}, {1, 2, 5, 10, 20}), struck_trial},
        {"still-cantilever", "iterations", either({1, 10, 200}, {1, 2, 4, 10, 20, 50, 100, 200}),
         "segments", either({1, 5}, {1, 2, 5, 10, 20, 50}), still_trial},
    };
}

/// Step of the grids over iterations [s].
inline constexpr double step_of_iterations = 1e-3;

} // namespace bench::stability
