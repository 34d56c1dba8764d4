// SPDX-License-Identifier: MIT
//
// Steps an ODE world and the plastic constraints in it. ODE calls nothing back at the end of a step, so
// the step itself has to go through here: one call in place of dWorldStep or dWorldQuickStep.
//
//   ductile::ode::World stepper(world);
//   hinge.add_to(stepper);
//   stepper.step(dt);
//
// Not thread-safe. The world and the constraints must outlive the stepper, or be removed from it.
#pragma once

#include <ode/ode.h>

#include <algorithm>
#include <vector>

#include "ductile/vocabulary/check.hpp"

namespace ductile::ode {

/// ODE's two solvers: a direct one, exact, and an iterative one.
enum class Solver { direct, quick };

/// What takes part in a step beside ODE's own joints.
class SteppedConstraint {
  public:
    virtual ~SteppedConstraint() = default;
    virtual void prepare(double dt) = 0;
    virtual void commit(double dt) = 0;
};

class World {
  public:
    explicit World(dWorldID world, Solver solver = Solver::direct) : world_(world), solver_(solver) {}

    [[nodiscard]] dWorldID id() const noexcept { return world_; }

    void add(SteppedConstraint& constraint) { constraints_.push_back(&constraint); }
    void remove(SteppedConstraint& constraint) { std::erase(constraints_, &constraint); }

    /// One step of `dt` > 0 [s].
    /// @throws std::invalid_argument where the step is not finite or not positive.
    void step(double dt) {
        check::positive("World.step.dt", dt, "s");
        for (SteppedConstraint* constraint : constraints_) constraint->prepare(dt);
        if (solver_ == Solver::direct) {
            dWorldStep(world_, dReal(dt));
        } else {
            dWorldQuickStep(world_, dReal(dt));
        }
        for (SteppedConstraint* constraint : constraints_) constraint->commit(dt);
    }

  private:
    dWorldID world_;
    Solver solver_;
    std::vector<SteppedConstraint*> constraints_;
};

} // namespace ductile::ode
