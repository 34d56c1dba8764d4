// SPDX-License-Identifier: MIT
//
// Bodies of plastic_constraint.hpp.
#pragma once

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>

#include "ductile/bullet/draw.hpp"
#include "ductile/bullet/moving_bodies.hpp"
#include "ductile/bullet/plastic_constraint.hpp"
#include "ductile/bullet/precision_check.hpp"

namespace ductile::bullet {

namespace detail {

/// Told to Bullet that the constraint's bodies do not collide. A break may come in any of its
/// threads, and one body may have many constraints.
DUCTILE_INLINE bool parts(btRigidBody& body, btTypedConstraint& constraint) {
    for (int i = 0; i < body.getNumConstraintRefs(); ++i) {
        if (body.getConstraintRef(i) == &constraint) return true;
    }
    return false;
}
/// True where bodies that did not collide do so from now on.
DUCTILE_INLINE bool let_collide(btTypedConstraint& constraint) {
    static std::mutex mutex;
    const std::lock_guard lock(mutex);
    btRigidBody &a = constraint.getRigidBodyA(), &b = constraint.getRigidBodyB();
    const bool parted = parts(a, constraint) || parts(b, constraint);
    a.removeConstraintRef(&constraint);
    b.removeConstraintRef(&constraint);
    return parted;
}

/// Bullet solves the points that a pair had for good where it is not to collide any more.
DUCTILE_INLINE void end_contacts(btDynamicsWorld& world, btRigidBody& a, btRigidBody& b) {
    const btManifoldArray manifolds = manifolds_between(world, a, b);
    for (int i = 0; i < manifolds.size(); ++i) manifolds[i]->clearManifold();
}

} // namespace detail

// no built-in type: Bullet casts by type, e.g. when it draws
DUCTILE_INLINE PlasticConstraint::PlasticConstraint(btRigidBody& a, btRigidBody& b)
    : btTypedConstraint(plastic_constraint_type, a, b) {
    require_matching_precision();
    const auto moves = [](const btRigidBody& body) {
        return body.getInvMass() > 0 || body.isKinematicObject();
    };
    if (&a == &b) throw std::invalid_argument("PlasticConstraint.b: must not be body a itself");
    if (!moves(a) && !moves(b)) {
        throw std::invalid_argument(
            "PlasticConstraint.a, b: must not both be static, as no joint acts between such "
            "bodies");
    }
    find_driven();
    wait_for_world(&a, &b);
}

DUCTILE_INLINE PlasticConstraint::~PlasticConstraint() {
    leave_keepers();
    if (world_ != nullptr) abandon_world();
}

DUCTILE_INLINE bool PlasticConstraint::is_among_constraints_of(const btDynamicsWorld& world) const {
    for (int i = world.getNumConstraints() - 1; i >= 0; --i) {
        if (world.getConstraint(i) == this) return true;
    }
    return false;
}

DUCTILE_INLINE void PlasticConstraint::add_to(
    btDynamicsWorld& world, std::optional<bool> disable_collisions_between_bodies) {
    const bool is_there = is_among_constraints_of(world);
    if (world_ != nullptr && (world_ != &world || is_there)) {
        throw std::invalid_argument(
            "PlasticConstraint.add_to.world: must not be given while the constraint is in a world: "
            "remove_from that one first");
    }
    join_account(world);
    if (!is_there) world.addConstraint(this);
    world.removeAction(&end_of_tick_); // is there still after Bullet's own removeConstraint
    world.addAction(&end_of_tick_);
    world_ = &world;
    if (disable_collisions_between_bodies.value_or(!collides_unasked())) {
        parts_bodies_ = queries().broken(); // then once it is mended
        if (!parts_bodies_) part_bodies();
    }
    came_into_world();
}

DUCTILE_INLINE void PlasticConstraint::remove_from(btDynamicsWorld& world) {
    (void)queries().release(); // books what is open
    world.removeAction(&end_of_tick_);
    world.removeConstraint(this);
    parts_bodies_ = false;
    if (world_ != &world) return;
    world_ = nullptr;
    leave_account();
}

DUCTILE_INLINE std::size_t PlasticConstraint::island() const {
    return std::size_t((m_rbA.isStaticOrKinematicObject() ? m_rbB : m_rbA).getIslandTag());
}

DUCTILE_INLINE void PlasticConstraint::abandon_world() {
    world_->removeAction(&end_of_tick_);
    auto* world = dynamic_cast<btDiscreteDynamicsWorld*>(world_);
    if (world == nullptr) return;
    AllConstraints::of(*world).remove(this); // removeConstraint reads the bodies
    const auto& objects = world->getCollisionObjectArray();
    for (btRigidBody* body : {&m_rbA, &m_rbB}) {
        const bool is_alive =
            body == &getFixedBody() || objects.findLinearSearch(body) < objects.size();
        if (is_alive) body->removeConstraintRef(this);
    }
}

DUCTILE_INLINE void PlasticConstraint::require_bodies_in_world() const {
    for (const int side : {0, 1}) {
        if (!(body(side).getInvMass() > 0) || body(side).getBroadphaseHandle() != nullptr) continue;
        throw std::logic_error(std::string("PlasticConstraint.") + (side == 0 ? "a" : "b") +
                               ": is in no world: addRigidBody it before the first step, or remove "
                               "the joint before the body");
    }
}

DUCTILE_INLINE void PlasticConstraint::let_go() {
    setEnabled(false);
    parts_bodies_ = detail::let_collide(*this);
}

DUCTILE_INLINE void PlasticConstraint::hold_again() {
    setEnabled(true);
    if (std::exchange(parts_bodies_, false)) part_bodies();
}

/// By bodies that move alone: ground that holds a thousand joints would be asked of each of them in
/// every pair.
DUCTILE_INLINE void PlasticConstraint::part_bodies() {
    if (&m_rbA == &getFixedBody() || &m_rbB == &getFixedBody()) return;
    for (btRigidBody* body : {&m_rbA, &m_rbB}) {
        if (!body->isStaticObject()) body->addConstraintRef(this);
    }
    if (world_ != nullptr) detail::end_contacts(*world_, m_rbA, m_rbB);
}

DUCTILE_INLINE void PlasticConstraint::keep_life() {
    kept_life_.impulse = internalGetAppliedImpulse();
    kept_life_.enabled = isEnabled();
    for (const std::size_t side : {0u, 1u}) {
        const auto& driven = driven_[side];
        kept_life_.driven[side] =
            driven != nullptr ? std::make_unique<DrivenBody>(*driven) : nullptr;
    }
}

DUCTILE_INLINE void PlasticConstraint::put_life_back() {
    internalSetAppliedImpulse(kept_life_.impulse);
    if (kept_life_.enabled && !isEnabled()) hold_again();
    for (const std::size_t side : {0u, 1u}) {
        const auto& driven = kept_life_.driven[side];
        driven_[side] = driven != nullptr ? std::make_unique<DrivenBody>(*driven) : nullptr;
    }
}

DUCTILE_INLINE BodyState<double> PlasticConstraint::at_start(int side, double tick,
                                                             bool with_mass) {
    const btRigidBody& body = this->body(side);
    std::unique_ptr<DrivenBody>& driven = driven_[std::size_t(side)];
    if (!body.isKinematicObject()) {
        driven.reset();
        // a part asks for it as well, to know what is driven
        return with_mass || ahead_ ? body_state(body) : body_motion(body);
    }
    if (driven == nullptr) driven = std::make_unique<DrivenBody>();
    if (ahead_) return driven->at_start_ahead(body);
    const bool counts_ticks = world_ != nullptr;
    return driven->at_start(body, tick, !counts_ticks);
}

DUCTILE_INLINE BodyState<double> PlasticConstraint::at_end(int side, bool late) {
    DrivenBody* driven = driven_[std::size_t(side)].get();
    if (driven != nullptr) return ahead_ ? body_motion(body(side)) : driven->at_end();
    return late ? body_motion_of_last_tick(body(side)) : body_motion(body(side));
}

DUCTILE_INLINE void PlasticConstraint::lose_driven() {
    for (auto& driven : driven_) {
        if (driven != nullptr) driven->lose();
    }
}

DUCTILE_INLINE void PlasticConstraint::find_driven() {
    for (const int side : {0, 1}) {
        auto& driven = driven_[std::size_t(side)];
        driven.reset();
        if (!body(side).isKinematicObject()) continue;
        driven = std::make_unique<DrivenBody>();
        driven->find(body(side));
    }
}

DUCTILE_INLINE bool PlasticConstraint::is_awake() const {
    const auto awake = [](const btRigidBody& body) {
        return !body.isStaticOrKinematicObject() && body.isActive();
    };
    return isEnabled() && (awake(m_rbA) || awake(m_rbB));
}

DUCTILE_INLINE std::array<const void*, 2> PlasticConstraint::moving_bodies() const {
    const auto moving = [](const btRigidBody& body) {
        return body.isStaticOrKinematicObject() ? nullptr : &body;
    };
    return {moving(m_rbA), moving(m_rbB)};
}

DUCTILE_INLINE void PlasticConstraint::keep_awake() {
    for (btRigidBody* body : {&m_rbA, &m_rbB}) {
        if (body->isStaticOrKinematicObject() || !body->isActive()) continue;
        body->setDeactivationTime(0);
        if (body->getActivationState() == WANTS_DEACTIVATION) body->setActivationState(ACTIVE_TAG);
    }
}

DUCTILE_INLINE void PlasticConstraint::EndOfTick::debugDraw(btIDebugDraw* drawer) {
    if (drawer != nullptr) draw(owner_, *drawer);
}

DUCTILE_INLINE void draw(PlasticConstraint& constraint, btIDebugDraw& drawer) {
    draw(constraint.view(), drawer, constraint.getDbgDrawSize());
}

} // namespace ductile::bullet
