// SPDX-License-Identifier: MIT
//
// Lets a step of ODE see its bodies half a step ahead (frame/README.md): before it they are moved
// by h/2 with the velocities they have; after it, from there on by h/2 with those they got, before
// any joint books where bodies are.
//
// Bodies turn by the rotation that is theirs, whatever dBodySetFiniteRotationMode says. A kinematic
// body goes its way like all others. One that the step woke was not ahead, and goes its half from
// where it slept.
//
// ODE's own moved-callbacks (dBodySetMovedCallback) are told where ODE had a body within the step.
//
// Not thread-safe.
#pragma once

#include <ode/ode.h>

#include <array>
#include <span>
#include <vector>

#include "ductile/vocabulary/linkage.hpp"

namespace ductile::ode {

class HalfAhead {
  public:
    /// Moves the bodies that are awake on by `time` [s], which may be 0, and remembers where they
    /// are then.
    void move(std::span<const dBodyID> bodies, double time);
    /// After ODE's step: from there on by `time` [s] with the velocities that they have now.
    void move_on(double time) const;

  private:
    struct Middle {
        dBodyID body;
        std::array<dReal, 3> place;
        std::array<dReal, 4> turn; ///< quaternion
    };
    static void put(const Middle& from, double time);

    std::vector<Middle> middles_;
};

} // namespace ductile::ode

#ifndef DUCTILE_COMPILED
#include "ductile/ode/half_ahead.ipp"
#endif
