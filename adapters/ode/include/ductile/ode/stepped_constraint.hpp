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
    virtual void prepare(double dt) = 0;
    virtual void commit(double dt) = 0;
};

} // namespace ductile::ode
