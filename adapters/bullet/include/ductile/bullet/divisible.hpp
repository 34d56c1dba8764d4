// SPDX-License-Identifier: MIT
//
// What is fewer bodies than it may come to be, as a world sees it: a member, a structure.
#pragma once

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <LinearMath/btVector3.h>

#include <span>
#include <vector>

#include "ductile/bullet/piece_maker.hpp"
#include "ductile/member/active_sections.hpp"

class btTypedConstraint;

namespace ductile::bullet {

class PlasticConstraint;

/// Of a body as the tick solves it.
struct BodyBefore {
    btTransform pose;
    btVector3 velocity, spin;
};

/// What opened or closed; `key`: whose reports tell of it.
struct DivisionChange {
    const void* key;
    int section;
};

/// Contacts that act on it, as body A or B of these.
struct ContactTouch {
    const btPersistentManifold* manifold;
    bool of_a;
    bool asleep = false; ///< what lies there was not solved in this tick
    double share = 1;    ///< of their impulses that act in it
};

/// Not thread-safe.
class Divisible {
  public:
    Divisible() = default;
    Divisible(const Divisible&) = delete;
    Divisible& operator=(const Divisible&) = delete;
    virtual ~Divisible() = default;

    /// The bodies that it is now.
    [[nodiscard]] virtual std::span<const PieceBody> pieces() const = 0;
    /// Where nothing touches it and no force was applied, nothing can have become of it.
    [[nodiscard]] virtual bool idle() const = 0;
    [[nodiscard]] virtual bool whole() const = 0;
    /// The last look met what it cannot be asked, which its report says.
    [[nodiscard]] virtual bool doubts() const { return false; }
    /// A driven body passes through what does not move of it.
    virtual void driven_through() = 0;
    /// Under which a joint of its own is reported, and of which section it is; null: not its own.
    [[nodiscard]] virtual const void* key_of(const PlasticConstraint& joint,
                                             int& section) const = 0;
    /// Of sections that are closed [J]; that of a least travel, 0: of none.
    [[nodiscard]] virtual double closed_work() const = 0;
    [[nodiscard]] virtual double unmissed_work() const = 0;
    /// @throws std::logic_error where it cannot be stepped.
    virtual void require_possible() const = 0;
    /// @throws std::invalid_argument of a constraint of the user's on a body of it that it does not
    /// know of.
    virtual void require_attached(const btTypedConstraint& constraint) const = 0;
    /// Constraints of the user's hold on to it, which it knows of.
    [[nodiscard]] virtual bool is_held() const = 0;
    virtual void list_holds(std::vector<const btTypedConstraint*>& list) const = 0;
    /// It is in the world no more.
    virtual void leave() = 0;

    // ---- a tick

    /// Forces that were applied to it act in the coming tick, too; they do not any more.
    virtual void apply_forces() = 0;
    virtual void drop_forces() = 0;
    /// Nothing is known of the tick yet.
    virtual void begin() = 0;
    /// Contacts acted on it with impulses that add up to `sum` [N s].
    virtual void touch(const ContactTouch& touch, double sum) = 0;
    /// Contacts are known: adds up the rest.
    virtual void sum_up(double dt) = 0;
    /// Something struck it, or may have, through what holds it.
    [[nodiscard]] virtual bool touched() const = 0;
    /// Whether what acted on it could load a section beyond its strength. `before`: by place in the
    /// world.
    [[nodiscard]] virtual bool may_be_beyond(double dt, std::span<const BodyBefore> before,
                                             const btVector3& gravity) const = 0;
    /// Lists all that acted.
    virtual void read(double dt, std::span<const BodyBefore> before, const btVector3& gravity) = 0;
    /// Sections to open after a tick that was read.
    virtual void find_beyond(double dt, std::vector<int>& sections) = 0;
    /// Constraints of the user's count in it that take more than `noticed` [J].
    virtual void begin_blow(double noticed) = 0;
    /// Constraints that hold on to it what can move are off, so that the bodies go as they would
    /// without it; false: there are none.
    virtual bool switch_holds_off() = 0;
    /// So they go, until the next blow.
    virtual void see_coming() = 0;
    virtual void find_struck(std::vector<int>& sections) = 0;
    virtual void open(std::span<const int> sections, bool ahead,
                      std::vector<DivisionChange>& told) = 0;
    /// A tick stands: what it left in vibration, of what its sections took [J].
    virtual double count_vibration() = 0;
    /// The same, or a blow comes: closes what held, false where nothing did.
    virtual bool close_held(Closing when, bool ahead, std::vector<DivisionChange>& told) = 0;
};

} // namespace ductile::bullet
