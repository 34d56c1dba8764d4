// SPDX-License-Identifier: MIT
//
// The cells of the frame map: scenes with a known answer, each over one of its numbers, at frames
// as games have them. The same for every method.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <string>
#include <vector>

#include "engines/settings.hpp"
#include "scenes/all.hpp"
#include "scenes/loaded_bar.hpp"
#include "scenes/still_cantilever.hpp"

namespace bench {

struct Grid {
    std::string name;
    std::string y_name;
    std::vector<double> y;
    /// `energy`: what a gain of energy is measured by [J].
    std::function<Scene(double frame, double y, double& energy)> scene;
    bool elastic = false; ///< methods without an elastic part have no answer to it
};

inline constexpr std::array<double, 4> frames{1.0 / 240, 1.0 / 120, 1.0 / 60, 1.0 / 30}; ///< [s]

/// So many frames are run after the motion.
inline constexpr double frames_at_rest = 12;

[[nodiscard]] inline Scene charpy_cell(double, double yield_stress, double& energy) {
    CharpyParameters p;
    p.scenario.yield_stress = yield_stress;
    p.after = 0.012; // the hammer at 800 MPa is slow
    Scene scene = charpy_blow(p);
    energy = scene.quantities[0].expected;
    return scene;
}

[[nodiscard]] inline Scene bar_cell(double frame, double yield_stress, double& energy) {
    LoadedBarParameters p{.yield_stress = yield_stress};
    p.rest = std::max(p.rest, frames_at_rest * frame);
    energy = p.mass * p.speed * p.speed / 2;
    return loaded_bar(p);
}

/// A light rotor between the ground and a heavy one; first comes the rotation of the hinge that
/// stops them both.
[[nodiscard]] inline Scene rotors_cell(double frame, double ratio, double& energy) {
    RotorsInSeriesParameters p;
    p.first_inertia = p.second_inertia / ratio;
    Scene scene = rotors_in_series(p);
    scene.duration = std::max(scene.duration, scene.duration / 1.2 + frames_at_rest * frame);
    std::swap(scene.quantities[0], scene.quantities[1]);
    energy = p.second_inertia * p.spin * p.spin / 2;
    return scene;
}

[[nodiscard]] inline Scene struck_cell(double frame, double segments, double& energy) {
    const double stop = segments > 1 ? 0.0416 : 0.04; // P13 a, all N
    Scene scene = struck_cantilever({.segments = int(segments), .mass_at_ends = segments > 20});
    scene.duration = std::max(scene.duration, stop + frames_at_rest * frame);
    energy = scene.quantities.back().expected;
    return scene;
}

[[nodiscard]] inline Scene still_cell(double frame, double segments, double& energy) {
    StillCantileverParameters p{.segments = int(segments)};
    p.duration = std::max(p.duration, frames_at_rest * frame);
    Scene scene = still_cantilever(p);
    energy = scene.joints[0].strength * free_fall(p) / p.length;
    return scene;
}

[[nodiscard]] inline Scene oscillator_cell(double, double stiffness, double& energy) {
    const OscillatorParameters p{.stiffness = stiffness};
    Scene scene = oscillator(p);
    energy = p.load * p.strength * scene.quantities[0].expected;
    return scene;
}

[[nodiscard]] inline Scene breaking_cell(double, double limit, double& energy) {
    const BreakingHingeParameters p{.limit = limit};
    energy = p.plastic_moment * limit;
    return breaking_hinge(p);
}

[[nodiscard]] inline Scene dropped_cell(double, double strength, double& energy) {
    Scene scene = dropped_mass({.strength = strength});
    energy = scene.quantities.back().expected;
    return scene;
}

[[nodiscard]] inline Scene lamp_cell(double, double plastic_moment, double& energy) {
    Scene scene = lamp_post({.plastic_moment = plastic_moment});
    energy = scene.quantities.back().expected;
    return scene;
}

[[nodiscard]] inline std::vector<Grid> grids() {
    return {
        {"charpy", "yield_stress_Pa", {50e6, 100e6, 200e6, 400e6, 600e6, 800e6}, charpy_cell},
        {"loaded-bar",
         "yield_stress_Pa",
         {50e6, 100e6, 200e6, 400e6, 800e6, 1.4e9, 2e9},
         bar_cell},
        {"oscillator", "stiffness_N_per_m", {4e3, 4e4, 4e5, 4e6, 4e7}, oscillator_cell, true},
        {"rotors-in-series", "mass_ratio", {1, 3, 10, 30, 100, 1e3, 1e4}, rotors_cell},
        {"struck-cantilever", "segments", {1, 2, 3, 5, 10, 20, 50}, struck_cell},
        {"still-cantilever", "segments", {1, 2, 5, 10, 20, 50}, still_cell},
        {"breaking-hinge", "limit_rad", {0.3, 1.3, 2.2}, breaking_cell},
        {"dropped-mass", "strength_N", {8e3, 15e3, 30e3, 60e3, 120e3}, dropped_cell},
        {"lamp-post", "plastic_moment_Nm", {20e3, 25e3, 30e3}, lamp_cell},
    };
}

} // namespace bench
