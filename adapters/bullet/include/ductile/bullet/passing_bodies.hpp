// SPDX-License-Identifier: MIT
//
// Pairs of bodies that pass through each other. Bullet keeps the addresses of such bodies with each
// other: told before they end, it meets no new body at an old address as one that it passes.
//
// Not thread-safe.
#pragma once

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <utility>
#include <vector>

namespace ductile::bullet {

class PassingBodies {
  public:
    PassingBodies() = default;
    ~PassingBodies() { clear(); }
    PassingBodies(const PassingBodies&) = delete;
    PassingBodies& operator=(const PassingBodies&) = delete;

    /// Both have to live until `clear`, or until this ends.
    void add(btRigidBody& a, btRigidBody& b) {
        a.setIgnoreCollisionCheck(&b, true);
        pairs_.emplace_back(&a, &b);
    }
    /// They meet again.
    void clear() {
        for (const auto& [a, b] : pairs_) a->setIgnoreCollisionCheck(b, false);
        pairs_.clear();
    }

  private:
    std::vector<std::pair<btRigidBody*, btRigidBody*>> pairs_;
};

} // namespace ductile::bullet
