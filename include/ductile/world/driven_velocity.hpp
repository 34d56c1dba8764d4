// SPDX-License-Identifier: MIT
//
// The velocity with which a driven body starts a step. What moves such a body changes its velocity
// between two steps, by as much as it accelerates in one. Taken as it is, every such change would
// be a blow to its joints: a row that sticks would have a velocity to lose, u = -Δv, and book λ
// Δv/2 as flow, in every step, and one that slips would be half a change ahead. But a body that is
// set into motion at once does give a blow.
//
//   Δv goes on:   the row starts at the last velocity
//   it is a jump: the row starts at the new one
//
//   Δv/dt goes on where it is off a by no more than |a|, or, as a smooth motion has a = 0 where it
//   is fastest, than twice what a was off the one before it, where that went on too. So it does as
//   tⁿ begins: the same way within 60° and up to 16 times a, 4 times where it went on twice.
//
// So the travel (u + u')/2 dt is of second order in both. The first change of a motion that begins
// smoothly is taken for a jump: O(dt²).
//
// Symbols
//   v, Δv  velocity of the body, linear and angular, and its change since the last step
//   a      Δv/dt of the last step, dt from middle to middle
//   u, u'  velocity of a row at the start and the end of a step
#pragma once

#include <algorithm>
#include <cmath>

#include "ductile/joint/link_types.hpp"
#include "ductile/vocabulary/vector.hpp"

namespace ductile {

/// The velocity of one, linear or angular, over its steps. Plain value.
struct DrivenPast {
    Vector3<double> value = Vector3<double>::Zero();  ///< v [m/s | rad/s]
    Vector3<double> slope = Vector3<double>::Zero();  ///< a [m/s² | rad/s²]
    Vector3<double> change = Vector3<double>::Zero(); ///< of a since the step before
    double length = 0;                                ///< of the last step [s]
    int steps = 0;                                    ///< booked in a row, up to 2
    int smooth = 0;                                   ///< of them went on in a row, up to 2

    [[nodiscard]] bool goes_on(const Vector3<double>& now, double dt) const noexcept {
        if (steps < 2) return false;
        const Vector3<double> next = slope_to(now, dt), turn = difference(next, slope);
        const double square = dot(slope, slope);
        const double allowed = std::max(square, smooth < 2 ? 0.0 : 4 * dot(change, change));
        if (dot(turn, turn) <= allowed) return true;
        constexpr double alike = 0.5; // as t⁴ begins: 1, 14, 50, 110
        const double more = smooth < 2 ? 16 : 4;
        const double along = dot(next, slope), faster = dot(next, next);
        return along > alike * std::sqrt(square * faster) && faster <= more * more * square;
    }
    void book(const Vector3<double>& now, double dt) noexcept {
        smooth = goes_on(now, dt) ? std::min(smooth + 1, 2) : 0;
        if (steps > 0) {
            const Vector3<double> next = slope_to(now, dt);
            change = difference(next, slope);
            slope = next;
        }
        value = now;
        length = dt;
        if (steps < 2) ++steps;
    }
    /// Between the middles of the last step and of one of `dt` [s] with the mean velocity `now`.
    [[nodiscard]] Vector3<double> slope_to(const Vector3<double>& now, double dt) const noexcept {
        return scaled(2 / (length + dt), difference(now, value));
    }
};

/// Of one body that moves but cannot be moved. Not thread-safe.
class DrivenVelocity {
  public:
    /// The body, as it is before the solve of a step of `dt` [s], with the velocities that count
    /// for its start.
    [[nodiscard]] BodyState<double> at_start(BodyState<double> body, double dt) const noexcept {
        if (velocity_.goes_on(body.velocity, dt)) body.velocity = velocity_.value;
        if (spin_.goes_on(body.spin, dt)) body.spin = spin_.value;
        return body;
    }

    /// A step of `dt` [s], in which the body moved as it does now, is booked.
    void booked(const BodyState<double>& body, double dt) noexcept {
        velocity_.book(body.velocity, dt);
        spin_.book(body.spin, dt);
    }

    /// Of what comes no step before it is known.
    void forget() noexcept { velocity_.steps = spin_.steps = 0; }

  private:
    DrivenPast velocity_, spin_;
};

} // namespace ductile
