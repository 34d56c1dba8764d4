// SPDX-License-Identifier: MIT
//
// Bodies of self_solved_rows.hpp.
#pragma once

#include <limits>

#include "ductile/bullet/convert.hpp"
#include "ductile/bullet/self_solved_rows.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::bullet {

namespace detail {

/// As the solver moves it. A body's angular factor keeps impulses and velocities from the axes
/// about which it may not turn.
DUCTILE_INLINE SweptBody<double> swept_body(const btRigidBody& body, const Vector3<double>& arm) {
    if (body.isStaticObject() || (body.getInvMass() == 0 && !body.isKinematicObject())) {
        return {.arm = arm};
    }
    SweptBody<double> swept{to_core(body.getInvMass() * body.getLinearFactor()),
                            to_core(body.getInvInertiaTensorWorld()), arm};
    if (body.getAngularFactor() != btVector3(1, 1, 1)) {
        const Vector3<double> f = to_core(body.getAngularFactor());
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j < 3; ++j) swept.inverse_inertia(i, j) *= f[i] * f[j];
        }
    }
    return swept;
}

} // namespace detail

DUCTILE_INLINE void SelfSolvedRows::join(btDynamicsWorld& world) {
    if (!solves_in_one_thread(world)) return;
    for (int i = world.getNumConstraints() - 1; i >= 0 && of_world_ == nullptr; --i) {
        const auto* other = dynamic_cast<const SelfSolvedRows*>(world.getConstraint(i));
        if (other != nullptr) of_world_ = other->of_world_;
    }
    if (of_world_ == nullptr) of_world_ = std::make_shared<SweepGroup>(world.getSolverInfo());
}

DUCTILE_INLINE SweepGroup* SelfSolvedRows::sweeps_of_solver(const SoftRows& asked,
                                                            btDynamicsWorld* world) const {
    if (world == nullptr) return nullptr;
    if (asked.compliance_is_exact()) return asked.sweeps();
    return of_world_ != nullptr && calls_in_each_sweep(*world->getConstraintSolver())
               ? of_world_.get()
               : nullptr;
}

DUCTILE_INLINE RowSweep<double>& SelfSolvedRows::open(SweepGroup& group, const btRigidBody& a,
                                                      const btRigidBody& b,
                                                      const Vector3<double>& arm_a,
                                                      const Vector3<double>& arm_b) {
    place_ = group.take(group_ == &group ? place_ : SweepGroup::Place{});
    group_ = &group;
    impulses_.setZero();
    sweep_ = -1;
    open_ = true;
    RowSweep<double>& rows = group.rows(place_);
    rows.open(detail::swept_body(a, arm_a), detail::swept_body(b, arm_b));
    return rows;
}

DUCTILE_INLINE void SelfSolvedRows::sweep(btSolverBody& a, btSolverBody& b) {
    const bool first = ++sweep_ == 0;
    RowSweep<double>& rows = group_->rows(place_);
    const SweptVelocities<double> already{
        to_core(a.internalGetDeltaLinearVelocity()), to_core(a.internalGetDeltaAngularVelocity()),
        to_core(b.internalGetDeltaLinearVelocity()), to_core(b.internalGetDeltaAngularVelocity())};
    const auto with = [](const Vector3<double>& v, const btVector3& more,
                         const btVector3& outside) {
        return sum(sum(v, to_core(more)), to_core(outside));
    };
    const SweptVelocities<double> now{
        with(already.linear_a, a.m_linearVelocity, a.m_externalForceImpulse),
        with(already.angular_a, a.m_angularVelocity, a.m_externalTorqueImpulse),
        with(already.linear_b, b.m_linearVelocity, b.m_externalForceImpulse),
        with(already.angular_b, b.m_angularVelocity, b.m_externalTorqueImpulse)};
    double asked = 0;
    Impulses impulses = impulses_;
    const SweptVelocities<double> more = rows.sweep(now, impulses, asked);
    // what the bodies' velocities, and those that they are the sum of, cannot tell
    constexpr double digit = 2 * double(std::numeric_limits<btScalar>::epsilon());
    const bool is_round_off =
        asked > 0 &&
        more.squared_norm() <= digit * digit * (now.squared_norm() + already.squared_norm());
    // is left once the rows were taken up: so that what else is solved in the same sweeps, and
    // how often, makes no difference; but a row that may give hardly anything gives it
    if (asked > 0 && (first || !is_round_off)) {
        impulses_ = impulses;
        a.internalGetDeltaLinearVelocity() += to_bullet(more.linear_a);
        a.internalGetDeltaAngularVelocity() += to_bullet(more.angular_a);
        b.internalGetDeltaLinearVelocity() += to_bullet(more.linear_b);
        b.internalGetDeltaAngularVelocity() += to_bullet(more.angular_b);
    }
    group_->called(sweep_, is_round_off ? 0 : asked);
}

DUCTILE_INLINE void write_feedback(btJointFeedback& feedback, const btRigidBody& a,
                                   const btRigidBody& b, const Vector3<double>& arm_a,
                                   const Vector3<double>& arm_b, const Vector3<double>& force,
                                   const Vector3<double>& moment) {
    feedback.m_appliedForceBodyA = to_bullet(force) * a.getLinearFactor();
    feedback.m_appliedForceBodyB = -to_bullet(force) * b.getLinearFactor();
    feedback.m_appliedTorqueBodyA =
        to_bullet(sum(cross(arm_a, force), moment)) * a.getAngularFactor();
    feedback.m_appliedTorqueBodyB =
        -to_bullet(sum(cross(arm_b, force), moment)) * b.getAngularFactor();
}

} // namespace ductile::bullet
