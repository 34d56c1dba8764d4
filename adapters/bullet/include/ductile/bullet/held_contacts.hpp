// SPDX-License-Identifier: MIT
//
// Contacts of islands with plastic joints as the last tick had them, beside what they are in the
// next one: how they turned since (world/turned_contact.hpp), and which of them are gone, as one
// body slid off the other.
//
// Bullet lets a point go that slid farther than 2 % of the smaller body's reach, but only after it
// has looked for new ones, for which the old ones left no room: what slides fast then stands on one
// or two corners for a part, sinks, and strikes with the others in the next one. `let_go` is before
// that look.
//
// Not thread-safe, but for `turned`.
#pragma once

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "ductile/vocabulary/linkage.hpp"
#include "ductile/world/turned_contact.hpp"

namespace ductile::bullet {

class HeldContacts {
  public:
    using Bodies = std::pair<const btCollisionObject*, const btCollisionObject*>;
    using Concerns = std::function<bool(const btCollisionObject&)>;

    /// Before bodies move: the manifolds are of a tick that was solved `ago` >= 0 [s] ago. Of
    /// bodies that `concerns`.
    void see(std::span<btPersistentManifold* const> manifolds, double ago,
             const Concerns& concerns);
    /// Lets points go that slid too far, as bodies are now, `time` [s] after they were looked for.
    static void let_go(std::span<btPersistentManifold* const> manifolds, double time,
                       const Concerns& concerns);
    /// w of a point in the middle of a part of `h` [s], as its bodies are there, not yet solved
    /// [m/s].
    [[nodiscard]] double turned(const btPersistentManifold& manifold, const btManifoldPoint& point,
                                double h) const;
    /// After a part of `h` [s]: whether bodies that pushed each other in it, or when it began, are
    /// apart farther than they part in it, and were not so before: Bullet keeps points that slid,
    /// and they go on pushing where shapes are 0.1 mm apart.
    [[nodiscard]] bool lost(btDiscreteDynamicsWorld& world,
                            std::span<btPersistentManifold* const> manifolds, double h,
                            const Concerns& concerns);
    /// The farthest that a body turned in a part of `h` [s] that something pushed in it [rad].
    [[nodiscard]] static double turn(std::span<btPersistentManifold* const> manifolds, double h,
                                     const Concerns& concerns);
    /// The part stands.
    void accept() { gone_ = lost_; }

  private:
    std::vector<std::pair<Bodies, SeenContact>> seen_; ///< sort_by_bodies
    double ago_ = 0;
    std::vector<Bodies> pushed_;      ///< when the part began
    std::vector<Bodies> lost_, gone_; ///< in the last part, and before the present one
};

} // namespace ductile::bullet

#ifndef DUCTILE_COMPILED
#include "ductile/bullet/held_contacts.ipp"
#endif
