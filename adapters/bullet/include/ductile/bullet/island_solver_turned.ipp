// SPDX-License-Identifier: MIT
//
// Bodies of island_solver.hpp: rows of the engine's own that turn within a part. A part of
// island_solver.ipp.
#pragma once

#include <BulletDynamics/ConstraintSolver/btHingeConstraint.h>

#include <cmath>
#include <cstddef>

#include "ductile/bullet/moving_bodies.hpp"

namespace ductile::bullet {

namespace detail {

/// Of a body that others are solved with at the same time, and that may not be moved here.
[[nodiscard]] DUCTILE_INLINE bool is_led(const btRigidBody& body) noexcept {
    return !moves(&body) &&
           !(body.getLinearVelocity().isZero() && body.getAngularVelocity().isZero());
}

/// While this lives a body is where its velocity takes it in `time` [s].
class BodyAhead {
  public:
    BodyAhead(btRigidBody& body, btScalar time) : body_(body), now_(body.getWorldTransform()) {
        if (moves(&body_)) body_.setWorldTransform(moved(body_, now_, time));
    }
    ~BodyAhead() {
        if (moves(&body_)) body_.setWorldTransform(now_);
    }
    BodyAhead(const BodyAhead&) = delete;
    BodyAhead& operator=(const BodyAhead&) = delete;

  private:
    btRigidBody& body_;
    btTransform now_;
};

/// While this lives rows of hinges' pins go along the axes of the world, not along their arms,
/// which turn: the same three rows.
class PinsInWorld {
  public:
    PinsInWorld(const std::vector<btTypedConstraint*>& constraints, bool all) {
        for (btTypedConstraint* constraint : constraints) {
            if (!all || constraint->getConstraintType() != HINGE_CONSTRAINT_TYPE) continue;
            auto* hinge = static_cast<btHingeConstraint*>(constraint);
            if (!hinge->getUseFrameOffset()) continue;
            hinges_.push_back(hinge);
            hinge->setUseFrameOffset(false);
        }
    }
    ~PinsInWorld() {
        for (btHingeConstraint* hinge : hinges_) hinge->setUseFrameOffset(true);
    }
    PinsInWorld(const PinsInWorld&) = delete;
    PinsInWorld& operator=(const PinsInWorld&) = delete;

  private:
    std::vector<btHingeConstraint*> hinges_;
};

} // namespace detail

/// The others' rows as the part will end.
DUCTILE_INLINE void IslandSolver::look_ahead(const btContactSolverInfo& info) {
    at_end_.clear();
    count_at_end_.clear();
    if (!ahead_) return;
    for (btTypedConstraint* constraint : others_) {
        btTypedConstraint::btConstraintInfo1 size{};
        const btScalar half = info.m_timeStep / 2;
        btRigidBody &of_a = constraint->getRigidBodyA(), &of_b = constraint->getRigidBodyB();
        const detail::BodyAhead a(of_a, half), b(of_b, half);
        const bool led = detail::is_led(of_a) || detail::is_led(of_b);
        if (constraint->isEnabled() && !led) constraint->getInfo1(&size);
        count_at_end_.push_back(size.m_numConstraintRows);
        if (size.m_numConstraintRows == 0) continue;
        const std::size_t first = at_end_.size();
        at_end_.resize(first + std::size_t(size.m_numConstraintRows));
        EndRow& row = at_end_[first];
        btTypedConstraint::btConstraintInfo2 rows{};
        rows.fps = 1 / info.m_timeStep;
        rows.erp = info.m_erp;
        rows.m_J1linearAxis = row.move_a;
        rows.m_J1angularAxis = row.turn_a;
        rows.m_J2linearAxis = row.move_b;
        rows.m_J2angularAxis = row.turn_b;
        rows.rowskip = int(sizeof(EndRow) / sizeof(btScalar));
        rows.m_constraintError = &row.error;
        rows.cfm = &row.cfm;
        rows.m_lowerLimit = &row.lower;
        rows.m_upperLimit = &row.upper;
        rows.m_numIterations = info.m_numIterations;
        rows.m_damping = info.m_damping;
        constraint->getInfo2(&rows);
    }
}

/// Has those of them that hold both ways be right at the end of the part.
DUCTILE_INLINE void IslandSolver::turn_rows() {
    const auto twist = [](const btVector3& linear, const btVector3& angular) {
        return twist_of(to_core(linear), to_core(angular));
    };
    const auto came = [this, &twist](int body) { // as the part began
        const btSolverBody& moved = m_tmpSolverBodyPool[body];
        return twist(moved.m_linearVelocity, moved.m_angularVelocity);
    };
    const auto pushed = [this, &twist](int body) { // by outside forces, in all of it
        const btSolverBody& moved = m_tmpSolverBodyPool[body];
        return twist(moved.m_externalForceImpulse, moved.m_externalTorqueImpulse);
    };
    std::size_t then = 0, now = 0;
    for (std::size_t i = 0; i < count_at_end_.size(); ++i) {
        const int count = m_tmpConstraintSizesPool[int(i)].m_numConstraintRows;
        const bool same = count == count_at_end_[i]; // else a stop began or ended, or it is led
        for (int k = 0; same && k < count; ++k) {
            const EndRow& end = at_end_[then + std::size_t(k)];
            const btSolverConstraint& row = m_tmpSolverNonContactConstraintPool[int(now) + k];
            solve::IslandRow& turned = island_.rows[first_read_ + now + std::size_t(k)];
            if (!std::isinf(turned.lower) || !std::isinf(turned.upper)) continue;
            const int a = row.m_solverBodyIdA, b = row.m_solverBodyIdB;
            const Vector6<double> on_a = twist(row.m_contactNormal1, row.m_relpos1CrossNormal),
                                  on_b = twist(row.m_contactNormal2, row.m_relpos2CrossNormal);
            const double comes = on_a.dot(came(a)) + on_b.dot(came(b));
            const double push = on_a.dot(pushed(a)) + on_b.dot(pushed(b));
            const double leaves = twist(end.move_a, end.turn_a).dot(came(a)) +
                                  twist(end.move_b, end.turn_b).dot(came(b));
            const double asked = turned.target + comes + push; // in the middle
            turned.target = (4 * asked - double(end.error)) / 3 - push - leaves;
        }
        then += std::size_t(count_at_end_[i]);
        now += std::size_t(count);
    }
}

} // namespace ductile::bullet
