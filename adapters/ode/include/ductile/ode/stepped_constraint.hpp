// SPDX-License-Identifier: MIT
//
// What takes part in a step of an ODE world beside ODE's own joints. World calls it.
#pragma once

#include "ductile/world/kept_joint.hpp"

namespace ductile::ode {

/// Leaves every World when it ends.
class SteppedConstraint : public KeptJoint {
  public:
    virtual ~SteppedConstraint() { leave_keepers(); }
    /// Called for all before any is prepared.
    /// @throws what makes the step impossible; nothing has changed then.
    virtual void check() const {}
    virtual void prepare(double dt) = 0;
    virtual void commit(double dt) = 0;
    /// Called for all when all have committed.
    virtual void finish() {}

  protected:
    friend class World;
    SteppedConstraint() = default;
};

} // namespace ductile::ode
