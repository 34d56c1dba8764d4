// SPDX-License-Identifier: MIT
//
// Bodies of local_scope.hpp.
#pragma once

#include <algorithm>
#include <utility>

#include "ductile/bullet/local_scope.hpp"

namespace ductile::bullet {

DUCTILE_INLINE void LocalScope::set(btDiscreteDynamicsWorld& world,
                                    std::vector<btRigidBody*> bodies) {
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
        if (!has(constraint->getRigidBodyA()) && !has(constraint->getRigidBodyB())) continue;
        constraints_.push_back(constraint);
        if (PlasticConstraint* joint = as_plastic(*constraint)) joints_.push_back({joint, i});
    }
    for (const Joint& joint : joints_) {
        sorted_joints_.push_back(static_cast<const btTypedConstraint*>(joint.joint));
    }
    std::sort(sorted_joints_.begin(), sorted_joints_.end());
    find_manifolds(*world.getDispatcher());
}

DUCTILE_INLINE void LocalScope::clear() {
    bodies_.clear();
    constraints_.clear();
    joints_.clear();
    sorted_joints_.clear();
    manifolds_.clear();
    numbers_.clear();
}

DUCTILE_INLINE bool LocalScope::has_joint(const void* constraint) const noexcept {
    return std::binary_search(sorted_joints_.begin(), sorted_joints_.end(), constraint);
}

DUCTILE_INLINE void LocalScope::find_manifolds(btDispatcher& dispatcher) {
    manifolds_.clear();
    for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
        btPersistentManifold* manifold = dispatcher.getManifoldByIndexInternal(i);
        if (has(*manifold->getBody0()) || has(*manifold->getBody1())) {
            manifolds_.push_back(manifold);
        }
    }
}

} // namespace ductile::bullet
