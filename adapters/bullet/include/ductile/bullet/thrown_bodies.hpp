// SPDX-License-Identifier: MIT
//
// Bodies that hands threw, or joined to something, since the last frame: velocities that do not fit
// what joins them are struck (frame/part_engine.hpp), so that members know the blow.
//
// Not thread-safe.
#pragma once

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "ductile/bullet/convert.hpp"
#include "ductile/bullet/moving_bodies.hpp"
#include "ductile/world/left_motions.hpp"

namespace ductile::bullet {

class ThrownBodies {
  public:
    /// A frame is over; `islands`: sorted, those that matter, as the last tick had them.
    void leave(const btDiscreteDynamicsWorld& world, const std::vector<int>& islands) {
        left_.clear();
        if (islands.empty()) return;
        for (const btRigidBody* body : MovingBodies::all(world)) {
            left_.leave(body, contact_body(*body), 0);
        }
        left_.leave(&world, {}, joints_of(world));
        left_.sort();
    }
    /// A frame begins.
    void find(const btDiscreteDynamicsWorld& world, const std::vector<int>& islands) {
        any_ = false;
        if (islands.empty()) return;
        const auto is_thrown = [&](const btRigidBody* body) {
            const int island = body->getIslandTag(); // none yet, of a body that is new
            return !body->isStaticOrKinematicObject() &&
                   (island < 0 || std::binary_search(islands.begin(), islands.end(), island)) &&
                   !left_.is_left(body, contact_body(*body), 0);
        };
        const auto bodies = MovingBodies::all(world);
        any_ = !left_.is_left(&world, {}, joints_of(world)) ||
               std::any_of(bodies.begin(), bodies.end(), is_thrown);
    }
    [[nodiscard]] bool any() const noexcept { return any_; }
    /// They are struck; whether there were any.
    bool strike() noexcept { return std::exchange(any_, false); }

  private:
    [[nodiscard]] static std::size_t joints_of(const btDiscreteDynamicsWorld& world) {
        std::size_t sum = 0;
        for (int i = 0; i < world.getNumConstraints(); ++i) {
            const btTypedConstraint& joint = *world.getConstraint(i);
            if (!joint.isEnabled()) continue;
            sum += joint_mark(&joint, &joint.getRigidBodyA(), &joint.getRigidBodyB());
        }
        return sum;
    }

    LeftMotions left_;
    bool any_ = false;
};

} // namespace ductile::bullet
