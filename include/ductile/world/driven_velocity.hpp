// SPDX-License-Identifier: MIT
//
// The velocity with which a driven body starts a step. What moves such a body changes its velocity
// between two steps, by as much as it accelerates in one. Taken as it is, every such change would
// be a blow to its joints: a row that sticks would have a velocity to lose, u = -Δv, and book λ
// Δv/2 as flow, in every step, and one that slips would be half a change ahead. But a body that is
// set into motion at once does give a blow.
//
//   Δv goes on as the change before it,   |Δv/dt - a| <= |a|:   the row starts at the last velocity
//   else it is a jump:                                          the row starts at the new one
//
// So the travel (u + u')/2 dt is of second order in both. The first change of a motion that begins
// smoothly is taken for a jump: O(dt²).
//
// Symbols
//   v, Δv  velocity of the body, linear and angular, and its change since the last step
//   a      Δv/dt of the last step
//   u, u'  velocity of a row at the start and the end of a step
#pragma once

#include "ductile/joint/link_types.hpp"
#include "ductile/vocabulary/vector.hpp"

namespace ductile {

/// Of one body that moves but cannot be moved. Not thread-safe.
class DrivenVelocity {
  public:
    /// The body, as it is before the solve of a step of `dt` [s], with the velocities that count
    /// for its start.
    [[nodiscard]] BodyState<double> at_start(BodyState<double> body, double dt) const noexcept {
        if (steps_ < 2) return body;
        if (goes_on(body.velocity, velocity_, acceleration_, dt)) body.velocity = velocity_;
        if (goes_on(body.spin, spin_, angular_acceleration_, dt)) body.spin = spin_;
        return body;
    }

    /// A step of `dt` [s], in which the body moved as it does now, is booked.
    void booked(const BodyState<double>& body, double dt) noexcept {
        if (steps_ > 0) {
            acceleration_ = scaled(1 / dt, difference(body.velocity, velocity_));
            angular_acceleration_ = scaled(1 / dt, difference(body.spin, spin_));
        }
        velocity_ = body.velocity;
        spin_ = body.spin;
        if (steps_ < 2) ++steps_;
    }

    /// Of what comes no step before it is known.
    void forget() noexcept { steps_ = 0; }

  private:
    static bool goes_on(const Vector3<double>& now, const Vector3<double>& last,
                        const Vector3<double>& acceleration, double dt) noexcept {
        const Vector3<double> change =
            difference(scaled(1 / dt, difference(now, last)), acceleration);
        return dot(change, change) <= dot(acceleration, acceleration);
    }

    Vector3<double> velocity_ = Vector3<double>::Zero();             ///< v [m/s]
    Vector3<double> spin_ = Vector3<double>::Zero();                 ///< v [rad/s]
    Vector3<double> acceleration_ = Vector3<double>::Zero();         ///< a [m/s²]
    Vector3<double> angular_acceleration_ = Vector3<double>::Zero(); ///< a [rad/s²]
    int steps_ = 0;                                                  ///< booked in a row, up to 2
};

} // namespace ductile
