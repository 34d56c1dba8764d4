// SPDX-License-Identifier: MIT
//
// The forces that a user applied for a step, kept so that each part of the step has them: Bullet
// forgets forces at the end of each part.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <LinearMath/btVector3.h>

#include <utility>
#include <vector>

namespace ductile::bullet {

/// The force that has to be applied for `sum`: Bullet multiplies by the body's factor whatever is
/// applied. Zero where the factor is.
[[nodiscard]] inline btVector3 unweighted(const btVector3& sum, const btVector3& factor) {
    btVector3 result(0, 0, 0);
    for (int i = 0; i < 3; ++i) {
        if (factor[i] != 0) result[i] = sum[i] / factor[i];
    }
    return result;
}

/// Of rigid bodies. Not thread-safe. Where bodies leave the world between `hold` and `apply`,
/// `forget_gone` comes in between.
class HeldForces {
  public:
    /// True where there are the same as the last time.
    bool hold(btCollisionWorld& world) {
        std::swap(held_, before_);
        held_.clear();
        const auto& objects = world.getCollisionObjectArray();
        for (int i = 0; i < objects.size(); ++i) {
            btRigidBody* body = btRigidBody::upcast(objects[i]);
            if (body == nullptr || body->isStaticOrKinematicObject()) continue;
            if (body->getTotalForce().isZero() && body->getTotalTorque().isZero()) continue;
            const btVector3 force = unweighted(body->getTotalForce(), body->getLinearFactor());
            const btVector3 torque = unweighted(body->getTotalTorque(), body->getAngularFactor());
            held_.push_back({body, force, torque});
        }
        return held_ == before_;
    }
    /// What acted on bodies that are not in the world any more.
    void forget_gone(const btCollisionWorld& world) {
        const auto& objects = world.getCollisionObjectArray();
        std::erase_if(held_, [&objects](const Held& held) {
            return objects.findLinearSearch2(held.body) < 0;
        });
    }
    void apply() const {
        apply([](const btRigidBody&) { return true; });
    }
    /// To those of the bodies alone of which `is_meant`.
    template <class IsMeant>
    void apply(const IsMeant& is_meant) const {
        for (const auto& [body, force, torque] : held_) {
            if (!is_meant(*body)) continue;
            body->applyCentralForce(force);
            body->applyTorque(torque);
        }
    }

  private:
    struct Held {
        btRigidBody* body;
        btVector3 force, torque;
        [[nodiscard]] bool operator==(const Held& other) const {
            return body == other.body && force == other.force && torque == other.torque;
        }
    };

    std::vector<Held> held_, before_;
};

} // namespace ductile::bullet
