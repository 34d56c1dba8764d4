// SPDX-License-Identifier: MIT
//
// Steps of second order. An engine lets a force act for the step and moves with the velocity at its
// end, v' = v + a dt, x' = x + v' dt, so that whatever starts or stops under a load rests off by
// v dt/2. Where each force acts for half of the step before and half of this one,
//
//   v' = v + a (dt₋ + dt)/2,   x' = x + v' dt,   dt₋ = 0 at the start,
//
// the very same engine takes the leapfrog (Störmer-Verlet) rule: velocities are those in the middle
// of the step, positions are of second order, whatever the steps. Impulses, of contacts and of rows
// that hold, are what they have to be and need no such rule.
//
// Symbols
//   dt₋, dt  last step and this one                     [s]
//   κ        share of this step for which forces act    [-]
//
// Limit cases: equal steps: only the first differs, κ = 1/2. A constant force moves a body at rest
// by exactly a t²/2 at the end of any sequence of steps.
//
// Source: Hairer, Lubich, Wanner (2003), Geometric numerical integration illustrated by the
// Störmer-Verlet method, Acta Numerica 12, section 1.
#pragma once

#include <utility>

namespace ductile {

/// How the forces of a step act. Plain value; of an engine that does not leapfrog as it is at
/// first.
struct ForceShare {
    double value = 1;    ///< κ, > 0
    bool midway = false; ///< velocities are those in the middle of steps
    bool ahead = false;  ///< bodies are half a step ahead where rows are solved
};

/// Not thread-safe; O(1).
class Leapfrog {
  public:
    /// Of the coming step of `dt` > 0 [s].
    [[nodiscard]] ForceShare next(double dt) noexcept {
        return {.value = (std::exchange(last_, dt) + dt) / (2 * dt), .midway = true};
    }
    /// The next step is a first one: somebody gave the bodies velocities that are those of now.
    void restart() noexcept { last_ = 0; }
    /// dt₋ [s], to be saved with a run; 0 where the next step is a first one.
    [[nodiscard]] double last() const noexcept { return last_; }
    /// Goes on as after a step of `last` >= 0 [s].
    void resume(double last) noexcept { last_ = last; }

  private:
    double last_ = 0; ///< dt₋
};

} // namespace ductile
