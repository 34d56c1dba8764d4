// SPDX-License-Identifier: MIT
//
// Bodies of plastic_constraint.hpp.
#pragma once

#include "ductile/bullet/draw.hpp"
#include "ductile/bullet/plastic_constraint.hpp"
#include "ductile/bullet/precision_check.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::bullet {

// no built-in type: Bullet casts by type, e.g. when it draws
DUCTILE_INLINE PlasticConstraint::PlasticConstraint(btRigidBody& a, btRigidBody& b,
                                                    bool parts_bodies)
    : btTypedConstraint(MAX_CONSTRAINT_TYPE, a, b), parts_bodies_(parts_bodies) {
    require_matching_precision();
}

DUCTILE_INLINE void PlasticConstraint::enter(btDynamicsWorld& world,
                                             bool disable_collisions_between_bodies) {
    join(world);
    world.addConstraint(this, disable_collisions_between_bodies);
    world.addAction(&end_of_tick_);
    world_ = &world;
}

DUCTILE_INLINE void PlasticConstraint::remove_from(btDynamicsWorld& world) {
    (void)queries().release(); // books what is open
    world.removeAction(&end_of_tick_);
    world.removeConstraint(this);
    world_ = nullptr;
    leave();
}

DUCTILE_INLINE bool PlasticConstraint::is_awake() const {
    const auto awake = [](const btRigidBody& body) {
        return !body.isStaticOrKinematicObject() && body.isActive();
    };
    return isEnabled() && (awake(m_rbA) || awake(m_rbB));
}

DUCTILE_INLINE void PlasticConstraint::EndOfTick::debugDraw(btIDebugDraw* drawer) {
    if (drawer != nullptr) draw(owner_, *drawer);
}

DUCTILE_INLINE void draw(PlasticConstraint& constraint, btIDebugDraw& drawer) {
    draw(constraint.view(), drawer, constraint.getDbgDrawSize());
}

} // namespace ductile::bullet
