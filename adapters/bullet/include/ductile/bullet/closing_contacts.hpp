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
// beyond its closing, so that what touches overlaps: with all corners, where faces are flush. What
// was just put down on something has no speed yet, and would fall through it for a part: its gap
// closes by its weight.
//
// What closes with little energy counts all the same where a part, half of which comes before
// contacts are looked for, would carry a body past it: a light bar before a heavy hammer.
//
// A pair whose bounds cannot meet in time, or that could not close with the energy that matters,
// is not asked for; where nothing in the world could, nobody is. Where little goes far, that alone
// looks for what is near; what stays within the room that Bullet's trees leave around a body is
// among Bullet's own pairs. An island is that of Bullet's last
// tick, and the bodies of the joints.
//
// Others know contacts before they touch, and these push so that the gap just closes at the end of
// a part. Where bodies gain speed on the way, by their weight say, that takes the gain away, and
// the force came too early: `closed_early` tells when the gap closed by itself, to which the part
// has to be cut. With the impulse J, of a gap d in the middle of a part of h,
//
//   v = 2 d/h at the end;   J K = speed that was taken;   s = h (1 - J K/(2 (v + J K)))
//
// K is that of both bodies free: where one is held s is rather too early, and what is left of the
// gap closes in a part of its own.
//
// A gap that closes slowly as a part begins, and is not aimed at, may be hurried within it by what
// flows, unknown to Bullet until shapes overlap: where they passed each other with an energy that
// counts, it closed where a constant gain of speed has it, and the part is cut there, too. So may
// what touches and turns, which is apart in the middle of a part and falls back until its end: half
// of the part comes first.
//
// Two bodies that turn may close elsewhere than where they are nearest (closing_points.ipp). They
// are asked for where they go: a point in which they overlap there, with an energy that counts, is
// followed back along its way.
//
// Not thread-safe.
#pragma once

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <memory>
#include <span>
#include <vector>

#include "ductile/bullet/driven_ways.hpp"
#include "ductile/bullet/local_scope.hpp"
#include "ductile/bullet/plastic_constraint.hpp"
#include "ductile/frame/part_engine.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::bullet {

/// A point this near is closed; half of it is the hair [m].
inline constexpr double closed_gap = sizeof(btScalar) == sizeof(double) ? 1e-8 : 2e-6;

class Divisibles;

namespace detail {
class ShapeReach;

/// Of two bodies that touch there too, beside where they are nearest.
struct StruckPoint {
    const btCollisionObject *a, *b;
    btVector3 normal, on_b;
    double gap; ///< [m]
};
} // namespace detail

class ClosingContactsFinder {
  public:
    /// `driven`: those who go their way over the frame, for Bullet mostly static ones.
    ClosingContactsFinder(const std::unique_ptr<Divisibles>& members, const DrivenWays& driven)
        : members_(members), driven_(driven) {}

    /// Of the frame that begins [s].
    void set_frame(double length) noexcept { frame_ = length; }
    /// From now on it looks at these alone, and at what is static beside them; null: at all again.
    void set_scope(const LocalScope* scope) noexcept { scope_ = scope; }
    /// Bodies of pairs that the last `find` or `closed_early` found.
    [[nodiscard]] std::span<const btRigidBody* const> found_bodies() const noexcept {
        return found_bodies_;
    }
    /// Bodies beside the scope's that the last `find` would have had to look at.
    [[nodiscard]] const std::vector<btRigidBody*>& foreign() const noexcept { return foreign_; }
    /// As PartEngine::closing. A member is struck like an island with plastic joints.
    [[nodiscard]] ClosingContacts find(btDiscreteDynamicsWorld& world, double h, double touching,
                                       double apart);
    /// When, in the part of `h` [s] that the last tick did, the first gap closed that pushed
    /// before, or not at all [s]; 0 where none did. Those that close with less energy than `apart`
    /// [J] do not count. Islands are those of the last `find`.
    [[nodiscard]] double closed_early(btDiscreteDynamicsWorld& world, double h, double apart);
    /// Joints may be others than they were; whether there are plastic ones.
    [[nodiscard]] bool any_plastic(btDiscreteDynamicsWorld& world) {
        find_islands(world);
        return !joined_.empty();
    }
    /// Has Bullet know what the last `find` saw of points that strike, where its algorithms know
    /// one a tick: all shapes but boxes on boxes.
    void show_struck(btDiscreteDynamicsWorld& world) const;
    /// Some contact of bodies that the last `find` saw may give way, and swing.
    [[nodiscard]] bool any_soft() const noexcept { return any_soft_; }
    /// Bodies that the last `find` saw may have ended.
    void forget_open() noexcept {
        open_.clear();
        struck_.clear();
    }

    /// Whether a body is in an island with plastic joints.
    [[nodiscard]] bool touches_plastic(btDiscreteDynamicsWorld& world, const btRigidBody& body) {
        if (!found_islands_) find_islands(world);
        return is_plastic(body);
    }

  private:
    struct Pair {
        btCollisionObject* a;
        btCollisionObject* b;
        btScalar reach; ///< how far they can come in time [m]
        bool turns;     ///< fast enough to close elsewhere than where they are nearest
    };
    /// Bounds of all bodies.
    struct Fastest {
        double speed;        ///< of any point of one that is awake [m/s]
        double inverse_mass; ///< of the heaviest [1/kg]
    };
    [[nodiscard]] Fastest find_fastest(const btDiscreteDynamicsWorld& world, btScalar h) const;
    void find_falling(btDiscreteDynamicsWorld& world, btScalar h);
    [[nodiscard]] btVector3 falls(const btCollisionObject& object) const;
    void add_joint(const btTypedConstraint& constraint);
    void look_ahead(btDiscreteDynamicsWorld& world, const Pair& pair, double h, double touching,
                    double apart, ClosingContacts& found);
    void note_found(const btCollisionObject& a, const btCollisionObject& b);
    void find_islands(btDiscreteDynamicsWorld& world);
    void list_pairs(btDiscreteDynamicsWorld& world, btScalar h, double least, btScalar fastest);
    void add_pair(btDiscreteDynamicsWorld& world, btCollisionObject& one, btCollisionObject& two,
                  btScalar h, double least, detail::ShapeReach& shapes);
    [[nodiscard]] btScalar reach(const btRigidBody& body, btScalar h,
                                 detail::ShapeReach& shapes) const;
    /// A contact on it may count.
    [[nodiscard]] bool is_struck_on(const btRigidBody& body) const;
    [[nodiscard]] bool is_plastic(const btRigidBody& body) const;
    /// A body of a member that contacts do not push.
    [[nodiscard]] bool is_still_member(const btCollisionObject& object) const;

    /// One that is apart, or may come apart, and is not aimed at.
    struct OpenPair {
        Pair pair;
        double stiffness;  ///< of a contact that gives way [N/m]
        bool touched;      ///< it is not apart, but turns, or leaves
        double way, speed; ///< until their nearest points are closed [m], closing [m/s]
    };
    /// A contact of the two did in the last tick.
    [[nodiscard]] static bool pushes(btDiscreteDynamicsWorld& world, const Pair& pair);
    /// When, in the last part of `h` [s], the first of these closed that was passed; `h`: none was.
    [[nodiscard]] double passed(btDiscreteDynamicsWorld& world, double h, double apart);
    const std::unique_ptr<Divisibles>& members_;
    const DrivenWays& driven_;
    std::vector<const btRigidBody*> joined_;  ///< bodies of plastic joints, sorted
    std::vector<const btRigidBody*> falling_; ///< what nothing holds, and just begins to, sorted
    std::vector<int> islands_;                ///< sorted
    std::vector<Pair> pairs_;
    std::vector<OpenPair> open_;              ///< of the last `find`
    std::vector<detail::StruckPoint> struck_; ///< the same
    const LocalScope* scope_ = nullptr;
    double frame_ = 0;
    /// Some contact may give way: what meets it late, by its weight, would be pushed by all that it
    /// overlaps by then.
    mutable bool any_soft_ = false;
    std::vector<const btRigidBody*> found_bodies_;
    std::vector<btRigidBody*> foreign_;
    bool found_islands_ = false; ///< of the last `find`, which may need none
};

} // namespace ductile::bullet

#ifndef DUCTILE_COMPILED
#include "ductile/bullet/closing_contacts.ipp"
#endif
