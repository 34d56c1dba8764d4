// SPDX-License-Identifier: MIT
//
// Drives one scene until the blow is over, and takes the figures: in frames where the specimen has
// this library's joints, in steps that follow the blow where it has the engine's own.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "simulation.hpp"
#include "step_control.hpp"

namespace charpy {

/// How long a run goes on, and how its history is thinned.
struct DriveLimits {
    double after_strike = 0.020;   ///< [s]
    double nose_travel = 0.040;    ///< the nose is this far past the specimen's front [m]
    double sample_interval = 2e-5; ///< between samples of the history [s]
};

template <Simulation T>
Result drive(const Scenario& scenario, Method method, const std::string& solver) {
    constexpr DriveLimits limits;
    T scene(scenario, method, solver);
    StepControl control;
    Result r;
    r.engine = T::engine;
    r.precision = T::precision;
    r.solver = solver;
    r.method = to_string(method);
    r.frame = is_plastic(method) ? scenario.frame : 0;
    r.friction = scenario.friction;
    r.restitution = scenario.restitution;

    const double energy = scene.hammer_energy();
    double time = -scenario.time_to_strike(), next_sample = time;
    do {
        const double dt = r.frame > 0 ? r.frame : control.next(scene.motion());
        r.wall += scene.step(dt);
        time += dt;
        ++r.solves;
        if (scene.unreliable()) r.believed = false;
        if (time < next_sample) continue;
        next_sample = time + limits.sample_interval;
        r.history.push_back({time, dt, energy - scene.hammer_energy(), scene.joint_work(),
                             scene.specimen_kinetic(), scene.ledger().unexplained(),
                             scene.nose_speed(), scene.rotation()});
    } while (std::isfinite(scene.hammer_energy()) && time < limits.after_strike &&
             scene.nose_travel() < limits.nose_travel);

    using ductile::Account;
    const ductile::Ledger<double>& ledger = scene.ledger();
    r.hammer_loss = energy - scene.hammer_energy();
    r.plastic_work = scene.joint_work();
    r.stored = scene.stored();
    r.plastic_rotation = scene.joint_travel();
    r.rotation = std::abs(scene.rotation());
    r.specimen_kinetic = scene.specimen_kinetic();
    r.friction_work = ledger.booked(Account::friction);
    r.contact_work = ledger.booked(Account::contact);
    r.joints_work = ledger.booked(Account::joints);
    r.integration = ledger.booked(Account::integration);
    r.unexplained = ledger.unexplained();
    r.broken = scene.broken();
    if (const ductile::RunReport* run = scene.run()) {
        r.solves = long(run->parts + run->rejected + run->blows);
        r.believed = r.believed && run->believed();
        r.left = run->left.energy;
    }
    return r;
}

} // namespace charpy
