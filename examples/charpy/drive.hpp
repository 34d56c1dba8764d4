// SPDX-License-Identifier: MIT
//
// Drives one scene from the hammer's release until the blow is over, and takes the figures.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "simulation.hpp"
#include "step_control.hpp"

namespace charpy {

/// How long a run goes on, and how its history is thinned.
struct DriveLimits {
    double swing_time = 5.0;       ///< give up where nothing was struck by then [s]
    double after_strike = 0.020;   ///< [s]
    double nose_travel = 0.040;    ///< the nose is this far past the specimen's front [m]
    double swing_interval = 1e-2;  ///< between samples of the history, before the strike [s]
    double sample_interval = 2e-5; ///< and after it [s]
};

template <Simulation T>
Result drive(const Scenario& scenario, Method method, const std::string& solver,
             const DriveLimits& limits = {}) {
    T scene(scenario, method, solver);
    StepControl control(scenario.dt);
    Result r;
    r.engine = T::engine;
    r.precision = T::precision;
    r.solver = solver;
    r.method = to_string(method);
    r.dt = scenario.dt;
    r.adaptive = scenario.adaptive;
    r.friction = scenario.friction;
    r.restitution = scenario.restitution;

    double time = 0;
    double next_sample = 0;
    bool struck = false;
    r.strike_energy = scene.hammer_energy();
    ductile::Ledger<double> at_strike = scene.ledger();
    const auto sample = [&](double dt) {
        r.history.push_back({time, dt, scene.hammer_energy(), scene.joint_work(),
                             scene.specimen_kinetic(), scene.ledger().unexplained(),
                             scene.nose_speed(), scene.rotation()});
    };
    while (true) {
        const double dt = scenario.adaptive ? control.next(scene.motion()) : scenario.dt;
        const double energy = scene.hammer_energy();
        const double speed = scene.nose_speed();
        const ductile::Ledger<double> ledger = scene.ledger();
        r.wall += scene.step(dt);
        time += dt;
        ++r.steps;
        if (!struck && scene.touching()) {
            struck = true;
            r.strike_time = time;
            r.strike_speed = speed;
            r.strike_energy = energy;
            at_strike = ledger;
            next_sample = time;
        }
        if (struck && scene.unreliable()) ++r.unreliable_steps;
        if (time >= next_sample) {
            next_sample = time + (struck ? limits.sample_interval : limits.swing_interval);
            sample(dt);
        }
        if (!std::isfinite(scene.hammer_energy())) break;
        if (struck ? time > r.strike_time + limits.after_strike ||
                         scene.nose_travel() > limits.nose_travel
                   : time > limits.swing_time) {
            break;
        }
    }

    using ductile::Account;
    const auto since = [&](Account account) {
        return scene.ledger().booked(account) - at_strike.booked(account);
    };
    r.hammer_loss = r.strike_energy - scene.hammer_energy();
    r.plastic_work = scene.joint_work();
    r.stored = scene.stored();
    r.plastic_rotation = scene.joint_travel();
    r.rotation = std::abs(scene.rotation());
    r.specimen_kinetic = scene.specimen_kinetic();
    r.friction_work = since(Account::friction);
    r.contact_work = since(Account::contact);
    r.joints_work = since(Account::joints);
    r.integration = since(Account::integration);
    r.unexplained = scene.ledger().unexplained();
    r.broken = scene.broken();
    r.residual_max = scene.residual_max();
    return r;
}

} // namespace charpy
