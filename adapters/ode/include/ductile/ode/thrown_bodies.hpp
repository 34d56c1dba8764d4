// SPDX-License-Identifier: MIT
//
// Bodies that hands threw, or joined to something, since the last frame: velocities that do not fit
// what joins them are struck (frame/part_engine.hpp), so that members know the blow.
//
// Not thread-safe.
#pragma once

#include <ode/ode.h>

#include <cstddef>
#include <span>
#include <vector>

#include "ductile/ode/convert.hpp"
#include "ductile/world/left_motions.hpp"

namespace ductile::ode {

class ThrownBodies {
  public:
    /// A frame is over.
    void leave(std::span<const dBodyID> bodies) {
        for (dBodyID body : bodies) left_.leave(body, contact_body(body), joints_of(body));
        left_.sort();
    }
    /// Nothing is known of how it was left.
    void clear() noexcept { left_.clear(); }
    /// A frame begins.
    void find(std::span<const dBodyID> bodies) {
        thrown_.clear();
        for (dBodyID body : bodies) {
            if (!can_move(body)) continue;
            if (left_.is_left(body, contact_body(body), joints_of(body))) continue;
            thrown_.push_back(body);
        }
    }
    [[nodiscard]] std::span<const dBodyID> bodies() const noexcept { return thrown_; }
    /// They are struck.
    void strike() noexcept { thrown_.clear(); }
    /// To be called before it is destroyed.
    void forget(dBodyID body) { std::erase(thrown_, body); }

  private:
    /// But contacts.
    [[nodiscard]] static std::size_t joints_of(dBodyID body) {
        std::size_t sum = 0;
        for (int i = 0, count = dBodyGetNumJoints(body); i < count; ++i) {
            const dJointID joint = dBodyGetJoint(body, i);
            if (dJointGetType(joint) == dJointTypeContact || dJointIsEnabled(joint) == 0) continue;
            sum += joint_mark(joint, dJointGetBody(joint, 0), dJointGetBody(joint, 1));
        }
        return sum;
    }

    LeftMotions left_;
    std::vector<dBodyID> thrown_;
};

} // namespace ductile::ode
