// SPDX-License-Identifier: MIT
//
// A heavy cantilever of N rigid segments that stays just below its plastic moment (problem P11 of
// tests/reference, the side below the limit load): nothing may move. A closed energy ledger proves
// nothing about a solve that has not converged; this does.
//
//   M_root = μ g L²/2 + G g L = utilisation × M_p
#pragma once

#include <algorithm>

#include "scenes/scene.hpp"

namespace bench {

struct StillCantileverParameters {
    int segments = 5;
    double length = 1;          ///< L [m]
    double mass_per_length = 2; ///< μ [kg/m]
    double tip_mass = 1;        ///< G, part of the last segment [kg]
    double gravity = 9.81;      ///< g [m/s²]
    double utilisation = 0.9;   ///< of the root, below 1
    double duration = 0.2;      ///< [s]
};

/// How far the tip would fall from rest if the root did not hold [m].
[[nodiscard]] inline double free_fall(const StillCantileverParameters& p) {
    const double moment = p.gravity * p.length * (p.mass_per_length * p.length / 2 + p.tip_mass);
    const double inertia = p.length * p.length * (p.mass_per_length * p.length / 3 + p.tip_mass);
    return std::min(moment / inertia * p.length * p.duration * p.duration / 2, p.length);
}

/// The quantity is the fall of the tip as a share of `free_fall`, plus one: expected is 1.
[[nodiscard]] inline Scene still_cantilever(const StillCantileverParameters& p = {}) {
    const int n = p.segments;
    const double s = p.length / n;
    const double mass = p.mass_per_length * s;
    const double root = p.gravity * p.length * (p.mass_per_length * p.length / 2 + p.tip_mass);
    Scene scene;
    scene.name = "still-cantilever";
    scene.source = "P11, below the limit load";
    scene.gravity = {0, -p.gravity, 0};
    scene.duration = p.duration;
    for (int i = 0; i < n; ++i) {
        const double tip = i + 1 == n ? p.tip_mass : 0;
        const double middle = (i + 0.5) * s, total = mass + tip;
        const double centre = (mass * middle + tip * p.length) / total;
        const double about = mass * s * s / 12 + mass * std::pow(middle - centre, 2) +
                             tip * std::pow(p.length - centre, 2);
        scene.bodies.push_back({.mass = total,
                                .inertia = Vector::Constant(about),
                                .start = {.position = {centre, 0, 0}}});
        scene.joints.push_back({.a = i,
                                .b = i == 0 ? ground : i - 1,
                                .anchor = {i * s, 0, 0},
                                .strength = root / p.utilisation});
    }
    const Vector tip_in_last(p.length - scene.bodies.back().start.position.x(), 0, 0);
    const double fall = free_fall(p);
    scene.quantities = {{"one_plus_fall", 1, [tip_in_last, fall](const Observation& o) {
                             return 1 - o.bodies.back().point(tip_in_last).y() / fall;
                         }}};
    return scene;
}

} // namespace bench
