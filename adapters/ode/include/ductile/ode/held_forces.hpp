// SPDX-License-Identifier: MIT
//
// The forces that a user applied for a step, kept so that each part of the step has them: ODE
// forgets forces at the end of each part.
#pragma once

#include <ode/ode.h>

#include <algorithm>
#include <span>
#include <vector>

#include "ductile/ode/convert.hpp"

namespace ductile::ode {

/// Not thread-safe.
class HeldForces {
  public:
    void hold(std::span<const dBodyID> bodies) {
        held_.clear();
        for (dBodyID body : bodies) {
            const Held held{body, to_core(dBodyGetForce(body)), to_core(dBodyGetTorque(body))};
            if (!is_zero(held.force) || !is_zero(held.torque)) held_.push_back(held);
        }
    }
    void apply() const {
        for (const auto& [body, force, torque] : held_) add_force(body, force, torque);
    }
    /// To be called before a body is destroyed.
    void forget(dBodyID body) {
        std::erase_if(held_, [body](const Held& held) { return held.body == body; });
    }
    /// To these alone.
    void apply_to(std::span<const dBodyID> bodies) const {
        for (const auto& [body, force, torque] : held_) {
            if (std::find(bodies.begin(), bodies.end(), body) == bodies.end()) continue;
            add_force(body, force, torque);
        }
    }

  private:
    struct Held {
        dBodyID body;
        Vector3<double> force, torque;
    };

    std::vector<Held> held_;
};

} // namespace ductile::ode
