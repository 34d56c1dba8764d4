// SPDX-License-Identifier: MIT
//
// What of a world is divisible (divisible.hpp), as its steps see it. Here nothing is: Members
// (members.hpp) take this one's place where a member or a structure is added, and a program that
// adds none does not compile them.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "ductile/member/closing.hpp"
#include "ductile/world/joint_event.hpp"

class btCollisionObject;
class btRigidBody;

namespace ductile::bullet {

class LocalScope;
class PlasticConstraint;

/// Not thread-safe.
class Divisibles {
  public:
    /// A section opened or closed: whose reports tell of it, which, what happened.
    using Tell = std::function<void(const void* key, int section, EventKind kind)>;
    /// Whose reports may change without being touched, or not any more, since the last call.
    using TellIdle = std::function<void(const void* key, bool idle)>;

    Divisibles() = default;
    Divisibles(const Divisibles&) = delete;
    Divisibles& operator=(const Divisibles&) = delete;
    virtual ~Divisibles() = default;

    [[nodiscard]] virtual bool empty() const noexcept { return true; }
    /// How the forces of joints act in the coming ticks.
    void set_ahead(bool ahead) noexcept { ahead_ = ahead; }
    [[nodiscard]] bool is_ahead() const noexcept { return ahead_; }
    /// @throws std::invalid_argument where others' constraints hold bodies of theirs.
    virtual void require_known() const {}
    /// Under which a joint is reported, and of which section it is; null: no member's.
    [[nodiscard]] virtual const void* key_of(const PlasticConstraint& /*joint*/,
                                             int& /*section*/) const {
        return nullptr;
    }
    [[nodiscard]] virtual bool any_open() const { return false; }
    /// From now on contacts of these alone are looked at; null: of all again.
    void set_scope(const LocalScope* scope) noexcept { scope_ = scope; }
    /// Of sections that are closed [J].
    [[nodiscard]] virtual double closed_work() const { return 0; }
    /// As PartMotion::closed_work.
    [[nodiscard]] virtual double unmissed_work() const { return 0; }
    [[nodiscard]] virtual bool is_member(const btCollisionObject& /*object*/) const {
        return false;
    }
    /// Islands of what constraints hold to members, as the last tick had them, sorted; -1: of none.
    [[nodiscard]] virtual std::vector<int> held_islands() const { return {}; }

    /// Forces that were applied to members act in the coming tick, too.
    virtual void apply_forces() {}
    /// They do not any more.
    virtual void drop_forces() {}

    virtual void before_solve() {}
    [[nodiscard]] virtual bool look(double /*dt*/) { return false; }
    /// Members among bodies that close, or that these touch, are solved at once; those that
    /// constraints hold, too, where something was `thrown`. `noticed`: as Divisible's.
    virtual void begin_blow(std::span<const btRigidBody* const> /*closing*/, bool /*thrown*/,
                            double /*noticed*/) {}
    /// As Divisible's.
    [[nodiscard]] virtual bool switch_holds_off() { return false; }
    virtual void see_coming() {}
    [[nodiscard]] virtual bool look_blow(double /*dt*/) { return false; }
    virtual void open_found() {}
    [[nodiscard]] virtual bool close_held(Closing /*when*/) { return false; }
    /// What the tick that stands left in vibration of members that blows opened [J].
    [[nodiscard]] virtual double count_vibration() { return 0; }
    /// What opened and closed since the last call.
    virtual void tell(const Tell& /*tell*/) {}
    virtual void tell_idle(const TellIdle& /*tell*/) {}

  protected:
    const LocalScope* scope_ = nullptr;
    bool ahead_ = false; ///< bodies are half a step ahead where rows are solved
};

} // namespace ductile::bullet
