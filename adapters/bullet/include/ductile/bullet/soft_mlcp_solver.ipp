// SPDX-License-Identifier: MIT
//
// Bodies of soft_mlcp_solver.hpp.
#pragma once

#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>

#include <algorithm>

#include "ductile/bullet/soft_mlcp_solver.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::bullet {

template <class Solve>
bool SoftMlcpSolver::solved_with_ties(const Solve& solve) {
    if (solve()) return true;
    if (!pivots_) return false;
    for (const btScalar share : row_softness<btScalar>) {
        for (int i = 0; i < m_A.rows(); ++i) m_A.setElem(i, i, m_A(i, i) * (1 + share));
        if (solve()) return true;
    }
    return false;
}

DUCTILE_INLINE SoftMlcpSolver::SoftMlcpSolver(btMLCPSolverInterface& lcp, Answer answer)
    : btMLCPSolver(nullptr),
      shifted_(lcp, answer),
      direct_(answer == Answer::exact),
      pivots_(dynamic_cast<btDantzigSolver*>(&lcp) != nullptr) {
    btMLCPSolver::setMLCPSolver(&shifted_);
}

DUCTILE_INLINE btScalar SoftMlcpSolver::solveGroupCacheFriendlyIterations(
    btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds,
    int manifold_count, btTypedConstraint** constraints, int constraint_count,
    const btContactSolverInfo& info, btIDebugDraw* drawer) {
    btContactSolverInfo enough = info;
    if (direct_) { // and does not read it
        enough.m_numIterations = std::max(info.m_numIterations, fallback_sweeps);
    }
    return btMLCPSolver::solveGroupCacheFriendlyIterations(bodies, body_count, manifolds,
                                                           manifold_count, constraints,
                                                           constraint_count, enough, drawer);
}

DUCTILE_INLINE void SoftMlcpSolver::convertJoints(btTypedConstraint** constraints, int count,
                                                  const btContactSolverInfo& info) {
    soft_.mark(constraints, count);
    btMLCPSolver::convertJoints(constraints, count, info);
    soft_.unmark();
    compliant_.clear();
    soft_.for_each_row(m_tmpConstraintSizesPool, m_tmpSolverNonContactConstraintPool,
                       [this](btSolverConstraint& row) {
                           if (row.m_cfm > 0) compliant_.push_back(row_index(row));
                       });
    drop_constraints_without_rows();
}

DUCTILE_INLINE void SoftMlcpSolver::createMLCP(const btContactSolverInfo& info) {
    btMLCPSolver::createMLCP(info);
    add_compliance();
}

DUCTILE_INLINE void SoftMlcpSolver::createMLCPFast(const btContactSolverInfo& info) {
    btMLCPSolver::createMLCPFast(info);
    add_compliance();
}

DUCTILE_INLINE bool SoftMlcpSolver::solveMLCP(const btContactSolverInfo& info) {
    if (m_A.rows() == 0) return true;
    if (!solved_with_ties([&] { return solve_velocities(info); })) {
        if (direct_) sweep_joints(info.m_numIterations);
        return false;
    }
    if (info.m_splitImpulse) push_apart(info);
    return true;
}

DUCTILE_INLINE void SoftMlcpSolver::sweep_joints(int at_least) {
    for (int i = 0; i < m_tmpSolverNonContactConstraintPool.size(); ++i) {
        int& sweeps = m_tmpSolverNonContactConstraintPool[i].m_overrideNumSolverIterations;
        sweeps = std::max(sweeps, at_least);
    }
}

DUCTILE_INLINE int SoftMlcpSolver::row_index(const btSolverConstraint& row) const {
    return int(&row - &m_tmpSolverNonContactConstraintPool[0]);
}

DUCTILE_INLINE void SoftMlcpSolver::drop_constraints_without_rows() {
    int kept = 0;
    for (int i = 0; i < m_tmpConstraintSizesPool.size(); ++i) {
        if (m_tmpConstraintSizesPool[i].m_numConstraintRows == 0) continue;
        m_tmpConstraintSizesPool[kept++] = m_tmpConstraintSizesPool[i];
    }
    m_tmpConstraintSizesPool.resizeNoInitialize(kept);
}

DUCTILE_INLINE void SoftMlcpSolver::add_compliance() {
    for (const int i : compliant_) {
        btSolverConstraint& row = m_tmpSolverNonContactConstraintPool[i];
        m_A.setElem(i, i, m_A(i, i) + row.m_cfm);
        soften(row);
    }
}

DUCTILE_INLINE bool SoftMlcpSolver::solve_velocities(const btContactSolverInfo& info) {
    return shifted_.solveMLCP(m_A, m_b, m_x, m_lo, m_hi, m_limitDependencies, info.m_numIterations);
}

DUCTILE_INLINE void SoftMlcpSolver::push_apart(const btContactSolverInfo& info) {
    bool nothing_to_push = true;
    for (int i = 0; i < m_bSplit.rows(); ++i) {
        nothing_to_push = nothing_to_push && m_bSplit[i] == 0;
    }
    m_xSplit.setZero();
    if (nothing_to_push) return;
    for (int i = 0; i < m_lo.rows(); ++i) {
        if (m_limitDependencies[i] >= 0) continue;
        const btScalar given = std::min(std::max(btScalar(0), m_lo[i]), m_hi[i]);
        m_lo[i] -= given;
        m_hi[i] -= given;
    }
    const bool solved = solved_with_ties([&] {
        return shifted_.solveMLCP(m_A, m_bSplit, m_xSplit, m_lo, m_hi, m_limitDependencies,
                                  info.m_numIterations);
    });
    if (!solved) m_xSplit.setZero();
}

} // namespace ductile::bullet
