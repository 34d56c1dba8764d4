// SPDX-License-Identifier: MIT
//
// A plastic constraint of any kind as a world and an energy account see it.
#pragma once

#include <ode/ode.h>

#include <stdexcept>
#include <string>

#include "ductile/ode/convert.hpp"
#include "ductile/ode/stepped_constraint.hpp"
#include "ductile/vocabulary/vector.hpp"
#include "ductile/world/joint_queries.hpp"

namespace ductile::ode {

/// What a constraint applied for a step beside its joint, about the centres of mass, world axes.
struct OutsideForce {
    Vector3<double> force{0, 0, 0};    ///< on A; the opposite on B [N]
    Vector3<double> torque_a{0, 0, 0}; ///< [N m]
    Vector3<double> torque_b{0, 0, 0};
};

class PlasticConstraint : public SteppedConstraint {
  public:
    ~PlasticConstraint() override { leave_keepers(); }

    [[nodiscard]] virtual const PairQueries& queries() const noexcept = 0;
    /// Of the last step.
    [[nodiscard]] virtual const OutsideForce& outside_force() const = 0;
    [[nodiscard]] virtual dJointID id() const = 0;
    /// Also once it is broken and its joint attached to nothing.
    [[nodiscard]] virtual AttachedBodies bodies() const = 0;
};

/// What happens to ODE's joint when its plastic row breaks.
enum class AtBreak {
    disable_joint, ///< the whole joint lets go: it is disabled, and attached to nothing
    release_axis   ///< only the row does: its motor is switched off
};

/// @throws std::invalid_argument where the first body of a `kind` is null.
inline void require_body(const char* kind, dBodyID a) {
    if (a != nullptr) return;
    throw std::invalid_argument(std::string(kind) +
                                ".a = null: must be a body (only b may be the static world)");
}

} // namespace ductile::ode
