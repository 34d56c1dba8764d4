// SPDX-License-Identifier: MIT
//
// One of Bullet's islands, solved at once (solve/island_solver.hpp): plastic joints state their
// rows themselves, contacts and the other constraints are read from the rows that Bullet makes of
// them.
//
// Between Bullet's setup and its finish, which stay as they are:
//   body      inverse mass × linear factor; world inertia with the angular factor on both sides
//   row       b = m_rhs/m_jacDiagABInv, C = m_cfm/m_jacDiagABInv; m_jacDiagABInv = 0: no row
//   contact   one cone with its friction rows (solve/contact_form.hpp): two directions always, as
//             with one loose structures walk in every solver
//   answer    impulses into Bullet's rows, velocities into its solver bodies, in place of those of
//   the
//             warm start
//
// Traps of Bullet 3.24 that this header deals with
//   - Large limits stand for infinite ones: 1e10 for contacts, SIMD_INFINITY for joints.
//   - What overlaps deeper than m_splitImpulsePenetrationThreshold is pushed apart in a solve of
//   its own:
//     Bullet's, by sweeps, without the joints. Not in parts of frames (front_solver.ipp).
//
// Not thread-safe.
#pragma once

#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>

#include <utility>
#include <vector>

#include "ductile/bullet/held_contacts.hpp"
#include "ductile/bullet/plastic_constraint.hpp"
#include "ductile/solve/island_solver.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::bullet {

class IslandSolver final : public btSequentialImpulseConstraintSolver {
  public:
    DUCTILE_INLINE btScalar solveGroup(btCollisionObject** bodies, int body_count,
                                       btPersistentManifold** manifolds, int manifold_count,
                                       btTypedConstraint** constraints, int constraint_count,
                                       const btContactSolverInfo& info, btIDebugDraw* drawer,
                                       btDispatcher* dispatcher) override;

    /// How contacts turned before the coming solve; null: nobody knows.
    void set_held(const HeldContacts* held) noexcept { held_ = held; }
    /// Whether what overlaps is pushed apart in a solve of its own.
    void set_pushes_apart(bool pushes) noexcept { pushes_apart_ = pushes; }

    [[nodiscard]] const solve::IslandReport& last() const noexcept { return report_; }

  protected:
    DUCTILE_INLINE void convertJoints(btTypedConstraint** constraints, int count,
                                      const btContactSolverInfo& info) override;
    DUCTILE_INLINE btScalar solveGroupCacheFriendlyIterations(
        btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds,
        int manifold_count, btTypedConstraint** constraints, int constraint_count,
        const btContactSolverInfo& info, btIDebugDraw* drawer) override;

  private:
    [[nodiscard]] static bool has_only_joints(btCollisionObject** bodies, int body_count,
                                              btPersistentManifold** manifolds, int manifold_count,
                                              btTypedConstraint** constraints,
                                              int constraint_count);
    void solve_joints(btCollisionObject** bodies, int body_count, btTypedConstraint** constraints,
                      int constraint_count, const btContactSolverInfo& info);
    void add_body(const btRigidBody& body);
    [[nodiscard]] static IslandSeat still_seat(const btRigidBody& body);
    void load_bodies();
    void load_plastic_joints(const btContactSolverInfo& info);
    void load_rows();
    void load_contacts();
    void find_turned(btPersistentManifold** manifolds, int count, double tick);
    [[nodiscard]] double turned(const void* point) const;
    void store();
    [[nodiscard]] IslandSeat seat(btRigidBody& body) const;
    solve::IslandRow& add_row(btSolverConstraint& row);

    solve::Island island_;
    solve::IslandSolver solver_;
    solve::IslandReport report_;
    std::vector<BodyState<double>> free_; ///< without rows, by number
    std::vector<int> number_;             ///< in the island, by Bullet's solver body
    std::vector<PlasticConstraint*> plastic_;
    std::vector<btTypedConstraint*> others_;
    std::vector<btSolverConstraint*> read_; ///< Bullet's rows, in the order of the island's
    std::size_t first_read_ = 0;
    const HeldContacts* held_ = nullptr;
    bool pushes_apart_ = true;
    std::vector<std::pair<const void*, double>> turned_; ///< of a contact point, sorted [m/s]
};

} // namespace ductile::bullet

#ifndef DUCTILE_COMPILED
#include "ductile/bullet/island_solver.ipp"
#endif
