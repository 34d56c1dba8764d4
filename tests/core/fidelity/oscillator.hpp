// SPDX-License-Identifier: MIT
//
// The oscillator of peak_response.hpp stepped in time, to hold its closed forms and the errors told
// by joint_detail.hpp against: an elastic-perfectly plastic spring, and the library's own
// rigid-plastic joint.
#pragma once

#include <algorithm>
#include <cmath>

#include "ductile/fidelity/peak_response.hpp"
#include "ductile/joint/one_axis_joint.hpp"
#include "ductile/law/perfect.hpp"

namespace ductile::test {

/// Mean load over the step from t to t + dt, so that an end inside a step counts as much as it
/// lasts.
inline double mean_load(const AxisEvent<double>& event, double t, double dt) {
    return event.load * std::clamp((event.duration - t) / dt, 0.0, 1.0);
}

/// Largest displacement of the first swing with the spring force -k (q_e + θ v' dt), θ(a) as
/// elastic_row.hpp has it (up to a = k dt²/m = 1/4 symplectic Euler), from the position under the
/// held load.
inline double elastic_plastic_peak(const AxisSystem<double>& system, const AxisEvent<double>& event,
                                   double dt) {
    const double a = system.stiffness * dt * dt / system.mass;
    const double implicit = std::clamp((a - 0.25) / 3.75, 0.0, 1.0);
    double u = 0, v = event.speed, plastic = 0, elastic = event.held / system.stiffness;
    for (double t = 0; t < 1e5 * dt; t += dt) {
        const double free = v + dt * (mean_load(event, t, dt) + event.held) / system.mass;
        const double after =
            (free - dt * system.stiffness * elastic / system.mass) / (1 + implicit * a);
        const double force =
            std::min(system.stiffness * (elastic + implicit * dt * after), system.strength);
        v = free - dt * force / system.mass;
        if (v <= 0 && t > 0) break;
        u += dt * v;
        elastic = event.held / system.stiffness + u - plastic;
        const double excess = elastic - system.strength / system.stiffness;
        if (excess > 0) {
            plastic += excess;
            elastic -= excess;
        }
    }
    return u;
}

/// The same with the rigid-plastic joint.
inline double rigid_plastic_peak(const AxisSystem<double>& system, const AxisEvent<double>& event,
                                 double dt) {
    OneAxisJoint joint(Perfect<double>({.strength = system.strength}));
    double u = 0, v = event.speed;
    for (double t = 0; t < 1e5 * dt; t += dt) {
        const RowLimits<double> row = joint.prepare({u, v}, dt);
        const double free = v + dt * (mean_load(event, t, dt) + event.held) / system.mass;
        const double impulse =
            std::clamp(system.mass * (row.bias - free), row.lower * dt, row.upper * dt);
        v = free + impulse / system.mass;
        u += dt * v;
        (void)joint.commit({impulse / dt, v, u}, dt);
        if (v <= 0) break;
    }
    return u;
}

} // namespace ductile::test
