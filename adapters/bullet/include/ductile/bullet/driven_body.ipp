// SPDX-License-Identifier: MIT
//
// Bodies of driven_body.hpp.
#pragma once

#include <algorithm>
#include <cmath>

#include "ductile/bullet/driven_body.hpp"
#include "ductile/joint/rotation.hpp"

namespace ductile::bullet {

namespace detail {

/// Where a body is; the rest as of `body`.
DUCTILE_INLINE BodyState<double> moved(BodyState<double> body, const Vector3<double>& way,
                                       const Vector3<double>& turn) {
    body.position = sum(body.position, way);
    body.orientation = turned_by<double>(turn, body.orientation);
    return body;
}

} // namespace detail

DUCTILE_INLINE BodyState<double> DrivenBody::at_start(const btRigidBody& body, double dt,
                                                      bool only_tick) {
    constexpr double round_off = 0.1; // of a tick: Bullet's angular velocities are rough in float
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
        end_ = left > 1 ? detail::moved(start, scaled(1 / left, way), scaled(1 / left, turn)) : now;
    } else {
        start = detail::moved(now, scaled(-dt, now.velocity), scaled(-dt, now.spin));
        end_ = now;
    }
    known_ = true;
    dt_ = dt;
    return velocity_.at_start(start, dt);
}

} // namespace ductile::bullet
