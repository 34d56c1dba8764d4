// SPDX-License-Identifier: MIT
//
// Bullet's iterative solvers, made to honour the compliance of SoftRows (soft_rows.hpp) whatever
// its size. Drop-in: everything else, contacts included, is Bullet's.
//
//   ductile::bullet::SoftSequentialImpulseSolver solver;
//   btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
//
// They are still iterative: coupled rows are solved up to `m_numIterations` sweeps, and chains of
// joints need a direct solver (soft_mlcp_solver.hpp). A constraint's certificate tells.
#pragma once

#include <BulletDynamics/ConstraintSolver/btNNCGConstraintSolver.h>
#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>

#include <algorithm>
#include <type_traits>
#include <typeinfo>

#include "ductile/bullet/soft_rows.hpp"
#include "ductile/bullet/sweep_group.hpp"

namespace ductile::bullet {

/// Any solver of Bullet's that converts joints as btSequentialImpulseConstraintSolver does and
/// iterates over the converted rows.
template <class Engine>
class SoftRowSolver : public Engine {
  public:
    using Engine::Engine;

  protected:
    void convertJoints(btTypedConstraint** constraints, int count,
                       const btContactSolverInfo& info) override {
        // what derives from it may sweep otherwise
        constexpr bool sweeps = std::is_same_v<Engine, btSequentialImpulseConstraintSolver>;
        sweeps_.begin();
        soft_.mark(constraints, count,
                   sweeps && typeid(*this) == typeid(SoftRowSolver) ? &sweeps_ : nullptr);
        Engine::convertJoints(constraints, count, info);
        soft_.unmark();
        soft_.for_each_row(this->m_tmpConstraintSizesPool,
                           this->m_tmpSolverNonContactConstraintPool, soften);
    }

    /// Goes on for as long as constraints change something that solve their rows by themselves.
    btScalar solveSingleIteration(int iteration, btCollisionObject** bodies, int body_count,
                                  btPersistentManifold** manifolds, int manifold_count,
                                  btTypedConstraint** constraints, int constraint_count,
                                  const btContactSolverInfo& info, btIDebugDraw* drawer) override {
        const btScalar residual =
            Engine::solveSingleIteration(iteration, bodies, body_count, manifolds, manifold_count,
                                         constraints, constraint_count, info, drawer);
        const auto own = btScalar(sweeps_.take_change());
        return std::max(residual, own * own);
    }

  private:
    SoftConstraints soft_;
    SweepGroup sweeps_;
};

using SoftSequentialImpulseSolver = SoftRowSolver<btSequentialImpulseConstraintSolver>;

/// Nonsmooth nonlinear conjugate gradients: sequential impulse, accelerated over the sweeps.
///
/// Source: Silcowitz-Hansen, Niebe and Erleben (2010), "A nonsmooth nonlinear conjugate gradient
/// method for interactive contact force problems", The Visual Computer 26, 893-901,
/// doi:10.1007/s00371-010-0502-6. The search direction is made of the sweep's changes of impulse.
///
/// Bullet 3.24 departs from it twice, and both are mended here:
///   - its row solvers return Δλ/D, a velocity [m/s | rad/s], which btNNCGConstraintSolver goes on
///     to apply as an impulse: right only for rows of effective mass 1 kg (1 kg m²), and without
///     bound for lighter ones. Here the row solvers return Δλ.
///   - the last step along the direction leaves impulses outside their bounds. Here the last
///     iteration is a plain sweep.
/// `m_leastSquaresResidualThreshold` is therefore in (N s)², with N m s for moments.
class SoftNncgSolver : public SoftRowSolver<btNNCGConstraintSolver> {
  protected:
    btScalar solveGroupCacheFriendlySetup(btCollisionObject** bodies, int body_count,
                                          btPersistentManifold** manifolds, int manifold_count,
                                          btTypedConstraint** constraints, int constraint_count,
                                          const btContactSolverInfo& info,
                                          btIDebugDraw* drawer) override {
        const btScalar result = SoftRowSolver::solveGroupCacheFriendlySetup(
            bodies, body_count, manifolds, manifold_count, constraints, constraint_count, info,
            drawer);
        setConstraintRowSolverGeneric(change_of_impulse_generic);
        setConstraintRowSolverLowerLimit(change_of_impulse_lower_limit);
        return result;
    }

    btScalar solveSingleIteration(int iteration, btCollisionObject** bodies, int body_count,
                                  btPersistentManifold** manifolds, int manifold_count,
                                  btTypedConstraint** constraints, int constraint_count,
                                  const btContactSolverInfo& info, btIDebugDraw* drawer) override {
        const int last = std::max(m_maxOverrideNumSolverIterations, info.m_numIterations) - 1;
        return iteration < last ? SoftRowSolver::solveSingleIteration(
                                      iteration, bodies, body_count, manifolds, manifold_count,
                                      constraints, constraint_count, info, drawer)
                                : btSequentialImpulseConstraintSolver::solveSingleIteration(
                                      iteration, bodies, body_count, manifolds, manifold_count,
                                      constraints, constraint_count, info, drawer);
    }

  private:
    // Bullet hands out its row solvers by object, but they are plain functions
    static btScalar change_of_impulse_generic(btSolverBody& a, btSolverBody& b,
                                              const btSolverConstraint& row) {
        static const btSingleConstraintRowSolver solve =
            btSequentialImpulseConstraintSolver().getScalarConstraintRowSolverGeneric();
        return change_of_impulse(solve, a, b, row);
    }
    static btScalar change_of_impulse_lower_limit(btSolverBody& a, btSolverBody& b,
                                                  const btSolverConstraint& row) {
        static const btSingleConstraintRowSolver solve =
            btSequentialImpulseConstraintSolver().getScalarConstraintRowSolverLowerLimit();
        return change_of_impulse(solve, a, b, row);
    }
    static btScalar change_of_impulse(btSingleConstraintRowSolver solve, btSolverBody& a,
                                      btSolverBody& b, const btSolverConstraint& row) {
        const btScalar before = row.m_appliedImpulse;
        solve(a, b, row);
        return btScalar(row.m_appliedImpulse) - before;
    }
};

} // namespace ductile::bullet
