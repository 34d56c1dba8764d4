// SPDX-License-Identifier: MIT
//
// Bodies of island_solver.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <optional>

#include "ductile/bullet/convert.hpp"
#include "ductile/bullet/island_solver.hpp"
#include "ductile/bullet/island_solver_held.ipp"   // IWYU pragma: keep
#include "ductile/bullet/island_solver_motors.ipp" // IWYU pragma: keep
#include "ductile/bullet/island_solver_turned.ipp" // IWYU pragma: keep
#include "ductile/bullet/soft_contacts.hpp"

namespace ductile::bullet {

DUCTILE_INLINE btScalar IslandSolver::solveGroup(
    btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds,
    int manifold_count, btTypedConstraint** constraints, int constraint_count,
    const btContactSolverInfo& info, btIDebugDraw* drawer, btDispatcher* dispatcher) {
    own_ = {};
    if (has_only_joints(bodies, body_count, manifolds, manifold_count, constraints,
                        constraint_count)) {
        solve_joints(bodies, body_count, constraints, constraint_count, info);
        return 0;
    }
    btContactSolverInfo two_directions = info;
    two_directions.m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS;
    return btSequentialImpulseConstraintSolver::solveGroup(
        bodies, body_count, manifolds, manifold_count, constraints, constraint_count,
        two_directions, drawer, dispatcher);
}

DUCTILE_INLINE bool IslandSolver::has_only_joints(btCollisionObject** bodies, int body_count,
                                                  btPersistentManifold** manifolds,
                                                  int manifold_count,
                                                  btTypedConstraint** constraints,
                                                  int constraint_count) {
    return std::none_of(manifolds, manifolds + manifold_count,
                        [](const auto* manifold) { return manifold->getNumContacts() > 0; }) &&
           std::all_of(constraints, constraints + constraint_count,
                       [](auto* constraint) { return as_plastic(*constraint) != nullptr; }) &&
           std::all_of(bodies, bodies + body_count, [](const auto* object) {
               const btRigidBody* body = btRigidBody::upcast(object);
               return body != nullptr &&
                      (body->getFlags() & BT_ENABLE_GYROSCOPIC_FORCE_EXPLICIT) == 0;
           });
}

/// Once more where plastic joints ask for something else as bodies leave the part (turn_rows).
template <class Seat>
void IslandSolver::solve_island(const Seat& seat_of) {
    report_ = solver_.solve(island_);
    bool turned = false;
    for (PlasticConstraint* plastic : plastic_) {
        turned = plastic->turn_rows(island_, seat_of(plastic->getRigidBodyA()),
                                    seat_of(plastic->getRigidBodyB())) ||
                 turned;
    }
    if (turned) report_ = solver_.solve(island_);
}

/// Straight from bodies and joints, without Bullet's rows and solver bodies.
DUCTILE_INLINE void IslandSolver::solve_joints(btCollisionObject** bodies, int body_count,
                                               btTypedConstraint** constraints,
                                               int constraint_count,
                                               const btContactSolverInfo& info) {
    const auto tick = double(info.m_timeStep);
    island_.clear();
    free_.clear();
    for (int i = 0; i < body_count; ++i) {
        auto& body = static_cast<btRigidBody&>(*bodies[i]);
        body.setCompanionId(-1);
        if (!detail::moves(&body)) continue;
        body.setCompanionId(int(free_.size()));
        free_.push_back(free_state(body, tick));
        add_body(body);
    }
    const auto seat_of = [this](const btRigidBody& body) {
        if (!detail::moves(&body)) return still_seat(body);
        const int number = body.getCompanionId();
        const BodyState<double>& free = free_[std::size_t(number)];
        return IslandSeat{number, free.velocity, free.spin};
    };
    plastic_.clear();
    for (int i = 0; i < constraint_count; ++i) {
        PlasticConstraint* plastic = as_plastic(*constraints[i]);
        plastic->buildJacobian();
        if (!plastic->isEnabled()) continue;
        plastic_.push_back(plastic);
        plastic->open_rows(island_, seat_of(plastic->getRigidBodyA()),
                           seat_of(plastic->getRigidBodyB()), tick, double(info.m_erp));
    }
    solve_island(seat_of);
    for (int i = 0; i < body_count; ++i) {
        auto& body = static_cast<btRigidBody&>(*bodies[i]);
        const int number = body.getCompanionId();
        if (number < 0) continue;
        const BodyState<double>& free = free_[std::size_t(number)];
        const Vector6<double>& change = island_.bodies[std::size_t(number)].velocity;
        body.setLinearVelocity(to_bullet(sum(free.velocity, linear(change))));
        body.setAngularVelocity(to_bullet(sum(free.spin, angular(change))));
        body.setCompanionId(-1);
    }
    for (PlasticConstraint* plastic : plastic_) plastic->close_rows(island_);
}

DUCTILE_INLINE void IslandSolver::convertJoints(btTypedConstraint** constraints, int count,
                                                const btContactSolverInfo& info) {
    plastic_.clear();
    others_.clear();
    for (int i = 0; i < count; ++i) {
        PlasticConstraint* plastic = as_plastic(*constraints[i]);
        if (plastic != nullptr) {
            plastic->buildJacobian();
            if (plastic->isEnabled()) plastic_.push_back(plastic);
        } else {
            others_.push_back(constraints[i]);
        }
    }
    const detail::PlainFrames frames(others_, ahead_);
    look_ahead(info);
    detail::HeldAxes held;
    for (btTypedConstraint* constraint : others_) held.take(*constraint);
    unstopped_.clear();
    unstopped_count_.clear();
    detail::StoppedMotors motors(info);
    for (btTypedConstraint* constraint : others_) {
        const std::size_t before = unstopped_.size();
        motors.take(*constraint, unstopped_);
        unstopped_count_.push_back(int(unstopped_.size() - before));
    }
    btSequentialImpulseConstraintSolver::convertJoints(others_.data(), int(others_.size()), info);
}

DUCTILE_INLINE btScalar IslandSolver::solveGroupCacheFriendlyIterations(
    btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds,
    int manifold_count, btTypedConstraint** constraints, int constraint_count,
    const btContactSolverInfo& info, btIDebugDraw* drawer) {
    island_.clear();
    read_.clear();
    load_bodies();
    load_plastic_joints(info);
    first_read_ = island_.rows.size();
    half_ = double(info.m_timeStep) / 2;
    load_rows();
    find_turned(manifolds, manifold_count, double(info.m_timeStep));
    load_contacts();
    load_motors();
    solve_island([this](btRigidBody& body) { return seat(body); });
    read_own();
    store();
    if (info.m_splitImpulse && pushes_apart_) {
        solveGroupCacheFriendlySplitImpulseIterations(bodies, body_count, manifolds, manifold_count,
                                                      constraints, constraint_count, info, drawer);
    }
    return 0;
}

DUCTILE_INLINE void IslandSolver::load_bodies() {
    number_.assign(std::size_t(m_tmpSolverBodyPool.size()), solve::immovable);
    for (int i = 0; i < m_tmpSolverBodyPool.size(); ++i) {
        const btRigidBody* body = m_tmpSolverBodyPool[i].m_originalBody;
        if (!detail::moves(body)) continue;
        number_[std::size_t(i)] = int(island_.bodies.size());
        add_body(*body);
    }
}

DUCTILE_INLINE void IslandSolver::add_body(const btRigidBody& body) {
    const Vector3<double> turns = to_core(body.getAngularFactor());
    Matrix3<double> inverse_inertia = to_core(body.getInvInertiaTensorWorld());
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) inverse_inertia(r, c) *= turns[r] * turns[c];
    }
    island_.bodies.push_back(solve::island_body(
        scaled(double(body.getInvMass()), to_core(body.getLinearFactor())), inverse_inertia));
}

DUCTILE_INLINE IslandSeat IslandSolver::still_seat(const btRigidBody& body) {
    return {.velocity = to_core(body.getLinearVelocity()),
            .spin = to_core(body.getAngularVelocity())};
}

/// Where a body of this solve stands in the island, with the velocities that Bullet lets it begin
/// with.
DUCTILE_INLINE IslandSeat IslandSolver::seat(btRigidBody& body) const {
    if (!detail::moves(&body)) return still_seat(body);
    const int id = body.getCompanionId();
    const btSolverBody& solver_body = m_tmpSolverBodyPool[id];
    return {.number = number_[std::size_t(id)],
            .velocity = to_core(solver_body.m_linearVelocity + solver_body.m_externalForceImpulse),
            .spin = to_core(solver_body.m_angularVelocity + solver_body.m_externalTorqueImpulse)};
}

DUCTILE_INLINE void IslandSolver::load_plastic_joints(const btContactSolverInfo& info) {
    for (PlasticConstraint* plastic : plastic_) {
        plastic->open_rows(island_, seat(plastic->getRigidBodyA()), seat(plastic->getRigidBodyB()),
                           double(info.m_timeStep), double(info.m_erp));
    }
}

DUCTILE_INLINE solve::IslandRow& IslandSolver::add_row(btSolverConstraint& row) {
    solve::IslandRow& added = island_.rows.emplace_back();
    read_.push_back(&row);
    const double scale = double(row.m_jacDiagABInv);
    if (!(scale > 0)) {
        added.lower = added.upper = 0;
        return added;
    }
    added.a = number_[std::size_t(row.m_solverBodyIdA)];
    added.b = number_[std::size_t(row.m_solverBodyIdB)];
    if (added.a >= 0) {
        added.on_a = twist_of(to_core(row.m_contactNormal1), to_core(row.m_relpos1CrossNormal));
    }
    if (added.b >= 0) {
        added.on_b = twist_of(to_core(row.m_contactNormal2), to_core(row.m_relpos2CrossNormal));
    }
    added.target = double(row.m_rhs) / scale;
    added.compliance = double(row.m_cfm) / scale;
    return added;
}

DUCTILE_INLINE void IslandSolver::load_rows() {
    btConstraintArray& pool = m_tmpSolverNonContactConstraintPool;
    for (int i = 0; i < pool.size(); ++i) {
        solve::IslandRow& row = add_row(pool[i]);
        if (!(pool[i].m_jacDiagABInv > 0)) continue;
        row.lower = detail::limit(pool[i].m_lowerLimit);
        row.upper = detail::limit(pool[i].m_upperLimit);
    }
    turn_rows();
    load_springs();
}

DUCTILE_INLINE void IslandSolver::find_turned(btPersistentManifold** manifolds, int count,
                                              double tick) {
    turned_.clear();
    for (int i = 0; held_ != nullptr && i < count; ++i) {
        for (int k = 0; k < manifolds[i]->getNumContacts(); ++k) {
            const btManifoldPoint& point = manifolds[i]->getContactPoint(k);
            const double speed = held_->turned(*manifolds[i], point, tick);
            if (speed != 0) turned_.emplace_back(&point, speed);
        }
    }
    std::sort(turned_.begin(), turned_.end());
}

DUCTILE_INLINE double IslandSolver::turned(const void* point) const {
    const auto found = std::lower_bound(
        turned_.begin(), turned_.end(), point,
        [](const auto& entry, const void* key) { return std::less<>()(entry.first, key); });
    return found != turned_.end() && found->first == point ? found->second : 0;
}

/// What Bullet's friction rows forget: the speed along them that torques on their bodies give in a
/// tick.
DUCTILE_INLINE double IslandSolver::torque_left_out(const btSolverConstraint& row) const {
    const btSolverBody& a = m_tmpSolverBodyPool[row.m_solverBodyIdA];
    const btSolverBody& b = m_tmpSolverBodyPool[row.m_solverBodyIdB];
    return double(row.m_relpos1CrossNormal.dot(a.m_externalTorqueImpulse) +
                  row.m_relpos2CrossNormal.dot(b.m_externalTorqueImpulse));
}

/// What friction that holds is short of where bodies are half a step ahead [m/s].
DUCTILE_INLINE double IslandSolver::turns_away(const btSolverConstraint& row,
                                               const btManifoldPoint& point) const {
    const btVector3* const at[] = {&point.getPositionWorldOnA(), &point.getPositionWorldOnB()};
    const int id[] = {row.m_solverBodyIdA, row.m_solverBodyIdB};
    std::array<ContactBody, 2> moves;
    std::array<Vector3<double>, 2> arm{Vector3<double>::Zero(), Vector3<double>::Zero()};
    for (const std::size_t i : {0u, 1u}) {
        const btRigidBody* body = m_tmpSolverBodyPool[id[i]].m_originalBody;
        if (body == nullptr) continue;
        moves[i] = contact_body(*body);
        arm[i] = to_core(*at[i] - body->getCenterOfMassPosition());
    }
    return half_ *
           dot(to_core(row.m_contactNormal1), turning_arms(moves[0], arm[0], moves[1], arm[1]));
}

/// A normal row and, after it, its friction rows, sliding and rolling ones, on one cone.
DUCTILE_INLINE void IslandSolver::load_contacts() {
    btConstraintArray& contacts = m_tmpSolverContactConstraintPool;
    int slides = 0, rolls = 0; // in the order of the contacts
    soft_rows_.clear();
    for (int i = 0; i < contacts.size(); ++i) {
        const auto& point = *static_cast<btManifoldPoint*>(contacts[i].m_originalContactPoint);
        std::optional<SoftContact> soft;
        if (ahead_ || blow_) {
            soft = soft_contact(
                point, m_tmpSolverBodyPool[contacts[i].m_solverBodyIdA].m_originalBody,
                m_tmpSolverBodyPool[contacts[i].m_solverBodyIdB].m_originalBody, frame_);
        }
        // in a blow it gives nothing, nor where it is apart
        if (soft && (blow_ || point.getDistance() > 0)) contacts[i].m_jacDiagABInv = 0;
        const bool dead = !(contacts[i].m_jacDiagABInv > 0);
        solve::IslandBlock block{.kind = solve::BlockKind::contact,
                                 .first = int(island_.rows.size())};
        const auto take = [&](btSolverConstraint& row) -> solve::IslandRow& {
            solve::IslandRow& added = add_row(row);
            added.impulse = double(row.m_appliedImpulse);
            if (row.m_jacDiagABInv > 0) {
                added.softness = solve::contact_softness / double(row.m_jacDiagABInv);
            }
            ++block.count;
            return added;
        };
        solve::IslandRow& normal = take(contacts[i]);
        normal.target += turned(contacts[i].m_originalContactPoint);
        if (soft && !dead) soften(*soft, contacts[i], point, normal);
        if (!soft && (ahead_ || blow_) && gives_way(point)) normal.compliance = 0; // a hard one
        // Bullet begins with 85 % of the last normal and no friction: all of both is as a rule the
        // answer of what stands, and what slid would be looked for anew in every tick
        const double begins = normal.impulse > 0 ? 1 : 0; // as the user has it
        normal.impulse = begins * double(point.m_appliedImpulse);
        const std::array before{begins * double(point.m_appliedImpulseLateral1),
                                begins * double(point.m_appliedImpulseLateral2)};
        std::size_t slid = 0;
        const auto take_friction = [&](btConstraintArray& pool, int& next) {
            for (; next < pool.size() && pool[next].m_frictionIndex == i; ++next) {
                // no more than a block holds: sliding comes first, then rolling about the normal
                if (dead || block.count == 6 || !(pool[next].m_friction > 0)) {
                    pool[next].m_appliedImpulse = 0;
                    continue;
                }
                block.size[std::size_t(block.count)] = double(pool[next].m_friction);
                solve::IslandRow& row = take(pool[next]);
                row.target -= torque_left_out(pool[next]);
                if (ahead_ && slid < 2) row.target -= turns_away(pool[next], point);
                if (slid < 2) row.impulse = before[slid++];
            }
        };
        take_friction(m_tmpSolverContactFrictionConstraintPool, slides);
        take_friction(m_tmpSolverContactRollingFrictionConstraintPool, rolls);
        begin_contact(island_, block); // as the last tick left it
    }
}

/// The normal row of one that gives way, with the mean of its forces.
DUCTILE_INLINE void IslandSolver::soften(const SoftContact& soft, const btSolverConstraint& row,
                                         const btManifoldPoint& point, solve::IslandRow& normal) {
    const double comes = began(row), push = pushed(row);
    const double turns = turned(&point), start = comes + turns;
    const LawRow law = soft.row(-double(point.getDistance()), start, 2 * half_);
    normal.target = law.target + turns - comes - push;
    normal.compliance = law.compliance;
    soft_rows_.push_back({island_.rows.size() - 1, soft, start, comes + push - turns});
}

DUCTILE_INLINE void IslandSolver::store() {
    for (std::size_t i = 0; i < read_.size(); ++i) {
        read_[i]->m_appliedImpulse = btScalar(island_.rows[first_read_ + i].impulse);
    }
    for (const auto& [place, row] : motor_rows_) {
        m_tmpSolverNonContactConstraintPool[int(place)].m_appliedImpulse +=
            btScalar(island_.rows[row].impulse);
    }
    for (int i = 0; i < m_tmpSolverBodyPool.size(); ++i) {
        const int number = number_[std::size_t(i)];
        if (number < 0) continue;
        const Vector6<double>& change = island_.bodies[std::size_t(number)].velocity;
        m_tmpSolverBodyPool[i].internalGetDeltaLinearVelocity() = to_bullet(linear(change));
        m_tmpSolverBodyPool[i].internalGetDeltaAngularVelocity() = to_bullet(angular(change));
    }
    for (PlasticConstraint* plastic : plastic_) plastic->close_rows(island_);
}

} // namespace ductile::bullet
