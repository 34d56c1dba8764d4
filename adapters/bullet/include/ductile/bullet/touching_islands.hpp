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

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "ductile/vocabulary/disjoint_sets.hpp"

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
              Choice choice, const DirectBodies& direct) {
        together_.reset(std::size_t(body_count));
        for (int i = 0; i < body_count; ++i) {
            bodies[i]->setCompanionId(bodies[i]->isStaticOrKinematicObject() ? nowhere : i);
        }
        for (int i = 0; i < manifold_count; ++i) {
            if (manifolds[i]->getNumContacts() == 0) continue;
            unite(*manifolds[i]->getBody0(), *manifolds[i]->getBody1());
        }
        for (int i = 0; i < constraint_count; ++i) {
            if (!constraints[i]->isEnabled()) continue;
            unite(constraints[i]->getRigidBodyA(), constraints[i]->getRigidBodyB());
        }
        island_.assign(std::size_t(body_count), nowhere);
        count_ = 0;
        others_.clear();
        for (int i = 0; i < constraint_count; ++i) {
            const btRigidBody &a = constraints[i]->getRigidBodyA(),
                              &b = constraints[i]->getRigidBodyB();
            const bool on_direct = constraints[i]->isEnabled() && (direct.has(a) || direct.has(b));
            if (choice(constraints[i]) || on_direct) choose(island_of(a, b));
        }
        for (int i = 0; direct.any && i < body_count; ++i) {
            if (direct.has(*bodies[i])) choose(island_of(*bodies[i], *bodies[i]));
        }
        for (int i = 0; direct.any && i < manifold_count; ++i) {
            const btCollisionObject &a = *manifolds[i]->getBody0(), &b = *manifolds[i]->getBody1();
            if (manifolds[i]->getNumContacts() > 0 && (direct.has(a) || direct.has(b))) {
                choose(island_of(a, b));
            }
        }
        for (int i = 0; i < body_count; ++i) {
            const int id = bodies[i]->getCompanionId();
            parts_of(id == nowhere ? nowhere : together_.root(id)).bodies.push_back(bodies[i]);
        }
        for (int i = 0; i < manifold_count; ++i) {
            const btCollisionObject &a = *manifolds[i]->getBody0(), &b = *manifolds[i]->getBody1();
            IslandParts& parts = parts_of(island_of(a, b));
            // a solver writes to both bodies of a manifold, also of one without points
            if (&parts == &parts_of(island_of(b, a))) parts.manifolds.push_back(manifolds[i]);
        }
        for (int i = 0; i < constraint_count; ++i) {
            parts_of(island_of(constraints[i]->getRigidBodyA(), constraints[i]->getRigidBodyB()))
                .constraints.push_back(constraints[i]);
        }
        // as solvers begin with
        for (int i = 0; i < body_count; ++i) bodies[i]->setCompanionId(nowhere);
        const auto place = [](const btCollisionObject& a, const btCollisionObject& b) {
            return std::pair(a.getWorldArrayIndex(), b.getWorldArrayIndex());
        };
        for (IslandParts& island : chosen()) {
            std::sort(island.bodies.begin(), island.bodies.end(),
                      [](const btCollisionObject* x, const btCollisionObject* y) {
                          return x->getWorldArrayIndex() < y->getWorldArrayIndex();
                      });
            std::stable_sort(
                island.manifolds.begin(), island.manifolds.end(),
                [&place](const btPersistentManifold* x, const btPersistentManifold* y) {
                    return place(*x->getBody0(), *x->getBody1()) <
                           place(*y->getBody0(), *y->getBody1());
                });
            if (island.constraints.size() < 2) continue; // it would take memory for one
            std::stable_sort(island.constraints.begin(), island.constraints.end(),
                             [&place](const btTypedConstraint* x, const btTypedConstraint* y) {
                                 return place(x->getRigidBodyA(), x->getRigidBodyB()) <
                                        place(y->getRigidBodyA(), y->getRigidBodyB());
                             });
        }
    }
    /// Islands with a constraint or body that was chosen, or that touch such a body, or hang on it.
    [[nodiscard]] std::span<IslandParts> chosen() noexcept { return {islands_.data(), count_}; }
    [[nodiscard]] IslandParts& others() noexcept { return others_; }

  private:
    static constexpr int nowhere = -1;

    /// An island is chosen.
    void choose(int root) {
        if (root == nowhere || island_[std::size_t(root)] != nowhere) return;
        island_[std::size_t(root)] = int(count_++);
        if (count_ > islands_.size()) islands_.emplace_back();
        islands_[count_ - 1].clear();
    }
    /// Of one of two bodies that are held together; nowhere where neither is in an island.
    [[nodiscard]] int island_of(const btCollisionObject& a, const btCollisionObject& b) noexcept {
        const btCollisionObject& held = a.isStaticOrKinematicObject() ? b : a;
        const int id = held.isStaticOrKinematicObject() ? nowhere : held.getCompanionId();
        return id < 0 || id >= together_.size() ? nowhere : together_.root(id);
    }
    void unite(const btCollisionObject& a, const btCollisionObject& b) noexcept {
        if (a.isStaticOrKinematicObject() || b.isStaticOrKinematicObject()) return;
        if (a.getCompanionId() < 0 || b.getCompanionId() < 0) return;
        together_.unite(a.getCompanionId(), b.getCompanionId());
    }
    [[nodiscard]] IslandParts& parts_of(int root) noexcept {
        const int island = root == nowhere ? nowhere : island_[std::size_t(root)];
        return island == nowhere ? others_ : islands_[std::size_t(island)];
    }

    DisjointSets together_;            ///< bodies
    std::vector<int> island_;          ///< by body
    std::vector<IslandParts> islands_; ///< room that is used again; the first count_
    std::size_t count_ = 0;
    IslandParts others_;
};

} // namespace ductile::bullet
