// SPDX-License-Identifier: MIT
//
// Bodies of half_ahead.hpp.
#pragma once

#include <algorithm>
#include <cmath>

#include "ductile/ode/half_ahead.hpp"

namespace ductile::ode {

DUCTILE_INLINE void HalfAhead::move(std::span<const dBodyID> bodies, double time) {
    middles_.clear();
    for (dBodyID body : bodies) {
        const auto here = [body] {
            Middle middle{body, {}, {}};
            std::copy_n(dBodyGetPosition(body), 3, middle.place.begin());
            std::copy_n(dBodyGetQuaternion(body), 4, middle.turn.begin());
            return middle;
        };
        if (time > 0 && dBodyIsEnabled(body) != 0) put(here(), time);
        middles_.push_back(here());
    }
}

DUCTILE_INLINE void HalfAhead::move_on(double time) const {
    for (const Middle& middle : middles_) {
        if (dBodyIsEnabled(middle.body) != 0) put(middle, time);
    }
}

DUCTILE_INLINE void HalfAhead::put(const Middle& from, double time) {
    const dReal* velocity = dBodyGetLinearVel(from.body);
    const dReal* spin = dBodyGetAngularVel(from.body);
    const double rate = std::hypot(double(spin[0]), double(spin[1]), double(spin[2]));
    const double half = rate * time / 2;
    const double share = rate > 0 ? std::sin(half) / rate : 0;
    const dQuaternion by{dReal(std::cos(half)), dReal(share * double(spin[0])),
                         dReal(share * double(spin[1])), dReal(share * double(spin[2]))};
    dQuaternion turn;
    dQMultiply0(turn, by, from.turn.data());
    const auto at = [&](int i) {
        return dReal(double(from.place[std::size_t(i)]) + time * double(velocity[i]));
    };
    dBodySetPosition(from.body, at(0), at(1), at(2));
    dBodySetQuaternion(from.body, turn);
}

} // namespace ductile::ode
