// SPDX-License-Identifier: MIT
//
// Bullet's direct solver for multibodies, made to honour soft rows. btMultiBodyMLCPConstraintSolver
// ignores the compliance of a row, so that an elastic joint that the step does not resolve would be
// rigid and `unreliable`; here it is added to the diagonal, A_ii + C_i. Rows without one are solved
// as ever.
//
//   btDantzigSolver dantzig;
//   ductile::bullet::MultiBodyMlcpSolver solver(&dantzig);
//   btMultiBodyDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
//
// Where Dantzig's method fails Bullet goes on with the iterative solver without a word
// (getNumFallbacks counts); the joints' certificates tell.
#pragma once

#include <BulletDynamics/Featherstone/btMultiBodyMLCPConstraintSolver.h>

namespace ductile::bullet {

class MultiBodyMlcpSolver : public btMultiBodyMLCPConstraintSolver {
  public:
    using btMultiBodyMLCPConstraintSolver::btMultiBodyMLCPConstraintSolver;

  protected:
    void createMLCPFast(const btContactSolverInfo& info) override {
        btMultiBodyMLCPConstraintSolver::createMLCPFast(info);
        for (int i = 0; i < m_multiBodyAllConstraintPtrArray.size(); ++i) {
            const btMultiBodySolverConstraint& row = *m_multiBodyAllConstraintPtrArray[i];
            // contacts are left to the world's own m_globalCfm
            if (row.m_orgConstraint == nullptr || !(row.m_cfm > 0)) continue;
            // Bullet multiplies cfm by the row's effective mass
            m_multiBodyA.setElem(i, i, m_multiBodyA(i, i) + row.m_cfm / row.m_jacDiagABInv);
        }
    }
};

} // namespace ductile::bullet
