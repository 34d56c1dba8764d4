// SPDX-License-Identifier: MIT
//
// Bodies that hands threw, or joined to something, since the last frame. Velocities that do not fit
// the joints of ODE's are struck (frame/part_engine.hpp): pulled at with the mean force of a part,
// what hangs together with them could bear a blow that it does not.
//
// Not thread-safe.
#pragma once

#include <ode/ode.h>

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "ductile/ode/convert.hpp"
#include "ductile/ode/plastic_constraint.hpp"
#include "ductile/world/left_motions.hpp"

namespace ductile::ode {

class ThrownBodies {
  public:
    /// A frame is over.
    void leave(std::span<const dBodyID> bodies) {
        left_.clear();
        for (dBodyID body : bodies) {
            if (is_joined(body)) left_.leave(body, contact_body(body), joints_of(body));
        }
    }
    /// A frame begins, with these plastic joints: these see themselves what they are thrown with.
    /// True where anything joined is as it was left.
    bool find(std::span<const dBodyID> bodies, std::span<PlasticConstraint* const> plastic) {
        thrown_.clear();
        bool as_left = true;
        for (dBodyID body : bodies) {
            if (!is_joined(body)) continue;
            if (left_.is_left(body, contact_body(body), joints_of(body))) continue;
            as_left = false;
            if (has_own_joints(body, plastic)) thrown_.push_back(body);
        }
        return as_left;
    }
    [[nodiscard]] std::span<const dBodyID> bodies() const noexcept { return thrown_; }
    /// They are struck.
    void strike() noexcept { thrown_.clear(); }
    /// To be called before it is destroyed.
    void forget(dBodyID body) {
        std::erase(thrown_, body);
        left_.forget(body);
    }

  private:
    [[nodiscard]] static bool is_joined(dBodyID body) {
        return can_move(body) && dBodyGetNumJoints(body) > 0;
    }
    /// No contact, and not switched off.
    [[nodiscard]] static bool joins(dJointID joint) {
        return dJointGetType(joint) != dJointTypeContact && dJointIsEnabled(joint) != 0;
    }
    [[nodiscard]] static std::size_t joints_of(dBodyID body) {
        std::size_t sum = 0;
        for (int i = 0, count = dBodyGetNumJoints(body); i < count; ++i) {
            const dJointID joint = dBodyGetJoint(body, i);
            if (!joins(joint)) continue;
            sum += joint_mark(joint, dJointGetBody(joint, 0), dJointGetBody(joint, 1));
        }
        return sum;
    }
    /// ODE's.
    [[nodiscard]] static bool has_own_joints(dBodyID body,
                                             std::span<PlasticConstraint* const> plastic) {
        for (int i = 0, count = dBodyGetNumJoints(body); i < count; ++i) {
            const dJointID joint = dBodyGetJoint(body, i);
            const auto is_it = [joint](const PlasticConstraint* each) {
                return each->id() == joint;
            };
            if (joins(joint) && std::none_of(plastic.begin(), plastic.end(), is_it)) return true;
        }
        return false;
    }

    LeftMotions left_;
    std::vector<dBodyID> thrown_;
};

} // namespace ductile::ode
