// SPDX-License-Identifier: MIT
//
// What a constraint of Bullet's states of its bodies in getInfo2, for who asks beside its solver.
//
// Not thread-safe for constraints of one body: they keep what they calculate.
#pragma once

#include <BulletDynamics/ConstraintSolver/btContactSolverInfo.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>

#include <cstddef>
#include <vector>

namespace ductile::bullet {

/// J v = error, by impulses between two limits.
struct StatedRow {
    btVector3 move_a{0, 0, 0}, turn_a{0, 0, 0}, move_b{0, 0, 0}, turn_b{0, 0, 0};
    btScalar error = 0, cfm = 0, lower = -SIMD_INFINITY, upper = SIMD_INFINITY;
};

/// Adds the rows of `constraint`, of which its getInfo1 has told just now that there are `count`.
inline void state_rows(btTypedConstraint& constraint, int count, const btContactSolverInfo& info,
                       std::vector<StatedRow>& rows) {
    const std::size_t first = rows.size();
    rows.resize(first + std::size_t(count));
    if (count == 0) return;
    StatedRow& row = rows[first];
    btTypedConstraint::btConstraintInfo2 to{};
    to.fps = 1 / info.m_timeStep;
    to.erp = info.m_erp;
    to.m_J1linearAxis = row.move_a;
    to.m_J1angularAxis = row.turn_a;
    to.m_J2linearAxis = row.move_b;
    to.m_J2angularAxis = row.turn_b;
    to.rowskip = int(sizeof(StatedRow) / sizeof(btScalar));
    to.m_constraintError = &row.error;
    to.cfm = &row.cfm;
    to.m_lowerLimit = &row.lower;
    to.m_upperLimit = &row.upper;
    to.m_numIterations = info.m_numIterations;
    to.m_damping = info.m_damping;
    constraint.getInfo2(&to);
}

} // namespace ductile::bullet
