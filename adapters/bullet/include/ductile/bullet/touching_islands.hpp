// SPDX-License-Identifier: MIT
//
// Which of the bodies that Bullet hands to its solver at once are really one island: those that
// contact points and constraints hold together. Bullet's own islands are of bodies whose bounds
// overlap, or did some ticks ago, and their order depends on what is beside them.
//
// Islands of which a constraint is chosen are listed one by one, in the order of the world's
// bodies; the rest in Bullet's order.
//
// Not thread-safe; for bodies that no other thread is given meanwhile.
#pragma once

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>

#include <cstddef>
#include <span>
#include <vector>

#include "ductile/vocabulary/linkage.hpp"

namespace ductile::bullet {

/// Bodies whose islands are chosen whatever holds them together, by their places in the world.
struct DirectBodies {
    std::vector<char> by_place;
    bool any = false;

    [[nodiscard]] bool has(const btCollisionObject& object) const noexcept {
        const int place = object.getWorldArrayIndex();
        return any && place >= 0 && place < int(by_place.size()) && by_place[std::size_t(place)];
    }
};

struct IslandParts {
    std::vector<btCollisionObject*> bodies;
    std::vector<btPersistentManifold*> manifolds;
    std::vector<btTypedConstraint*> constraints;

    void clear() {
        bodies.clear();
        manifolds.clear();
        constraints.clear();
    }
};

class TouchingIslands {
  public:
    using Choice = bool (*)(btTypedConstraint*);

    void find(btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds,
              int manifold_count, btTypedConstraint** constraints, int constraint_count,
              Choice choice, const DirectBodies& direct);
    /// Islands with a constraint or body that was chosen, or that touch such a body, or hang on it.
    [[nodiscard]] std::span<IslandParts> chosen() noexcept { return {islands_.data(), count_}; }
    [[nodiscard]] IslandParts& others() noexcept { return others_; }

  private:
    static constexpr int nowhere = -1;

    /// An island is chosen.
    void choose(int root);
    [[nodiscard]] int root(int body) noexcept;
    /// Of one of two bodies that are held together; nowhere where neither is in an island.
    [[nodiscard]] int island_of(const btCollisionObject& a, const btCollisionObject& b) noexcept;
    void unite(const btCollisionObject& a, const btCollisionObject& b) noexcept;
    [[nodiscard]] IslandParts& parts_of(int root) noexcept;

    std::vector<int> parent_, island_; ///< by body
    std::vector<IslandParts> islands_; ///< room that is used again; the first count_
    std::size_t count_ = 0;
    IslandParts others_;
};

} // namespace ductile::bullet

#ifndef DUCTILE_COMPILED
#include "ductile/bullet/touching_islands.ipp"
#endif
