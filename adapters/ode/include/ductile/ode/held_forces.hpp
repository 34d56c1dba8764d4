// SPDX-License-Identifier: MIT
//
// The forces that a user applied for a step, kept so that each part of the step has them: ODE
// forgets forces at the end of each part.
#pragma once

#include <ode/ode.h>

#include <span>
#include <vector>

#include "ductile/ode/convert.hpp"
#include "ductile/vocabulary/address_book.hpp"
#include "ductile/world/placed_forces.hpp"

namespace ductile::ode {

/// Not thread-safe.
class HeldForces {
  public:
    /// False where they are others than those held.
    bool hold(std::span<const dBodyID> bodies) {
        std::swap(before_, held_);
        held_.clear();
        for (dBodyID body : bodies) {
            const Held held{body, to_core(dBodyGetForce(body)), to_core(dBodyGetTorque(body))};
            if (!is_zero(held.force) || !is_zero(held.torque)) held_.push_back(held);
        }
        number();
        placed_.begin([this](dBodyID body) { return holds(body); });
        return held_ == before_;
    }
    /// One that was applied at a place, world [N, m]: for the coming frame it goes along with that.
    void place(dBodyID body, const Vector3<double>& force, const Vector3<double>& at) {
        placed_.add(body, {to_core(dBodyGetPosition(body)), axes_of(body)}, force, at);
    }
    void apply() const {
        for (const auto& [body, force, torque] : held_) add_force(body, force, torque);
    }
    /// To these alone.
    void apply_to(std::span<const dBodyID> bodies) const {
        if (held_.empty()) return;
        for (dBodyID body : bodies) {
            const std::size_t number = numbers_.find(body);
            if (number == AddressBook::unknown) continue;
            add_force(body, held_[number].force, held_[number].torque);
        }
    }
    /// To be called before a body is destroyed.
    void forget(dBodyID body) {
        std::erase_if(held_, [body](const Held& held) { return held.body == body; });
        placed_.forget([body](dBodyID other) { return other == body; });
        number();
    }
    /// Of these, where they are now, as the places of forces went along.
    void follow(std::span<const dBodyID> bodies) const {
        if (placed_.empty()) return;
        AddressBook meant;
        for (dBodyID body : bodies) meant.enter(body);
        placed_.follow(axes_of, [&meant](dBodyID body, const Vector3<double>& torque) {
            if (meant.has(body)) add_force(body, Vector3<double>::Zero(), torque);
        });
    }
    [[nodiscard]] Vector3<double> force_on(dBodyID body) const {
        const std::size_t number = numbers_.find(body);
        return number != AddressBook::unknown ? held_[number].force : Vector3<double>(0, 0, 0);
    }

  private:
    struct Held {
        dBodyID body;
        Vector3<double> force, torque;
        bool operator==(const Held& other) const {
            return body == other.body && force == other.force && torque == other.torque;
        }
    };

    [[nodiscard]] static Matrix3<double> axes_of(dBodyID body) {
        return matrix_to_core(dBodyGetRotation(body));
    }
    [[nodiscard]] bool holds(dBodyID body) const {
        return numbers_.find(body) != AddressBook::unknown;
    }
    void number() {
        numbers_.clear();
        for (const Held& held : held_) numbers_.enter(held.body);
    }

    std::vector<Held> held_, before_;
    AddressBook numbers_; ///< of these
    PlacedForces<dBodyID> placed_;
};

} // namespace ductile::ode
