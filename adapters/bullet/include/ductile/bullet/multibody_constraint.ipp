// SPDX-License-Identifier: MIT
//
// Bodies of multibody_constraint.hpp.
#pragma once

#include <BulletCollision/CollisionDispatch/btSimulationIslandManager.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>
#include <vector>

#include "ductile/bullet/multibody_constraint.hpp"
#include "ductile/bullet/precision_check.hpp"
#include "ductile/numeric/lu.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile::bullet {

// arguments are evaluated in any order: none may read a link that is not there
DUCTILE_INLINE MultiBodyPlasticConstraint::MultiBodyPlasticConstraint(
    btMultiBody& body, int link, int rows, btMultibodyLink::eFeatherstoneJointType type,
    const char* wanted)
    : btMultiBodyConstraint(&body, &body, link,
                            body.getLink(checked(body, link, type, wanted)).m_parent, rows, true,
                            MAX_MULTIBODY_CONSTRAINT_TYPE) {}

DUCTILE_INLINE int MultiBodyPlasticConstraint::checked(const btMultiBody& body, int link,
                                                       btMultibodyLink::eFeatherstoneJointType type,
                                                       const char* wanted) {
    require_matching_precision();
    if (link < 0 || link >= body.getNumLinks() || body.getLink(link).m_jointType != type) {
        check::fail("MultiBodyPlasticConstraint.link", double(link), "", wanted);
    }
    return link;
}

DUCTILE_INLINE MultiBodyPlasticConstraint::~MultiBodyPlasticConstraint() {
    leave_keepers();
    if (world_ != nullptr) remove_from(*world_);
}

DUCTILE_INLINE void MultiBodyPlasticConstraint::add_to(btMultiBodyDynamicsWorld& world) {
    if (world_ != nullptr) {
        throw std::invalid_argument(
            "MultiBodyPlasticConstraint.add_to.world: must not be given while the constraint is in "
            "a world: remove_from that one first");
    }
    if (collider() == nullptr) {
        throw std::invalid_argument(
            "MultiBodyPlasticConstraint.body: must have a collider that is not static, or "
            "Bullet never solves its joints");
    }
    if (!world.getSimulationIslandManager()->getSplitIslands()) {
        throw std::invalid_argument(
            "MultiBodyPlasticConstraint.world: must split islands, or Bullet never solves the "
            "joints of multibodies");
    }
    join_account(world);
    world.addMultiBodyConstraint(this);
    world.addAction(&action_);
    world_ = &world;
}

DUCTILE_INLINE void MultiBodyPlasticConstraint::remove_from(btMultiBodyDynamicsWorld& world) {
    world.removeAction(&action_);
    world.removeAction(&release_action_);
    world.removeMultiBodyConstraint(this);
    leave_account();
    world_ = nullptr;
    phase_ = Phase::idle;
}

DUCTILE_INLINE void MultiBodyPlasticConstraint::hand_back(double energy, const Values& direction) {
    release_.energy = energy;
    release_direction_ = direction;
    // Bullet calls actions in the order they were added, also those added meanwhile
    if (world_ != nullptr) world_->addAction(&release_action_);
}

DUCTILE_INLINE Vector3<double> MultiBodyPlasticConstraint::velocity() const noexcept {
    Values u(0, 0, 0);
    for (int i = 0; i < m_numRows; ++i) u[i] = double(m_bodyA->getJointVelMultiDof(m_linkA)[i]);
    return u;
}

DUCTILE_INLINE const btMultiBodyLinkCollider* MultiBodyPlasticConstraint::collider()
    const noexcept {
    const auto moves = [](const btMultiBodyLinkCollider* c) {
        return c != nullptr && !c->isStaticOrKinematicObject();
    };
    for (int i = m_linkA; i >= 0; i = m_bodyA->getLink(i).m_parent) {
        if (moves(m_bodyA->getLink(i).m_collider)) return m_bodyA->getLink(i).m_collider;
    }
    for (int i = 0; i < m_bodyA->getNumLinks(); ++i) {
        if (moves(m_bodyA->getLink(i).m_collider)) return m_bodyA->getLink(i).m_collider;
    }
    return moves(m_bodyA->getBaseCollider()) ? m_bodyA->getBaseCollider() : nullptr;
}

DUCTILE_INLINE bool MultiBodyPlasticConstraint::asleep() const noexcept {
    const btMultiBodyLinkCollider* c = collider();
    return c != nullptr && c->getActivationState() == ISLAND_SLEEPING;
}

// ---- Bullet's side

DUCTILE_INLINE void MultiBodyPlasticConstraint::finalizeMultiDof() {
    allocateJacobiansMultiDof();
    for (int i = 0; i < m_data.size(); ++i) m_data[i] = 0;
    for (int i = 0; i < m_numRows; ++i) jacobianA(i)[column(i)] = 1;
    m_numDofsFinalized = m_jacSizeBoth;
}

DUCTILE_INLINE int MultiBodyPlasticConstraint::getIslandIdA() const {
    if (phase_ == Phase::idle) {
        tick_.velocity = velocity();
        phase_ = Phase::watched;
    }
    const btMultiBodyLinkCollider* c = collider();
    return c != nullptr ? c->getIslandTag() : -1;
}

DUCTILE_INLINE void MultiBodyPlasticConstraint::createConstraintRows(
    btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
    const btContactSolverInfo& info) {
    tell_keepers_of_step();
    if (m_jacSizeA != 6 + m_bodyA->getNumDofs()) finalizeMultiDof();
    phase_ = Phase::asked;
    if (broken()) return;
    const int first = rows.size();
    for (int i = 0; i < m_numRows; ++i) open_row(rows.expandNonInitializing(), i, data, info);
    Matrix3<double> response = Matrix3<double>::Identity();
    for (int i = 0; i < m_numRows; ++i) {
        const btScalar* answer =
            &data.m_deltaVelocitiesUnitImpulse[rows[first + i].m_jacAindex + column(0)];
        for (int j = 0; j < m_numRows; ++j) response(j, i) = double(answer[j]);
    }
    response_ = response;
    tick_.response = response;
    tick_.dt = double(info.m_timeStep);
    std::array<RowLimits<double>, 3> limits;
    prepare(tick_, std::span(limits).first(std::size_t(m_numRows)));
    for (int i = 0; i < m_numRows; ++i) close_row(rows[first + i], limits[std::size_t(i)]);
}

DUCTILE_INLINE void MultiBodyPlasticConstraint::open_row(btMultiBodySolverConstraint& row, int i,
                                                         btMultiBodyJacobianData& data,
                                                         const btContactSolverInfo& info) {
    const btVector3 none(0, 0, 0);
    const btMultibodyLink& link = m_bodyA->getLink(m_linkA);
    // the world axis is for Bullet's joint feedback only
    const btVector3 axis = link.m_cachedWorldTransform.getBasis() * link.getAxisTop(i);
    fillMultiBodyConstraint(row, data, jacobianA(i), jacobianB(i), axis, none, none, none, 0, info,
                            0, 0, true);
    row.m_orgConstraint = this;
    row.m_orgDofIndex = i;
    row.m_solverBodyIdA = row.m_solverBodyIdB = -1;
}

DUCTILE_INLINE void MultiBodyPlasticConstraint::close_row(
    btMultiBodySolverConstraint& row, const RowLimits<double>& limits) const noexcept {
    constexpr double out_of_reach = 1e6; // faster than any joint: the row ends at its bound
    if (!(row.m_jacDiagABInv > 0)) return;
    const double response = 1 / double(row.m_jacDiagABInv);
    const double free_velocity = -double(row.m_rhs) * response;
    const double stiff = response + limits.compliance;
    const bool given = limits.lower == limits.upper;
    const double target = given ? std::copysign(out_of_reach, limits.upper) : limits.bias;
    const double lower = given ? std::min(limits.lower, 0.0) : limits.lower;
    const double upper = given ? std::max(limits.upper, 0.0) : limits.upper;
    row.m_jacDiagABInv = btScalar(1 / stiff);
    row.m_rhs = btScalar((target - free_velocity) / stiff);
    row.m_cfm = btScalar(limits.compliance / stiff);
    row.m_lowerLimit = btScalar(lower * tick_.dt);
    row.m_upperLimit = btScalar(upper * tick_.dt);
}

DUCTILE_INLINE std::size_t MultiBodyPlasticConstraint::island() const {
    const btMultiBodyLinkCollider* c = collider();
    return c != nullptr ? std::size_t(c->getIslandTag()) : 0;
}

DUCTILE_INLINE void MultiBodyPlasticConstraint::finish_tick() {
    if (std::exchange(unfinished_, false) && broken()) let_go();
}

DUCTILE_INLINE void MultiBodyPlasticConstraint::end_tick() {
    const Phase was = phase_;
    phase_ = Phase::idle;
    left_out_ = was == Phase::watched && !asleep();
    if (was != Phase::asked || broken()) return;
    Values force(0, 0, 0);
    for (int i = 0; i < m_numRows; ++i) force[i] = double(getAppliedImpulse(i)) / tick_.dt;
    commit(force, velocity(), tick_.dt);
    unfinished_ = true;
}

DUCTILE_INLINE void MultiBodyPlasticConstraint::apply_release() {
    const double length = norm(release_direction_);
    const Values along = scaled(length > 0 ? 1 / length : 1, release_direction_);
    const Values held = times(numeric::inverse(response_), along); // zero for rows not there
    const double mass = dot(along, held);
    const double momentum = dot(held, velocity());
    const double root = std::sqrt(momentum * momentum + 2 * mass * release_.energy);
    if (!(mass > 0) || !std::isfinite(mass) || !(root > 0)) return;
    release_.impulse =
        scaled(std::copysign(2 * release_.energy / (std::abs(momentum) + root), momentum), held);

    const auto size = std::size_t(m_jacSizeA);
    std::vector<btScalar> impulse(size, 0), change(size, 0);
    for (int i = 0; i < m_numRows; ++i) {
        impulse[std::size_t(column(i))] = btScalar(release_.impulse[i]);
    }
    btAlignedObjectArray<btScalar> scratch;
    btAlignedObjectArray<btVector3> scratch_vectors;
    // with the articulated inertias of this tick, as the solver had them
    m_bodyA->calcAccelerationDeltasMultiDof(impulse.data(), change.data(), scratch,
                                            scratch_vectors);
    m_bodyA->applyDeltaVeeMultiDof(change.data(), 1);
}

} // namespace ductile::bullet
