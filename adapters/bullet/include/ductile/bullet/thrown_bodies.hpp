// SPDX-License-Identifier: MIT
//
// Bodies that hands threw, or joined to something, since the last frame. Velocities that do not fit
// the constraints of Bullet's are struck (frame/part_engine.hpp): pulled at with the mean force of
// a part, what hangs together with them could bear a blow that it does not.
//
// Not thread-safe.
#pragma once

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include <cstddef>
#include <span>
#include <vector>

#include "ductile/bullet/convert.hpp"
#include "ductile/bullet/plastic_constraint.hpp"
#include "ductile/world/left_motions.hpp"

namespace ductile::bullet {

class ThrownBodies {
  public:
    /// A frame is over.
    void leave(btDiscreteDynamicsWorld& world) {
        left_.clear();
        const std::size_t joints = look(world, [this](const btRigidBody& body, const auto&) {
            left_.leave(&body, contact_body(body), 0);
        });
        left_.leave(&world, {}, joints);
    }
    /// A frame begins; `matters(body)`: its island does. Plastic joints see themselves what they
    /// are thrown with.
    template <class Matters>
    void find(btDiscreteDynamicsWorld& world, const Matters& matters) {
        thrown_.clear();
        const std::size_t joints = look(world, [](const auto&, const auto&) {});
        if (!left_.is_left(&world, {}, joints)) left_.clear(); // others than they were
        look(world, [&](const btRigidBody& body, const btRigidBody& mate) {
            if (left_.is_left(&body, contact_body(body), 0)) return;
            if (matters(body) || matters(mate)) thrown_.push_back(&body);
        });
    }
    [[nodiscard]] std::span<const btRigidBody* const> bodies() const noexcept { return thrown_; }
    /// They are struck.
    void strike() noexcept { thrown_.clear(); }

  private:
    /// At what moves of Bullet's own constraints, and at what is on the other side; the sum of
    /// their marks.
    template <class See>
    static std::size_t look(btDiscreteDynamicsWorld& world, const See& see) {
        std::size_t sum = 0;
        for (int i = 0; i < world.getNumConstraints(); ++i) {
            btTypedConstraint& joint = *world.getConstraint(i);
            if (as_plastic(joint) != nullptr || !joint.isEnabled()) continue;
            const btRigidBody &a = joint.getRigidBodyA(), &b = joint.getRigidBodyB();
            sum += joint_mark(&joint, &a, &b);
            if (!a.isStaticOrKinematicObject()) see(a, b);
            if (!b.isStaticOrKinematicObject()) see(b, a);
        }
        return sum;
    }

    LeftMotions left_;
    std::vector<const btRigidBody*> thrown_;
};

} // namespace ductile::bullet
