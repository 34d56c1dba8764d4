// SPDX-License-Identifier: MIT
//
// The members of a World: what acted on them in a step, read after it, and which of them it was
// solved for in vain.
//
//   before_solve()  the bodies are where the coming step solves them
//   after_solve()   they have their new velocities
//   look(dt)        joints have booked; true: put the step back, open_found(), do it again
//   look_blow(dt)   the same of a blow
//   close_held()    it stands: what held is one body
//
// Read is the feedback of contacts and of joints that hold on to a member, its own forces and
// gravity. Joints without feedback are lent some for the step.
//
// Not thread-safe.
#pragma once

#include <ode/ode.h>

#include <deque>
#include <functional>
#include <span>
#include <unordered_map>
#include <vector>

#include "ductile/ode/divisible.hpp"
#include "ductile/vocabulary/linkage.hpp"
#include "ductile/world/joint_event.hpp"

namespace ductile::ode {

class Members {
  public:
    /// A section opened or closed: whose reports tell of it, which, what happened.
    using Tell = std::function<void(const void* key, int section, EventKind kind)>;

    void add(Divisible& member);
    void remove(Divisible& member);
    [[nodiscard]] bool empty() const noexcept { return members_.empty(); }
    [[nodiscard]] bool has(const Divisible& member) const noexcept;
    /// Bodies of one are others than they were, and not by a step.
    void rearranged() { note_bodies(); }
    /// All of them leave.
    void leave();
    /// All bodies that they are now.
    [[nodiscard]] std::span<const dBodyID> bodies() const noexcept { return bodies_; }
    void body_left(dBodyID body);
    void body_came(dBodyID body);
    /// Under which a joint is reported, and of which section it is; null: no member's.
    [[nodiscard]] const void* key_of(const PlasticConstraint& joint, int& section) const;
    /// Contacts between two bodies are not to be, as they are one member's.
    [[nodiscard]] bool hang_together(dBodyID a, dBodyID b) const;
    /// Whether a joint of the user's holds one of them to a member that the other is of.
    [[nodiscard]] bool hold(dBodyID a, dBodyID b) const;
    /// Of sections that are closed [J]; as PartMotion::closed_work.
    [[nodiscard]] double closed_work() const;
    [[nodiscard]] double unmissed_work() const;
    /// @throws what a member does.
    void require_possible() const;

    void apply_forces() const;
    void drop_forces() const;
    /// @throws std::logic_error where a contact of a member is none of these.
    void before_solve(std::span<const NamedContact> contacts);
    /// Bodies that can move of contacts with members, after before_solve().
    [[nodiscard]] std::vector<dBodyID> touched() const;
    void after_solve() const;
    [[nodiscard]] bool any_open() const;
    [[nodiscard]] bool look(double dt) { return look(dt, false); }
    /// As Divisible's.
    void begin_blow(double noticed) const;
    [[nodiscard]] bool switch_holds(bool on) const;
    void see_coming() const;
    [[nodiscard]] bool look_blow(double dt) { return look(dt, true); }
    /// `ahead`: how the forces of joints act from now on. Contacts go to the bodies that have the
    /// segments that they act on.
    void open_found(bool ahead);
    void close_held(Closing when, bool ahead);
    /// What the step that stands left in vibration of members that blows opened [J].
    [[nodiscard]] double count_vibration() const;
    /// What opened and closed since the last call.
    void tell(const Tell& tell);

  private:
    struct Course {
        Divisible* of;
        std::vector<dBodyID> bodies{};
        std::vector<Touch> touches{};
        std::vector<int> found{};
    };
    struct Happened {
        const Divisible* of;
        int section;
        EventKind kind;
    };

    void note_bodies();
    [[nodiscard]] bool look(double dt, bool blow);
    void list_contacts(std::span<const NamedContact> contacts);
    static void require_named(const Course& course);
    [[nodiscard]] const dJointFeedback* feedback_of(dJointID joint);
    void take_feedback_back();

    std::vector<Course> members_;
    std::vector<dBodyID> bodies_;
    std::unordered_map<dBodyID, std::size_t> owners_;
    std::vector<Happened> happened_;
    std::deque<dJointFeedback> lent_;
    std::vector<dJointID> borrowers_, held_by_;
};

} // namespace ductile::ode

#ifndef DUCTILE_COMPILED
#include "ductile/ode/members.ipp"
#endif
