// SPDX-License-Identifier: MIT
//
// What of a world is divisible, as its ticks see it (member/divisibles.hpp). Here nothing is.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "ductile/member/divisibles.hpp"

class btCollisionObject;
class btRigidBody;

namespace ductile::bullet {

class LocalScope;
class PlasticConstraint;

/// Not thread-safe.
class Divisibles : public ductile::Divisibles<PlasticConstraint> {
  public:
    /// Whose reports may change without being touched, or not any more, since the last call.
    using TellIdle = std::function<void(const void* key, bool idle)>;

    /// How the forces of joints act in the coming ticks.
    void set_ahead(bool ahead) noexcept { ahead_ = ahead; }
    [[nodiscard]] bool is_ahead() const noexcept { return ahead_; }
    /// @throws std::invalid_argument where others' constraints hold bodies of theirs.
    virtual void require_known() const {}
    /// Before a step or a frame, with driven bodies where the user put them.
    virtual void list_driven() {}
    /// From now on contacts of these alone are looked at; null: of all again.
    void set_scope(const LocalScope* scope) noexcept { scope_ = scope; }
    [[nodiscard]] virtual bool is_member(const btCollisionObject& /*object*/) const {
        return false;
    }
    /// Islands of what constraints hold to members, as the last tick had them, sorted; -1: of none.
    [[nodiscard]] virtual std::vector<int> held_islands() const { return {}; }

    virtual void before_solve() {}
    /// Members among bodies that close, or that these touch, are solved at once; those that
    /// constraints hold, too, where something was `thrown`. `noticed`: as Divisible's.
    virtual void begin_blow(std::span<const btRigidBody* const> /*closing*/, bool /*thrown*/,
                            double /*noticed*/) {}
    virtual void open_found() {}
    [[nodiscard]] virtual bool close_held(Closing /*when*/) { return false; }
    virtual void tell_idle(const TellIdle& /*tell*/) {}

  protected:
    const LocalScope* scope_ = nullptr;
    bool ahead_ = false; ///< bodies are half a step ahead where rows are solved
};

} // namespace ductile::bullet
