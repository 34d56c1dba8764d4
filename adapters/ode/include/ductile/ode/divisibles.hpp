// SPDX-License-Identifier: MIT
//
// What of a World is divisible (divisible.hpp), as its steps see it. Here nothing is: Members
// (members.hpp) take this one's place where a member or a structure is added, and a program that
// adds none does not compile them.
#pragma once

#include <ode/ode.h>

#include <functional>
#include <span>
#include <vector>

#include "ductile/member/closing.hpp"
#include "ductile/world/joint_event.hpp"

namespace ductile::ode {

class PlasticConstraint;
struct NamedContact;

/// Not thread-safe.
class Divisibles {
  public:
    /// A section opened or closed: whose reports tell of it, which, what happened.
    using Tell = std::function<void(const void* key, int section, EventKind kind)>;

    Divisibles() = default;
    Divisibles(const Divisibles&) = delete;
    Divisibles& operator=(const Divisibles&) = delete;
    virtual ~Divisibles() = default;

    [[nodiscard]] virtual bool empty() const noexcept { return true; }
    /// Bodies of one are others than they were, and not by a step.
    virtual void rearranged() {}
    /// All of them leave.
    virtual void leave() {}
    /// All bodies that they are now.
    [[nodiscard]] virtual std::span<const dBodyID> bodies() const noexcept { return {}; }
    virtual void body_left(dBodyID /*body*/) {}
    virtual void body_came(dBodyID /*body*/) {}
    /// Under which a joint is reported, and of which section it is; null: no member's.
    [[nodiscard]] virtual const void* key_of(const PlasticConstraint& /*joint*/,
                                             int& /*section*/) const {
        return nullptr;
    }
    /// Contacts between two bodies are not to be, as they are one member's.
    [[nodiscard]] virtual bool hang_together(dBodyID /*a*/, dBodyID /*b*/) const { return false; }
    /// Whether a joint of the user's holds one of them to a member that the other is of.
    [[nodiscard]] virtual bool hold(dBodyID /*a*/, dBodyID /*b*/) const { return false; }
    /// Of sections that are closed [J]; as PartMotion::closed_work.
    [[nodiscard]] virtual double closed_work() const { return 0; }
    [[nodiscard]] virtual double unmissed_work() const { return 0; }
    /// @throws what a member does.
    virtual void require_possible() const {}

    virtual void apply_forces() const {}
    virtual void drop_forces() const {}
    /// @throws std::logic_error where a contact of a member is none of these.
    virtual void before_solve(std::span<const NamedContact> /*contacts*/) {}
    /// Bodies that can move of contacts with members, after before_solve().
    [[nodiscard]] virtual std::vector<dBodyID> touched() const { return {}; }
    /// Joints of the user's that hold them, after before_solve().
    [[nodiscard]] virtual std::span<const dJointID> held_by() const { return {}; }
    virtual void after_solve() const {}
    [[nodiscard]] virtual bool any_open() const { return false; }
    [[nodiscard]] virtual bool look(double /*dt*/) { return false; }
    /// As Divisible's.
    virtual void begin_blow(double /*noticed*/) const {}
    [[nodiscard]] virtual bool switch_holds(bool /*on*/) const { return false; }
    virtual void see_coming() const {}
    [[nodiscard]] virtual bool look_blow(double /*dt*/) { return false; }
    /// `ahead`: how the forces of joints act from now on. Contacts go to the bodies that have the
    /// segments that they act on.
    virtual void open_found(bool /*ahead*/) {}
    virtual void close_held(Closing /*when*/, bool /*ahead*/) {}
    /// What the step that stands left in vibration of members that blows opened [J].
    [[nodiscard]] virtual double count_vibration() const { return 0; }
    /// What opened and closed since the last call.
    virtual void tell(const Tell& /*tell*/) {}
};

} // namespace ductile::ode
