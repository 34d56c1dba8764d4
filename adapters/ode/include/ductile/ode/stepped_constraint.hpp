// SPDX-License-Identifier: MIT
//
// What takes part in a step of an ODE world beside ODE's own joints. World calls it.
#pragma once

#include "ductile/world/leapfrog.hpp"

namespace ductile::ode {

class SteppedConstraint {
  public:
    virtual ~SteppedConstraint() = default;
    /// Called for all before any is prepared.
    /// @throws what makes the step impossible; nothing has changed then.
    virtual void check() const {}
    /// How the constraint's forces act in the coming steps; of a World that leapfrogs.
    void set_kick(const Kick& kick) noexcept { kick_ = kick; }
    virtual void prepare(double dt) = 0;
    virtual void commit(double dt) = 0;

  protected:
    Kick kick_;
};

} // namespace ductile::ode
