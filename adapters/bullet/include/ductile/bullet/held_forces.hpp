// SPDX-License-Identifier: MIT
//
// The forces that a user applied for a step, kept so that each part of the step has them: Bullet
// forgets forces at the end of each part.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <LinearMath/btVector3.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "ductile/bullet/convert.hpp"
#include "ductile/world/placed_forces.hpp"

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
        placed_.begin([this](const btRigidBody* body) { return holds(body); });
        return held_ == before_;
    }
    /// One that was applied at a place, world [N, m]: for the coming frame it goes along with that.
    void place(btRigidBody& body, const Vector3<double>& force, const Vector3<double>& at) {
        placed_.add(&body, to_core(body.getCenterOfMassTransform()),
                    force.cwiseProduct(to_core(body.getLinearFactor())), at);
    }
    /// What acted on bodies that are not in the world any more.
    void forget_gone(const btCollisionWorld& world) {
        const auto& objects = world.getCollisionObjectArray();
        const auto is_gone = [&objects](btRigidBody* body) {
            return objects.findLinearSearch2(body) < 0;
        };
        std::erase_if(held_, [&](const Held& held) { return is_gone(held.body); });
        placed_.forget(is_gone);
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
    /// Of these bodies, where they are now, as the places of forces went along.
    template <class IsMeant>
    void follow(const IsMeant& is_meant) const {
        placed_.follow(
            [](const btRigidBody* body) {
                return to_core(body->getCenterOfMassTransform().getBasis());
            },
            [&](btRigidBody* body, const Vector3<double>& torque) {
                if (is_meant(*body)) body->applyTorque(to_bullet(torque));
            });
    }

  private:
    struct Held {
        btRigidBody* body;
        btVector3 force, torque;
        [[nodiscard]] bool operator==(const Held& other) const {
            return body == other.body && force == other.force && torque == other.torque;
        }
    };

    [[nodiscard]] bool holds(const btRigidBody* body) const {
        return std::any_of(held_.begin(), held_.end(),
                           [body](const Held& held) { return held.body == body; });
    }

    std::vector<Held> held_, before_;
    PlacedForces<btRigidBody*> placed_;
};

} // namespace ductile::bullet
