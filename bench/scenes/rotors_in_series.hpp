// SPDX-License-Identifier: MIT
//
// Ground -[M₁]- rotor I₁ -[M₂]- rotor I₂ (problem P27a of tests/reference): only the second spins.
// The hinge between them turns until both spin alike, then holds while the one to the ground stops
// both.
//
//   α₁ = (M₂ - M₁)/I₁,  α₂ = M₂/I₂,   t_lock = ω/(α₁ + α₂),   ω_lock = α₁ t_lock
//   hinge 2 turns ω t_lock/2;  t_stop = t_lock + ω_lock (I₁ + I₂)/M₁;  hinge 1 turns ω_lock
//   t_stop/2 valid for M₂ > M₁ and M₂ strong enough to hold: M₁ I₂/(I₁ + I₂) <= M₂
#pragma once

#include "scenes/scene.hpp"

namespace bench {

struct RotorsInSeriesParameters {
    double first_inertia = 1;  ///< I₁ [kg m²]
    double second_inertia = 2; ///< I₂ [kg m²]
    double first_moment = 20;  ///< M₁ [N m]
    double second_moment = 50; ///< M₂ [N m]
    double spin = 12;          ///< ω [rad/s]
};

[[nodiscard]] inline Scene rotors_in_series(const RotorsInSeriesParameters& p = {}) {
    const double lock = p.spin / ((p.second_moment - p.first_moment) / p.first_inertia +
                                  p.second_moment / p.second_inertia);
    const double common = (p.second_moment - p.first_moment) / p.first_inertia * lock;
    const double stop = lock + common * (p.first_inertia + p.second_inertia) / p.first_moment;
    Scene scene;
    scene.name = "rotors-in-series";
    scene.source = "P27 a";
    scene.bodies = {
        {.inertia = Vector::Constant(p.first_inertia)},
        {.inertia = Vector::Constant(p.second_inertia), .start = {.spin = {0, 0, p.spin}}}};
    scene.joints = {{.a = 0, .strength = p.first_moment},
                    {.a = 1, .b = 0, .strength = p.second_moment}};
    scene.duration = 1.2 * stop;
    scene.quantities = {
        {"rotation_2", p.spin * lock / 2, [](const Observation& o) { return o.travel[1]; }},
        {"rotation_1", common * stop / 2, [](const Observation& o) { return o.travel[0]; }},
        absorbed_energy(p.second_inertia * p.spin * p.spin / 2)};
    return scene;
}

} // namespace bench
