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

#include <algorithm>
#include <cmath>

#include "ductile/bullet/convert.hpp"
#include "ductile/joint/rotation.hpp"
#include "ductile/world/driven_velocity.hpp"

namespace ductile::bullet {

namespace detail {

/// Where a body is; the rest as of `body`.
inline BodyState<double> moved(BodyState<double> body, const Vector3<double>& way,
                               const Vector3<double>& turn) {
    body.position = sum(body.position, way);
    body.orientation = turned_by<double>(turn, body.orientation);
    return body;
}

} // namespace detail

class DrivenBody {
  public:
    /// The body at the start of a tick of `dt` [s]; `only_tick`: stepSimulation has no other.
    [[nodiscard]] BodyState<double> at_start(const btRigidBody& body, double dt, bool only_tick) {
        constexpr double round_off =
            0.1; // of a tick: Bullet's angular velocities are rough in float
        const BodyState<double> now = body_motion(body);
        if (!known_) velocity_.forget();
        BodyState<double> start = now;
        const Vector3<double> way = difference(now.position, end_.position);
        const Vector3<double> turn =
            rotation_vector<double>(times_transposed(now.orientation, end_.orientation));
        const double speed = dot(now.velocity, now.velocity) + dot(now.spin, now.spin);
        const double ticks = (dot(way, now.velocity) + dot(turn, now.spin)) / (speed * dt);
        const bool stands = known_ && is_zero(way) && now.orientation == end_.orientation;
        const double left = only_tick ? 1 : std::max(std::round(ticks), 1.0);
        const Vector3<double> off = difference(way, scaled(left * dt, now.velocity));
        const Vector3<double> off_turn = difference(turn, scaled(left * dt, now.spin));
        const bool fits = known_ && dot(off, off) + dot(off_turn, off_turn) <=
                                        round_off * round_off * dt * dt * speed;
        if (stands) {
            end_ = now;
        } else if (fits) {
            start.position = end_.position;
            start.orientation = end_.orientation;
            end_ = left > 1 ? detail::moved(start, scaled(1 / left, way), scaled(1 / left, turn))
                            : now;
        } else {
            start = detail::moved(now, scaled(-dt, now.velocity), scaled(-dt, now.spin));
            end_ = now;
        }
        known_ = true;
        dt_ = dt;
        return velocity_.at_start(start, dt);
    }
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
