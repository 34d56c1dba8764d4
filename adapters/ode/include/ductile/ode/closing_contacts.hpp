// SPDX-License-Identifier: MIT
//
// Which contacts on islands with plastic joints close, from those that the user's collisions make
// (contact_maker.hpp). ODE tells of a contact only once shapes overlap, so closed is one that
// overlaps by a hair: a hundredth of the height from which it would fall to its speed, 0.1 um to
// `closed_depth`. Nothing is pushed out up to that. Below half of it a contact sinks to there at a
// fiftieth of the speed of what turns it, so that it stays known where a turn takes some of that
// away. One that is about to close is known as well. With d the overlap beyond the hair, less than
// 0 where it is a gap,
//
//   a contact that is closed and goes on at v strikes, with the energy v²/(2 K),
//     K = 1/effective mass of the point, both bodies free; not one that gives way
//     (frame/soft_contact.hpp)
//   a gap that is known closes in  -d/v
//   one that was not closed at  t - 2 d/(v + √(v² - 2 a d)),  where the bodies overlap at t
//
// Looked at are the middle of a part of h, where v is that before it and a = 0, and its end, where
// v is that after it and a = (v - v before)/h; what was closed before the start is not new. One
// that overlaps and does not close there went another way: past an edge, which it struck. Before a
// part in which bodies pass each other by more than half of the thinner of their geoms they are
// moved along, as they would go without any force, and looked at after every such length.
//
// A stop of a joint of ODE's (joint_stops.hpp) is a gap that is always known, and a blow when it
// closes.
//
// ODE pushes out what overlaps, which costs F d where the contact pushes with F: a gap counts where
// that or its v²/(2 K) does. Left out, two balls on a post at 5 m/s absorb 1.4 % more at frames of
// 1/30 s than at 1 ms (tests/adapters/ode_frames_test.cpp).
//
// An island is what hangs together with a plastic joint by joints and contacts, as they are.
//
// Not thread-safe.
#pragma once

#include <ode/ode.h>

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "ductile/frame/part_engine.hpp"
#include "ductile/frame/soft_contact.hpp"
#include "ductile/ode/contact_maker.hpp"
#include "ductile/ode/contact_rows.hpp"
#include "ductile/ode/local_scope.hpp"
#include "ductile/ode/plastic_constraint.hpp"
#include "ductile/ode/world_snapshot.hpp"
#include "ductile/vocabulary/address_book.hpp"
#include "ductile/vocabulary/linkage.hpp"
#include "ductile/world/turned_contact.hpp"

namespace ductile::ode {

/// Overlap up to which nothing is pushed out, and at which what closes fast is closed [m].
inline constexpr double closed_depth = 1e-4;

/// How a contact closes.
struct ContactClosing {
    AttachedBodies bodies;
    SeenContact seen; ///< its normal on the first of its bodies
    double speed;     ///< v, along the normal [m/s]
    double comes;     ///< whichever way, [m/s]
    double sinks;     ///< as fast as it may sink, to stay known as it turns [m/s]

    explicit ContactClosing(const NamedContact& named);
    /// Of bodies that move so [m/s].
    [[nodiscard]] double speed_of(const ContactBody& a, const ContactBody& b) const {
        return dot(seen.normal, difference(b.at(seen.arm_b), a.at(seen.arm_a)));
    }
    /// K [1/kg]
    [[nodiscard]] double yields() const;
    /// Overlap at which it is closed [m].
    [[nodiscard]] double depth() const;
    /// It comes nearer, and not as what is closed may.
    [[nodiscard]] bool closes() const {
        return speed > 2 * sinks && (can_move(bodies.a) || can_move(bodies.b));
    }
    /// It leaves at least as fast as it would rebound, so that it is open although it overlaps:
    /// where another blow sends it back it is struck anew.
    [[nodiscard]] bool rebounds(const NamedContact& named) const;
    /// What it gives way by in frames of `frame` [s]; nothing: it is hard. Where it bounces and
    /// the spring pushes less, a damper alone does, 1 + e times as much.
    [[nodiscard]] std::optional<SoftContact> softness(const NamedContact& named,
                                                      double frame) const;
};

class ClosingContactsFinder {
  public:
    /// The contacts of the bodies as they are, of islands of these joints and of bodies of
    /// `members`, which are struck like them, in a frame of `frame` [s]. `still`: none closes so
    /// that it counts.
    /// @throws std::logic_error where one has a contact that was not named.
    void look(std::span<const NamedContact> contacts, std::span<PlasticConstraint* const> joints,
              std::span<const dBodyID> members, double frame, bool still);
    /// Which bodies have contacts now, so that others are new.
    void remember() { before_ = pairs_; }
    /// Before the solve of a part: as fast as the bodies come to it.
    void see_motions(std::span<const dBodyID> bodies);
    /// After the solve: how hard the contacts of the part push, by their joints' feedback.
    void see_forces(std::span<const NamedContact> contacts);
    /// As PartEngine's.
    void save() {
        kept_force_ = force_;
        kept_pushing_ = pushing_;
    }
    void put_back() {
        force_ = kept_force_;
        pushing_ = kept_pushing_;
    }
    /// To be called before a body is destroyed: another one may lie where it lay.
    void forget(dBodyID body);
    /// Whether bodies that pushed each other, in the last part or when it began, have no contact
    /// among those looked at: one slid off the other, or was pushed off.
    [[nodiscard]] bool lost();
    /// The farthest that a body turned in a part of `h` [s] that something pushed in it [rad].
    [[nodiscard]] double turn(double h) const;
    /// Whether a contact of `energy` [J] that overlaps by `overlap` [m] beyond where it closed
    /// does, where `apart` [J] is the least.
    [[nodiscard]] bool counts(double energy, double overlap, double apart) const noexcept {
        constexpr double pushed_out = 0.1; // of `apart`: each one adds to the next
        return energy > apart || force_ * overlap > pushed_out * apart;
    }
    /// Among those looked at.
    [[nodiscard]] bool strikes(double touching) const;
    /// When the first gap among those looked at closes with more energy than `apart` [J], or what
    /// is closed and gives way is half through [s].
    [[nodiscard]] double next_gap(double apart) const;
    /// When the first gap closed, of those that close with more energy than `apart` [J], in a time
    /// that began `past` [s] ago; infinite: none did. `hurried` [s]: in which the bodies came to
    /// their velocities from those before the solve; 0: they had them all the time.
    [[nodiscard]] double closed(double past, double hurried, double apart) const;
    /// Whether a body is in one of these islands.
    [[nodiscard]] bool is_plastic(dBodyID body) const { return numbers_.has(body); }
    [[nodiscard]] bool any_plastic() const noexcept { return !island_.empty(); }
    /// Whether joints of ODE's on these islands have stops.
    [[nodiscard]] bool any_stops() const noexcept { return any_stops_; }

    /// Into how many lengths `h` [s] has to be divided so that nothing passes an island unseen, not
    /// rounded; >= 1. Where there is a `scope`, all others are out of the way.
    [[nodiscard]] double lengths(const ContactMaker& maker, std::span<const dBodyID> bodies,
                                 const LocalScope* scope, double h) const;

  private:
    /// A point that touches.
    struct Touch {
        double gap;    ///< until it is closed, < 0 beyond that [m]
        double depth;  ///< at which it is closed [m]
        double speed;  ///< v [m/s]
        double before; ///< v before the solve [m/s]
        double energy; ///< v²/(2 K), whichever way where it does not close [J]
        bool is_new;   ///< the bodies had no contact when last remembered
        bool closes;   ///< else it leaves already, and closed since
        bool is_hard;
        double thin; ///< of the thinner of the two geoms [m]

        [[nodiscard]] bool strikes(double touching) const {
            return closes && is_hard && gap < depth / 2 && energy > touching;
        }
    };
    using Pair = std::pair<dBodyID, dBodyID>;
    /// Who touches whom: bodies and geoms, which are null where `make` collides without any.
    using Mates = std::pair<Pair, std::pair<dGeomID, dGeomID>>;
    [[nodiscard]] static Mates mates(const NamedContact& named);
    using Push = std::pair<Mates, double>; ///< with its force [N]
    void find_islands(std::span<const NamedContact> contacts,
                      std::span<PlasticConstraint* const> joints, std::span<const dBodyID> members);

    void look_at_stops();
    [[nodiscard]] ContactBody motion_before(dBodyID body) const;

    AddressMap<ContactBody> motions_;   ///< before the solve
    std::vector<dBodyID> island_;       ///< bodies that can move, or a member's, of all
    AddressBook numbers_;               ///< of these
    std::vector<Touch> touches_;        ///< that close, or did
    std::vector<Pair> pairs_, before_;  ///< of bodies with contacts, sorted
    std::vector<Mates> touching_;       ///< looked at, sorted
    std::vector<Push> pushing_, began_; ///< in the last part, and when it began
    std::vector<Push> kept_pushing_;
    bool any_stops_ = false;
    double force_ = 0, kept_force_ = 0; ///< F: largest of a contact in the last part with one [N]
};

} // namespace ductile::ode

#ifndef DUCTILE_COMPILED
#include "ductile/ode/closing_contacts.ipp"
#endif
