// SPDX-License-Identifier: MIT
//
// Stands before the user's solver: an island with a plastic joint is solved at once
// (island_solver.hpp), all others go to the user's solver in its order, in one call a group, bit
// for bit as without.
//
// Bullet hands over a group of islands, each of bodies whose bounds overlap, or did of late. What
// is solved at once is less and does not depend on the past: bodies that contacts and constraints
// hold together, in the order of the world (touching_islands.hpp).
//
// Thread-safety: `solveGroup` may be called by several threads at once, for different islands, as
// far as the user's solver allows it (btConstraintSolverPoolMt does).
#pragma once

#include <BulletDynamics/ConstraintSolver/btConstraintSolver.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include <memory>
#include <mutex>
#include <optional>
#include <unordered_map>
#include <vector>

#include "ductile/bullet/held_contacts.hpp"
#include "ductile/bullet/island_batches.hpp"
#include "ductile/bullet/island_solver.hpp"
#include "ductile/bullet/softened_springs.hpp"
#include "ductile/bullet/touching_islands.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::bullet {

/// What a tick is of (world_parts.hpp).
enum class TickKind {
    step,
    part, ///< bodies are half a step ahead: of what is apart they go half a step's way nearer, not
          ///< a whole one's
    blow  ///< impulses alone: contacts of islands with plastic joints that touch are closed, all
          ///< others open
};

class FrontSolver final : public btConstraintSolver {
  public:
    /// `usual` must outlive this; `owned`: it ends with this, as Bullet's worlds end theirs.
    /// `world`: whose islands it is handed; null: one of several solvers of a world.
    FrontSolver(btConstraintSolver& usual, bool owned, btDiscreteDynamicsWorld* world = nullptr)
        : usual_(usual), owned_(owned) {
        if (world != nullptr) batches_.emplace(*world);
    }
    FrontSolver(const FrontSolver&) = delete;
    FrontSolver& operator=(const FrontSolver&) = delete;
    DUCTILE_INLINE ~FrontSolver() override;

    [[nodiscard]] btConstraintSolver& usual() const noexcept { return usual_; }

    /// Of the coming ticks; `held`: how contacts turned before a part, null: nobody knows.
    void set_kind(TickKind kind, double frame, const HeldContacts* held = nullptr) noexcept {
        kind_ = kind;
        frame_ = frame;
        held_ = kind == TickKind::part ? held : nullptr;
        if (kind != TickKind::step) own_ = {};
    }
    /// Bullet's springs and motors in the last part.
    [[nodiscard]] const OwnForces& own() const noexcept { return own_; }

    /// Islands of these are solved at once, too; null: there are none. Not while it solves.
    void set_direct(const DirectBodies* direct) noexcept { direct_ = direct; }
    /// The same of islands with springs (softened_springs.hpp).
    void set_springs(bool springs) noexcept { springs_ = springs; }
    /// The first one that came softened to a plastic joint in a part.
    [[nodiscard]] const std::optional<SoftenedSprings::Found>& softened() const noexcept {
        return softened_.found();
    }

    // ---- Bullet's side

    DUCTILE_INLINE void prepareSolve(int bodies, int manifolds) override;
    DUCTILE_INLINE btScalar solveGroup(btCollisionObject** bodies, int body_count,
                                       btPersistentManifold** manifolds, int manifold_count,
                                       btTypedConstraint** constraints, int constraint_count,
                                       const btContactSolverInfo& info, btIDebugDraw* drawer,
                                       btDispatcher* dispatcher) override;
    DUCTILE_INLINE void allSolved(const btContactSolverInfo& info, btIDebugDraw* drawer) override;
    DUCTILE_INLINE void reset() override;
    [[nodiscard]] btConstraintSolverType getSolverType() const override {
        return usual_.getSolverType();
    }

  private:
    /// What a call of solveGroup works with.
    struct Room {
        TouchingIslands islands;
        IslandSolver alone; ///< of joints that are all of their island: no topology to keep
    };
    /// The solver of an island, by its first plastic joint, or body: it keeps the topology.
    struct Kept {
        IslandSolver solver;
        bool used = true;
    };
    void note_springs(btTypedConstraint** constraints, int count, double h);
    void solve_plastic(IslandParts& island, IslandSolver& solver, const btContactSolverInfo& info,
                       btIDebugDraw* drawer, btDispatcher* dispatcher);
    btScalar solve_usual(btCollisionObject** bodies, int body_count,
                         btPersistentManifold** manifolds, int manifold_count,
                         btTypedConstraint** constraints, int constraint_count,
                         const btContactSolverInfo& info, btIDebugDraw* drawer,
                         btDispatcher* dispatcher);
    [[nodiscard]] std::unique_ptr<Room> borrow();
    void give_back(std::unique_ptr<Room> room);
    [[nodiscard]] std::shared_ptr<Kept> solver_of(const IslandParts& island);

    friend class FrontHold;

    btConstraintSolver& usual_;
    bool owned_;
    std::optional<IslandBatches> batches_;
    bool handed_over_ = false; ///< what comes was solved
    TickKind kind_ = TickKind::step;
    double frame_ = 0; ///< [s]
    const HeldContacts* held_ = nullptr;
    const DirectBodies* direct_ = nullptr;
    bool springs_ = false;
    std::shared_ptr<FrontSolver*> self_ = std::make_shared<FrontSolver*>(this);
    std::mutex mutex_; ///< of what follows
    OwnForces own_;
    SoftenedSprings softened_;
    std::vector<std::unique_ptr<Room>> idle_;
    std::unordered_map<const void*, std::shared_ptr<Kept>> kept_;
};

/// Puts a front before the solver of a world, and takes it away again. Whichever ends first: the
/// front belongs to the world, which ends it with itself.
class FrontHold {
  public:
    /// @throws std::invalid_argument where there is a front already.
    explicit FrontHold(btDiscreteDynamicsWorld& world);
    DUCTILE_INLINE ~FrontHold();
    FrontHold(const FrontHold&) = delete;
    FrontHold& operator=(const FrontHold&) = delete;

    /// Of the front, which has to be in place.
    [[nodiscard]] btConstraintSolver& usual() const { return (**front_.lock()).usual(); }
    /// False once Bullet's world has ended.
    [[nodiscard]] bool is_alive() const noexcept { return !front_.expired(); }
    /// In a frame of `frame` [s].
    void set_kind(TickKind kind, double frame = 0, const HeldContacts* held = nullptr) const {
        (**front_.lock()).set_kind(kind, frame, held);
    }
    [[nodiscard]] const OwnForces& own() const { return (**front_.lock()).own(); }
    void set_direct(const DirectBodies* direct) const { (**front_.lock()).set_direct(direct); }
    void set_springs(bool springs) const { (**front_.lock()).set_springs(springs); }
    [[nodiscard]] const std::optional<SoftenedSprings::Found>& softened() const {
        return (**front_.lock()).softened();
    }

  private:
    btDiscreteDynamicsWorld& world_;
    std::weak_ptr<FrontSolver*> front_; ///< nothing once the world has ended
};

} // namespace ductile::bullet

#ifndef DUCTILE_COMPILED
#include "ductile/bullet/front_solver.ipp"
#endif
