// SPDX-License-Identifier: MIT
//
// What takes part in a step of an ODE world beside ODE's own joints. World calls it.
#pragma once

#include "ductile/world/kept_joint.hpp"
#include "ductile/world/leapfrog.hpp"

namespace ductile::ode {

/// Leaves every World when it ends.
class SteppedConstraint : public KeptJoint {
  public:
    virtual ~SteppedConstraint() { leave_keepers(); }
    /// Called for all before any is prepared.
    /// @throws what makes the step impossible; nothing has changed then.
    virtual void check() const {}
    /// How the constraint's forces act in the coming steps; of a World that leapfrogs.
    void set_force_share(const ForceShare& share) noexcept { force_share_ = share; }
    virtual void prepare(double dt) = 0;
    virtual void commit(double dt) = 0;
    /// Called for all when all have committed: what a break gives back.
    virtual void finish() {}
    /// The step stands: what is broken lets go, which is not put back.
    virtual void stand() {}

  protected:
    friend class World;
    SteppedConstraint() = default;

    ForceShare force_share_;
};

} // namespace ductile::ode
