// SPDX-License-Identifier: MIT
//
// Bodies of world_snapshot.hpp.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>

#include <algorithm>
#include <utility>

#include "ductile/bullet/held_forces.hpp"
#include "ductile/bullet/moving_bodies.hpp"
#include "ductile/bullet/plastic_constraint.hpp"
#include "ductile/bullet/world_snapshot.hpp"

namespace ductile::bullet {

DUCTILE_INLINE bool WorldSnapshot::Manifold::is_before(const Manifold& other) const {
    const std::less<const btCollisionObject*> before;
    if (a != other.a) return before(a, other.a);
    if (b != other.b) return before(b, other.b);
    return order < other.order;
}

DUCTILE_INLINE void WorldSnapshot::take(btDiscreteDynamicsWorld& world, btConstraintSolver& solver,
                                        const LocalScope* scope) {
    bodies_.clear();
    constraints_.clear();
    for (btRigidBody* body : bodies_of(world, scope)) take_body(*body);
    for (btTypedConstraint* constraint : constraints_of(world, scope)) take_constraint(*constraint);
    take_manifolds(*world.getDispatcher(), scope);
    const auto* sweeps = dynamic_cast<btSequentialImpulseConstraintSolver*>(&solver);
    if (sweeps != nullptr) seed_ = sweeps->getRandSeed();
}

DUCTILE_INLINE void WorldSnapshot::take_body(btRigidBody& body) {
    bodies_.push_back({&body, body.getWorldTransform(), body.getInterpolationWorldTransform(),
                       body.getLinearVelocity(), body.getAngularVelocity(),
                       body.getInterpolationLinearVelocity(),
                       body.getInterpolationAngularVelocity(),
                       unweighted(body.getTotalForce(), body.getLinearFactor()),
                       unweighted(body.getTotalTorque(), body.getAngularFactor()),
                       body.getDeactivationTime(), body.getHitFraction(), body.getActivationState(),
                       body.getIslandTag(), body.getCompanionId()});
}
DUCTILE_INLINE void WorldSnapshot::take_constraint(btTypedConstraint& constraint) {
    if (PlasticConstraint* plastic = as_plastic(constraint)) plastic->keep_all();
    constraints_.push_back(
        {&constraint, constraint.internalGetAppliedImpulse(), constraint.isEnabled()});
}

DUCTILE_INLINE void WorldSnapshot::put_back(btDiscreteDynamicsWorld& world,
                                            btConstraintSolver& solver, LocalScope* scope,
                                            const std::function<void()>& collide) {
    for (const Body& kept : bodies_) {
        btRigidBody& body = *kept.body;
        if (scope != nullptr && !scope->has(body)) continue;
        body.setWorldTransform(kept.transform);
        body.setLinearVelocity(kept.velocity);
        body.setAngularVelocity(kept.spin);
        body.updateInertiaTensor();
        body.setInterpolationWorldTransform(kept.interpolated);
        body.setInterpolationLinearVelocity(kept.interpolated_velocity);
        body.setInterpolationAngularVelocity(kept.interpolated_spin);
        body.clearForces();
        body.applyCentralForce(kept.force);
        body.applyTorque(kept.torque);
        body.forceActivationState(kept.activation);
        body.setDeactivationTime(kept.deactivation_time);
        body.setHitFraction(kept.hit_fraction);
        body.setIslandTag(kept.island);
        body.setCompanionId(kept.companion);
    }
    if (!write_manifolds(*world.getDispatcher(), scope)) {
        scope != nullptr ? collide() : world.performDiscreteCollisionDetection();
        (void)write_manifolds(*world.getDispatcher(), scope);
    }
    for (const Constraint& kept : constraints_) {
        if (scope != nullptr && !scope->has(*kept.constraint)) continue;
        if (PlasticConstraint* plastic = as_plastic(*kept.constraint)) {
            plastic->put_all_back();
            continue;
        }
        kept.constraint->internalSetAppliedImpulse(kept.impulse);
        kept.constraint->setEnabled(kept.enabled);
    }
    auto* sweeps = dynamic_cast<btSequentialImpulseConstraintSolver*>(&solver);
    if (sweeps != nullptr) sweeps->setRandSeed(seed_);
}

DUCTILE_INLINE void WorldSnapshot::leave_out(const LocalScope& scope) {
    std::erase_if(bodies_, [&scope](const Body& kept) { return scope.has(*kept.body); });
    std::erase_if(constraints_,
                  [&scope](const Constraint& kept) { return scope.has(*kept.constraint); });
    std::erase_if(manifolds_, [&scope](const Manifold& kept) {
        return scope.has(*kept.a) || scope.has(*kept.b);
    });
}

DUCTILE_INLINE void WorldSnapshot::list_manifolds(btDispatcher& dispatcher, const LocalScope* scope,
                                                  std::vector<Manifold>& manifolds,
                                                  std::vector<btPersistentManifold*>& in_order) {
    manifolds.clear();
    in_order.clear();
    for (btPersistentManifold* manifold : manifolds_of(dispatcher, scope)) {
        manifolds.push_back({manifold->getBody0(), manifold->getBody1(), int(in_order.size())});
        in_order.push_back(manifold);
    }
    sort(manifolds);
}

DUCTILE_INLINE void WorldSnapshot::sort(std::vector<Manifold>& manifolds) {
    const auto before = [](const Manifold& x, const Manifold& y) { return x.is_before(y); };
    std::sort(manifolds.begin(), manifolds.end(), before);
}

DUCTILE_INLINE void WorldSnapshot::take_manifolds(btDispatcher& dispatcher,
                                                  const LocalScope* scope) {
    manifolds_.clear();
    points_.clear();
    sorted_ = false;
    for (const btPersistentManifold* manifold : manifolds_of(dispatcher, scope)) {
        const int count = manifold->getNumContacts();
        manifolds_.push_back({manifold->getBody0(), manifold->getBody1(), int(manifolds_.size()),
                              points_.size(), count});
        for (int k = 0; k < count; ++k) points_.push_back(manifold->getContactPoint(k));
    }
}

DUCTILE_INLINE bool WorldSnapshot::write_manifolds(btDispatcher& dispatcher,
                                                   const LocalScope* scope) {
    if (!std::exchange(sorted_, true)) sort(manifolds_);
    list_manifolds(dispatcher, scope, now_, listed_);
    auto kept = manifolds_.cbegin();
    const std::less<const btCollisionObject*> before;
    bool all = true;
    const auto is_missed = [scope](const Manifold& gone) {
        return gone.count > 0 && (scope == nullptr || scope->has(*gone.a) || scope->has(*gone.b));
    };
    for (const Manifold& here : now_) {
        btPersistentManifold& manifold = *listed_[std::size_t(here.order)];
        const auto gone = [&] {
            return before(kept->a, here.a) || (kept->a == here.a && before(kept->b, here.b));
        };
        for (; kept != manifolds_.cend() && gone(); ++kept) all = all && !is_missed(*kept);
        // its points are overwritten: what a user keeps with a point has to outlive this
        manifold.setNumContacts(0);
        if (kept == manifolds_.cend() || kept->a != here.a || kept->b != here.b) continue;
        for (int k = 0; k < kept->count; ++k) {
            manifold.addManifoldPoint(points_[kept->first + std::size_t(k)]);
        }
        ++kept;
    }
    for (; kept != manifolds_.cend(); ++kept) all = all && !is_missed(*kept);
    return all;
}

} // namespace ductile::bullet
