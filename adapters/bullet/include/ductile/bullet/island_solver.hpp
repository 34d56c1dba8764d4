// SPDX-License-Identifier: MIT
//
// One of Bullet's islands, solved at once (solve/island_solver.hpp): plastic joints state their
// rows themselves, contacts and the other constraints are read from the rows that Bullet makes of
// them.
//
// Between Bullet's setup and its finish, which stay as they are:
//   body      inverse mass × linear factor; world inertia with the angular factor on both sides
//   row       b = m_rhs/m_jacDiagABInv, C = m_cfm/m_jacDiagABInv; m_jacDiagABInv = 0: no row
//             where bodies are half a step ahead (frame/README.md): one that holds both ways is to
//             be right at the end of the part, as rows of plastic joints are (joint/any_link.hpp).
//             With J where bodies go by their velocities until then and J as it is in the middle,
//             it leaves the solve at w = (J - J_end) v. What was off as the part began is put back:
//             e = (4 e_mid - e_end)/3, of straight ways that lead off by the square of the time
//   contact   one cone with its friction rows (solve/contact_form.hpp): two directions always, as
//             with one loose structures walk in every solver
//   answer    impulses into Bullet's rows, velocities into its solver bodies, in place of those of
//   the
//             warm start
//
// Traps of Bullet 3.24 that this header deals with
//   - Large limits stand for infinite ones: 1e10 for contacts, SIMD_INFINITY for joints.
//   - Its friction rows know what forces give their bodies in a tick, but not what torques do.
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
#include "ductile/bullet/stated_rows.hpp"
#include "ductile/frame/part_engine.hpp"
#include "ductile/frame/part_settings.hpp"
#include "ductile/frame/soft_contact.hpp"
#include "ductile/solve/island_solver.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::bullet {

namespace detail {
/// A spring of Bullet's, by its constraint's row.
struct OwnSpring {
    int row;
    double stiffness, damping; ///< [N/m | N m/rad], [N s/m | N m s/rad]
    double strain;             ///< that grows with the row's velocity [m | rad]
};
/// Its row in an island.
struct SpringRow {
    std::size_t row;
    double stiffness, mass, start; ///< of the row; its velocity as the part began
    LawRow law;
};
/// A contact's that gives way.
struct SoftRow {
    std::size_t row;
    SoftContact law;
    double start, added; ///< speed at which it opens as the part begins, less that of its row [m/s]
};
} // namespace detail

class IslandSolver final : public btSequentialImpulseConstraintSolver {
  public:
    DUCTILE_INLINE btScalar solveGroup(btCollisionObject** bodies, int body_count,
                                       btPersistentManifold** manifolds, int manifold_count,
                                       btTypedConstraint** constraints, int constraint_count,
                                       const btContactSolverInfo& info, btIDebugDraw* drawer,
                                       btDispatcher* dispatcher) override;

    /// How contacts turned before the coming solve; null: nobody knows.
    void set_held(const HeldContacts* held) noexcept { held_ = held; }
    /// Whether bodies are half a step ahead (half_ahead.hpp), or it is a blow, in a frame of
    /// `frame` [s].
    void set_ahead(bool ahead, bool blow, double frame) noexcept {
        ahead_ = ahead;
        blow_ = blow;
        frame_ = frame;
    }
    /// Whether what overlaps is pushed apart in a solve of its own.
    void set_pushes_apart(bool pushes) noexcept { pushes_apart_ = pushes; }

    [[nodiscard]] const solve::IslandReport& last() const noexcept { return report_; }
    /// Bullet's springs and motors in the last solve, if it was of a part.
    [[nodiscard]] const OwnForces& own() const noexcept { return own_; }

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
    template <class Seat>
    void solve_island(const Seat& seat_of);
    [[nodiscard]] static IslandSeat still_seat(const btRigidBody& body);
    void load_bodies();
    void load_plastic_joints(const btContactSolverInfo& info);
    void look_ahead(const btContactSolverInfo& info);
    void load_rows();
    void turn_rows();
    void load_springs();
    void load_motors();
    void read_own();
    [[nodiscard]] Vector6<double> began(int body) const;
    [[nodiscard]] Vector6<double> pushed(int body) const;
    [[nodiscard]] double began(const btSolverConstraint& row) const;
    [[nodiscard]] double pushed(const btSolverConstraint& row) const;
    void load_contacts();
    void soften(const SoftContact& soft, const btSolverConstraint& row,
                const btManifoldPoint& point, solve::IslandRow& normal);
    void find_turned(btPersistentManifold** manifolds, int count, double tick);
    [[nodiscard]] double turned(const void* point) const;
    [[nodiscard]] double torque_left_out(const btSolverConstraint& friction) const;
    [[nodiscard]] double turns_away(const btSolverConstraint& friction,
                                    const btManifoldPoint& point) const;
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
    bool ahead_ = false, blow_ = false;
    double frame_ = 0; ///< [s]
    double half_ = 0;  ///< of the tick [s]
    bool pushes_apart_ = true;
    std::vector<StatedRow> at_end_;              ///< of the others' rows, constraint by constraint
    std::vector<int> count_at_end_;              ///< rows of each
    std::vector<detail::OwnSpring> springs_;     ///< of one of them
    std::vector<detail::SpringRow> spring_rows_; ///< of all
    std::vector<detail::SoftRow> soft_rows_;
    std::vector<StatedRow> unstopped_; ///< of constraints with a motor at its stop, without that
    std::vector<int> unstopped_count_; ///< rows of each of the others, 0: it has none
    std::vector<std::pair<std::size_t, std::size_t>> motor_rows_; ///< its stop's of Bullet, its own
    OwnForces own_;
    std::vector<std::pair<const void*, double>> turned_; ///< of a contact point, sorted [m/s]
};

} // namespace ductile::bullet

#ifndef DUCTILE_COMPILED
#include "ductile/bullet/island_solver.ipp"
#endif
