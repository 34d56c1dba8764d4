// SPDX-License-Identifier: MIT
//
// Which contacts on islands with plastic joints close, from Bullet's own shapes: whatever the
// broadphase has near a body of such an island, and may reach it in time, is asked for its closest
// points.
//
//   a point that is `d` apart and closes at v does so in d/v, with the energy v²/(2 K),
//   K = 1/effective mass of the point
//
// Many of Bullet's algorithms know no contact before shapes overlap, so a gap is aimed at a hair
// beyond its closing, and what touches overlaps.
//
// A pair whose bounds cannot meet in time, or that could not close with the energy that matters,
// is not asked for. An island is that of Bullet's last tick, and the bodies of the joints.
//
// Not thread-safe.
#pragma once

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <utility>
#include <vector>

#include "ductile/bullet/plastic_constraint.hpp"
#include "ductile/frame/part_engine.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::bullet {

/// A point this near is closed; half of it is the hair [m].
inline constexpr double closed_gap = sizeof(btScalar) == sizeof(double) ? 1e-8 : 2e-6;

class ClosingContactsFinder {
  public:
    /// As PartEngine::closing.
    [[nodiscard]] ClosingContacts find(btDiscreteDynamicsWorld& world, double h, double touching,
                                       double apart);

  private:
    void find_islands(btDiscreteDynamicsWorld& world);
    void list_pairs(btDiscreteDynamicsWorld& world, btScalar h, double least);
    [[nodiscard]] bool is_plastic(const btRigidBody& body) const;

    struct Pair {
        btCollisionObject* a;
        btCollisionObject* b;
        btScalar reach; ///< how far they can come in time [m]
    };
    std::vector<const btRigidBody*> joined_; ///< bodies of plastic joints, sorted
    std::vector<int> islands_;               ///< sorted
    std::vector<Pair> pairs_;
};

} // namespace ductile::bullet

#ifndef DUCTILE_COMPILED
#include "ductile/bullet/closing_contacts.ipp"
#endif
