// SPDX-License-Identifier: MIT
//
// What is fewer bodies than it may come to be, as a world sees it: a member, a structure.
#pragma once

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <LinearMath/btVector3.h>

#include <span>
#include <vector>

#include "ductile/bullet/piece_maker.hpp"
#include "ductile/member/divisible.hpp"

class btTypedConstraint;

namespace ductile::bullet {

class PlasticConstraint;
struct Attachment;

/// Of a body as the tick solves it.
struct BodyBefore {
    btTransform pose;
    btVector3 velocity, spin;
};

/// Contacts that act on it, as body A or B of these.
struct ContactTouch {
    const btPersistentManifold* manifold;
    bool of_a;
    bool asleep = false; ///< what lies there was not solved in this tick
    double share = 1;    ///< of their impulses that act in it
};

/// Not thread-safe.
class Divisible : public ductile::Divisible<PlasticConstraint, Attachment> {
  public:
    /// The bodies that it is now.
    [[nodiscard]] virtual std::span<const PieceBody> all_pieces() const = 0;
    /// Where nothing touches it and no force was applied, nothing can have become of it.
    [[nodiscard]] virtual bool idle() const = 0;
    /// The last look met what it cannot be asked, which its report says.
    [[nodiscard]] virtual bool doubts() const { return false; }
    /// @throws std::logic_error where it cannot be stepped.
    virtual void require_possible() const = 0;
    /// @throws std::invalid_argument of a constraint of the user's on a body of it that it does not
    /// know of.
    virtual void require_attached(const btTypedConstraint& constraint) const = 0;
    /// Constraints of the user's hold on to it, which it knows of.
    [[nodiscard]] virtual bool is_held() const = 0;

    // ---- a tick

    /// Nothing is known of the tick yet.
    virtual void begin() = 0;
    /// Contacts acted on it with impulses that add up to `sum` [N s].
    virtual void touch(const ContactTouch& touch, double sum) = 0;
    /// Contacts are known: adds up the rest.
    virtual void sum_up(double dt) = 0;
    /// Something struck it, or may have, through what holds it.
    [[nodiscard]] virtual bool touched() const = 0;
    /// Of the strength of a section that what acted on it could load it with, at most. `before`: by
    /// place in the world.
    [[nodiscard]] virtual double most_share(double dt, std::span<const BodyBefore> before,
                                            const btVector3& gravity) const = 0;
    /// Sections to open after a tick, or a blow, by all that acted.
    virtual void find_beyond(double dt, std::span<const BodyBefore> before,
                             const btVector3& gravity, std::vector<int>& sections) = 0;
    virtual void find_struck(double dt, std::span<const BodyBefore> before,
                             const btVector3& gravity, std::vector<int>& sections) = 0;
};

} // namespace ductile::bullet
