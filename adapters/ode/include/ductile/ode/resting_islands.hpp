// SPDX-License-Identifier: MIT
//
// Who falls asleep in a World with a tolerance, told once a frame by the bodies' own thresholds,
// steps and times (dBodySetAutoDisable...; a frame is a step, of the last velocity: no average over
// samples). ODE's own counters would count the parts of a frame, also those that are put back, and
// can be neither read nor written.
//
// An island falls asleep as a whole: what hangs together by joints and contacts, once all its
// bodies are idle and its plastic joints rest. One that hangs on a kinematic body that is enabled
// stays awake, as ODE would wake it, and so does a body without any joint.
//
// Not thread-safe.
#pragma once

#include <ode/ode.h>

#include <span>
#include <utility>
#include <vector>

#include "ductile/ode/plastic_constraint.hpp"
#include "ductile/vocabulary/address_book.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::ode {

class RestingIslands {
  public:
    /// Keeps ODE from counting until `end`.
    void begin(std::span<const dBodyID> bodies);
    void end();
    /// To be called before a body is destroyed.
    void forget(dBodyID body) {
        std::erase_if(samples_, [body](const auto& entry) { return entry.first == body; });
        if (Idle* idle = idle_.find(body)) *idle = {};
    }
    /// A frame of `length` [s] is over, its contacts are there. True where a body fell asleep.
    bool look(std::span<const dBodyID> bodies, std::span<PlasticConstraint* const> joints,
              double length);

  private:
    struct Idle {
        int steps = 0;   ///< 0: it is not
        double time = 0; ///< [s]
    };
    /// All that hangs together with a body, into found_; false where it is to stay awake.
    [[nodiscard]] bool gather(dBodyID first);

    std::vector<std::pair<dBodyID, int>> samples_; ///< of those that ODE would count
    AddressMap<Idle> idle_, before_;               ///< by body; before this frame
    AddressMap<PlasticConstraint*> plastic_;       ///< by joint
    AddressBook seen_;                             ///< bodies
    std::vector<dBodyID> found_;
};

} // namespace ductile::ode

#ifndef DUCTILE_COMPILED
#include "ductile/ode/resting_islands.ipp"
#endif
