// SPDX-License-Identifier: MIT
//
// Numbers of islands: of all that plastic joints, contacts that are there, and others' joints hold
// together.
//
// Not thread-safe.
#pragma once

#include <ode/ode.h>

#include <cstddef>
#include <vector>

#include "ductile/ode/convert.hpp"
#include "ductile/vocabulary/address_book.hpp"

namespace ductile::ode {

class IslandNumbers {
  public:
    /// Bodies hang together otherwise.
    void clear() {
        numbers_.clear();
        count_ = 0;
    }
    /// From 0; -1: of a joint that has no body that can move.
    [[nodiscard]] int of(dJointID joint) {
        const dBodyID a = dJointGetBody(joint, 0), b = dJointGetBody(joint, 1);
        const dBodyID body = can_move(a) ? a : b;
        if (!can_move(body)) return -1;
        if (const int* known = numbers_.find(body)) return *known;
        found_.assign(1, body);
        numbers_[body] = count_;
        for (std::size_t at = 0; at < found_.size(); ++at) {
            for (int i = 0, joints = dBodyGetNumJoints(found_[at]); i < joints; ++i) {
                const dJointID holds = dBodyGetJoint(found_[at], i);
                for (const int side : {0, 1}) {
                    const dBodyID other = dJointGetBody(holds, side);
                    if (!can_move(other) || numbers_.find(other) != nullptr) continue;
                    numbers_[other] = count_;
                    found_.push_back(other);
                }
            }
        }
        return count_++;
    }

  private:
    AddressMap<int> numbers_; ///< by body
    std::vector<dBodyID> found_;
    int count_ = 0;
};

} // namespace ductile::ode
