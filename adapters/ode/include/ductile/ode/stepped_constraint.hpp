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
    /// In the coming steps the bodies are half a step ahead (half_ahead.hpp).
    void set_ahead(bool ahead) noexcept { ahead_ = ahead; }
    virtual void prepare(double dt) = 0;
    virtual void commit(double dt) = 0;
    /// Called for all when all have committed: what a break gives back.
    virtual void finish() {}
    /// The step stands: what is broken lets go, which is not put back.
    virtual void stand() {}

  protected:
    friend class World;
    SteppedConstraint() = default;

    bool ahead_ = false; ///< the bodies are half a step ahead where rows are solved
};

} // namespace ductile::ode
