// SPDX-License-Identifier: MIT
//
// A structure as it was, whole or in pieces, kept and put back:
//
//   const ductile::ode::StructureSnapshot saved(frame);
//   ...
//   saved.put_back(frame);
//
// As many bodies as then, where they were, with the velocities that they had; joints of the user's
// hold where they held. With all else put back, too, every run from there is the same bit for bit
// in steps without a tolerance.
#pragma once

#include <ode/ode.h>

#include <utility>
#include <vector>

#include "ductile/ode/structure_in_time.hpp"
#include "ductile/ode/world_snapshot.hpp"
#include "ductile/structure/structure_save.hpp"

namespace ductile::ode {

/// Plain value.
class StructureSnapshot {
  public:
    /// Looks first for joints of the user's that came since the last step.
    /// @throws std::invalid_argument as the next step would, of a joint that it cannot keep.
    explicit StructureSnapshot(StructureInTime& structure)
        : saved_(structure.save()), pressed_(structure.pressed_) {
        structure.find_holds();
        for (dBodyID body : structure.pieces_) bodies_.emplace_back(body);
        for (const StructureInTime::Hold& hold : structure.holds_) {
            holds_.emplace_back(SavedHold(hold), hold.at);
        }
    }
    /// Between steps. Joints of the user's that there are no more are left out; what holds a joint
    /// at its other end need not be put back before.
    /// @throws std::invalid_argument as StructureSave::require_of.
    void put_back(StructureInTime& structure) const {
        structure.put_back(saved_);
        for (std::size_t c = 0; c < bodies_.size(); ++c) {
            bodies_[c].put_back(structure.pieces_[c]);
        }
        for (const auto& [hold, at] : holds_) {
            for (StructureInTime::Hold& now : structure.holds_) {
                if (hold.put_back(now)) now.at = at;
            }
        }
        structure.pressed_ = pressed_;
        structure.pressed_.go_to(structure.pieces_.front()); // the one that is held
    }

  private:
    StructureSave saved_;
    PressedTouches pressed_;
    std::vector<BodySnapshot> bodies_; ///< by cluster
    std::vector<std::pair<SavedHold, StructureHold>> holds_;
};

} // namespace ductile::ode
