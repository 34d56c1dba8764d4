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

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "ductile/ode/convert.hpp"

namespace ductile::ode {

class HalfAhead {
  public:
    /// Moves the bodies that are awake on by `time` [s], which may be 0, and remembers where they
    /// are then. True where one did move.
    bool move(std::span<const dBodyID> bodies, double time) {
        middles_.clear();
        bool moved = false;
        for (dBodyID body : bodies) {
            const auto here = [body] {
                Middle middle{body, {}, {}};
                std::copy_n(dBodyGetPosition(body), 3, middle.place.begin());
                std::copy_n(dBodyGetQuaternion(body), 4, middle.turn.begin());
                return middle;
            };
            middles_.push_back(here());
            if (!(time > 0) || dBodyIsEnabled(body) == 0 || !put(middles_.back(), time)) continue;
            middles_.back() = here();
            moved = true;
        }
        return moved;
    }
    /// After ODE's step: from there on by `time` [s] with the velocities that they have now.
    void move_on(double time) const {
        for (const Middle& middle : middles_) {
            if (dBodyIsEnabled(middle.body) != 0) (void)put(middle, time);
        }
    }

  private:
    struct Middle {
        dBodyID body;
        std::array<dReal, 3> place;
        std::array<dReal, 4> turn; ///< quaternion
    };
    /// False where it is there already.
    static bool put(const Middle& from, double time) {
        constexpr double nothing = 1e-16; // [m | rad]
        const dReal* velocity = dBodyGetLinearVel(from.body);
        const dReal* spin = dBodyGetAngularVel(from.body);
        const double rate = norm(to_core(spin));
        const double half = rate * time / 2;
        if (!(std::max(norm(to_core(velocity)) * time, half) > nothing)) return false;
        std::array<dReal, 4> turn = from.turn;
        if (half > 0) {
            const double share = std::sin(half) / rate;
            const dQuaternion by{dReal(std::cos(half)), dReal(share * double(spin[0])),
                                 dReal(share * double(spin[1])), dReal(share * double(spin[2]))};
            dQMultiply0(turn.data(), by, from.turn.data());
        }
        std::array<dReal, 3> at{};
        for (std::size_t i = 0; i < at.size(); ++i) {
            at[i] = dReal(double(from.place[i]) + time * double(velocity[i]));
        }
        const bool goes = !std::equal(at.begin(), at.end(), dBodyGetPosition(from.body));
        const bool turns = !std::equal(turn.begin(), turn.end(), dBodyGetQuaternion(from.body));
        if (goes) dBodySetPosition(from.body, at[0], at[1], at[2]);
        if (turns) dBodySetQuaternion(from.body, turn.data());
        return goes || turns;
    }

    std::vector<Middle> middles_;
};

} // namespace ductile::ode
