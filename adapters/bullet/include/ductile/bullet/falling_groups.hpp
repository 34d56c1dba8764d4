// SPDX-License-Identifier: MIT
//
// Which of the bodies of a Bullet world that are about to fall nothing holds: bodies that hang
// together by constraints are one group, held where a contact, or a constraint to what is none of
// them, holds any of it. Disjoint sets by place in the world.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <cstddef>
#include <span>
#include <vector>

namespace ductile::bullet {

/// Of one world, as it is when this is made. Not thread-safe.
class FallingGroups {
  public:
    /// `objects`: of the world; `bodies`: those that are about to fall, each a group.
    FallingGroups(int objects, std::span<const btRigidBody* const> bodies)
        : first_(std::size_t(objects), nobody), held_(std::size_t(objects)) {
        for (const btRigidBody* body : bodies) {
            first_[place(*body)] = body->getWorldArrayIndex();
        }
    }
    /// A constraint between the two, whatever they are.
    void join(const btCollisionObject& a, const btCollisionObject& b) {
        if (!has(a) || !has(b)) {
            hold(a);
            hold(b);
            return;
        }
        const auto from = group(a), to = group(b);
        first_[from] = int(to);
        held_[to] = char(held_[to] | held_[from]);
    }
    /// Something touches it; what is no body of these is left alone.
    void hold(const btCollisionObject& object) {
        if (has(object)) held_[group(object)] = 1;
    }
    /// `object` is one of the bodies.
    [[nodiscard]] bool is_held(const btCollisionObject& object) {
        return held_[group(object)] != 0;
    }

  private:
    static constexpr int nobody = -1;
    [[nodiscard]] static std::size_t place(const btCollisionObject& object) {
        return std::size_t(object.getWorldArrayIndex());
    }
    [[nodiscard]] bool has(const btCollisionObject& object) const {
        return object.getWorldArrayIndex() >= 0 && place(object) < first_.size() &&
               first_[place(object)] != nobody;
    }
    [[nodiscard]] std::size_t group(const btCollisionObject& object) {
        auto at = place(object);
        while (first_[at] != int(at)) {
            first_[at] = first_[std::size_t(first_[at])];
            at = std::size_t(first_[at]);
        }
        return at;
    }

    std::vector<int> first_; ///< of a body's group, or another nearer to that, by place
    std::vector<char> held_; ///< by the first
};

} // namespace ductile::bullet
