// SPDX-License-Identifier: MIT
//
// A kinematic body as a joint has to see it. Bullet's stepSimulation reads where such a body was
// put, gives it the velocity that leads there, and leaves it at its destination, before the first
// of its internal ticks; all other bodies move within each tick, after the solve. So at the start
// of a tick the body is not yet where Bullet has it: it is where the last tick left it, and goes
// its share of the way within this one.
//
// Nobody says how many ticks a stepSimulation has; the way that is left and the velocity do. Where
// they do not fit together, as with a joint that was left out of some ticks, the body comes from
// where its velocity says, in this tick alone.
//
// Not thread-safe.
#pragma once

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include "ductile/bullet/convert.hpp"
#include "ductile/vocabulary/linkage.hpp"
#include "ductile/world/driven_velocity.hpp"

namespace ductile::bullet {

class DrivenBody {
  public:
    /// The body at the start of a tick of `dt` [s]; `only_tick`: stepSimulation has no other.
    [[nodiscard]] BodyState<double> at_start(const btRigidBody& body, double dt, bool only_tick);
    /// The same where bodies are half a step ahead, as driven_ways.hpp puts them.
    [[nodiscard]] BodyState<double> at_start_ahead(const btRigidBody& body) {
        known_ = false; // its place is not that of the end of a tick
        velocity_.forget();
        BodyState<double> start = body_motion(body);
        start.velocity = to_core(body.getInterpolationLinearVelocity());
        start.spin = to_core(body.getInterpolationAngularVelocity());
        return start;
    }
    /// The same body at the end of that tick, booked herewith.
    const BodyState<double>& at_end() noexcept {
        velocity_.booked(end_, dt_);
        return end_;
    }
    /// The joint was left out of a tick.
    void lose() noexcept { known_ = false; }
    /// The body is where it is at the end of a tick.
    void find(const btRigidBody& body) {
        end_ = body_motion(body);
        known_ = true;
        velocity_.forget();
    }

  private:
    BodyState<double> end_; ///< of the last tick
    double dt_ = 0;
    bool known_ = false;
    DrivenVelocity velocity_;
};

} // namespace ductile::bullet

#ifndef DUCTILE_COMPILED
#include "ductile/bullet/driven_body.ipp"
#endif
