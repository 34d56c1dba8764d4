// SPDX-License-Identifier: MIT
//
// Some of a world's bodies, with all that holds or touches them: what is put back, metered, moved
// and ticked alone while the rest of the world stays as it is (local_tick.hpp).
//
// Not thread-safe. Bodies and constraints must stay in the world as long as they are in it.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "ductile/bullet/moving_bodies.hpp"
#include "ductile/bullet/plastic_constraint.hpp"

namespace ductile::bullet {

class LocalScope {
  public:
    static constexpr int nowhere = -1;

    /// Of bodies that are not static, in any order.
    void set(btDiscreteDynamicsWorld& world, std::vector<btRigidBody*> bodies) {
        clear();
        bodies_ = std::move(bodies);
        std::sort(bodies_.begin(), bodies_.end(), [](const btRigidBody* x, const btRigidBody* y) {
            return x->getWorldArrayIndex() < y->getWorldArrayIndex();
        });
        numbers_.assign(std::size_t(world.getNumCollisionObjects()), nowhere);
        for (std::size_t i = 0; i < bodies_.size(); ++i) {
            numbers_[std::size_t(bodies_[i]->getWorldArrayIndex())] = int(i);
        }
        for (int i = 0; i < world.getNumConstraints(); ++i) {
            btTypedConstraint* constraint = world.getConstraint(i);
            if (!has(*constraint)) continue;
            constraints_.push_back(constraint);
            if (PlasticConstraint* joint = as_plastic(*constraint)) joints_.push_back({joint, i});
        }
        find_manifolds(*world.getDispatcher());
    }
    void clear() {
        bodies_.clear();
        constraints_.clear();
        joints_.clear();
        manifolds_.clear();
        numbers_.clear();
    }

    [[nodiscard]] bool has(const btCollisionObject& object) const noexcept {
        return number(object) != nowhere;
    }
    /// One of its bodies.
    [[nodiscard]] bool has(const btTypedConstraint& constraint) const noexcept {
        return has(constraint.getRigidBodyA()) || has(constraint.getRigidBodyB());
    }
    /// Among `bodies`.
    [[nodiscard]] int number(const btCollisionObject& object) const noexcept {
        const int place = object.getWorldArrayIndex();
        const bool known = place >= 0 && place < int(numbers_.size());
        return known ? numbers_[std::size_t(place)] : nowhere;
    }
    /// In the world's order.
    [[nodiscard]] std::span<btRigidBody* const> bodies() const noexcept { return bodies_; }
    /// Of a constraint that has one of the bodies; in the world's order.
    [[nodiscard]] std::span<btTypedConstraint* const> constraints() const noexcept {
        return constraints_;
    }
    /// Those of them that are plastic joints, and their places among the world's constraints.
    struct Joint {
        PlasticConstraint* joint;
        int place;
    };
    [[nodiscard]] std::span<const Joint> joints() const noexcept { return joints_; }
    /// That have one of the bodies, with contact points or without.
    [[nodiscard]] std::span<btPersistentManifold* const> manifolds() const noexcept {
        return manifolds_;
    }
    void find_manifolds(btDispatcher& dispatcher) {
        manifolds_.clear();
        for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
            btPersistentManifold* manifold = dispatcher.getManifoldByIndexInternal(i);
            if (has(*manifold->getBody0()) || has(*manifold->getBody1())) {
                manifolds_.push_back(manifold);
            }
        }
    }
    [[nodiscard]] std::vector<btPersistentManifold*>& listed_manifolds() noexcept {
        return manifolds_;
    }

  private:
    std::vector<btRigidBody*> bodies_;
    std::vector<btTypedConstraint*> constraints_;
    std::vector<Joint> joints_;
    std::vector<btPersistentManifold*> manifolds_;
    std::vector<int> numbers_; ///< by place in the world
};

// ---- what of a world there is in a scope; null: all, of bodies those that are not static

[[nodiscard]] inline std::span<btRigidBody* const> bodies_of(const btDiscreteDynamicsWorld& world,
                                                             const LocalScope* scope) {
    return scope != nullptr ? scope->bodies() : MovingBodies::all(world);
}
[[nodiscard]] inline std::span<btTypedConstraint* const> constraints_of(
    btDiscreteDynamicsWorld& world, const LocalScope* scope) {
    if (scope != nullptr) return scope->constraints();
    const auto& all = AllConstraints::of(world);
    if (all.size() == 0) return {};
    return {&all[0], std::size_t(all.size())};
}
[[nodiscard]] inline std::span<btPersistentManifold* const> manifolds_of(btDispatcher& dispatcher,
                                                                         const LocalScope* scope) {
    if (scope != nullptr) return scope->manifolds();
    return {dispatcher.getInternalManifoldPointer(), std::size_t(dispatcher.getNumManifolds())};
}

} // namespace ductile::bullet
