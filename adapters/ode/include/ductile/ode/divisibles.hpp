// SPDX-License-Identifier: MIT
//
// What of a World is divisible, as its steps see it (member/divisibles.hpp). Here nothing is.
#pragma once

#include <ode/ode.h>

#include <span>
#include <vector>

#include "ductile/member/divisibles.hpp"

namespace ductile::ode {

class PlasticConstraint;
struct NamedContact;

/// Not thread-safe.
class Divisibles : public ductile::Divisibles<PlasticConstraint> {
  public:
    /// Bodies of one are others than they were, and not by a step.
    virtual void rearranged() {}
    /// All of them leave.
    virtual void leave() {}
    /// All bodies that they are now.
    [[nodiscard]] virtual std::span<const dBodyID> bodies() const noexcept { return {}; }
    virtual void body_left(dBodyID /*body*/) {}
    virtual void body_came(dBodyID /*body*/) {}
    /// Contacts between two bodies are not to be, as they are one member's.
    [[nodiscard]] virtual bool hang_together(dBodyID /*a*/, dBodyID /*b*/) const { return false; }
    /// Whether a joint of the user's holds one of them to a member that the other is of.
    [[nodiscard]] virtual bool hold(dBodyID /*a*/, dBodyID /*b*/) const { return false; }
    /// @throws what a member does.
    virtual void require_possible() const {}

    /// Contacts as they will be within the coming part: what is driven may be past by its end.
    virtual void see_ahead(std::span<const NamedContact> /*contacts*/) {}
    /// The same of a step of `dt` [s], where contacts are made once: by the geoms of `bodies`.
    virtual void see_along(std::span<const dBodyID> /*bodies*/, double /*dt*/) {}
    /// @throws std::logic_error where a contact of a member is none of these.
    virtual void before_solve(std::span<const NamedContact> /*contacts*/) {}
    /// Bodies that can move of contacts with members, after before_solve().
    [[nodiscard]] virtual std::vector<dBodyID> touched() const { return {}; }
    /// Joints of the user's that hold them, after before_solve().
    [[nodiscard]] virtual std::span<const dJointID> held_by() const { return {}; }
    virtual void after_solve() const {}
    /// As Divisible's.
    virtual void begin_blow(double /*noticed*/) const {}
    /// `ahead`: how the forces of joints act from now on. Contacts go to the bodies that have the
    /// segments that they act on.
    virtual void open_found(bool /*ahead*/) {}
    /// False where nothing did.
    [[nodiscard]] virtual bool close_held(Closing /*when*/, bool /*ahead*/) { return false; }
};

} // namespace ductile::ode
