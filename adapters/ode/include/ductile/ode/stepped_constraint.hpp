// SPDX-License-Identifier: MIT
//
// What takes part in a step of an ODE world beside ODE's own joints. World calls it.
#pragma once

namespace ductile::ode {

class SteppedConstraint {
  public:
    virtual ~SteppedConstraint() = default;
    /// Called for all before any is prepared.
    /// @throws what makes the step impossible; nothing has changed then.
    virtual void check() const {}
    /// Share of the coming steps for which the constraint's forces act, > 0 and 1 at first; of a
    /// World that leapfrogs (world/leapfrog.hpp).
    void set_kick(double share) noexcept { kick_ = share; }
    virtual void prepare(double dt) = 0;
    virtual void commit(double dt) = 0;

  protected:
    double kick_ = 1;
};

} // namespace ductile::ode
