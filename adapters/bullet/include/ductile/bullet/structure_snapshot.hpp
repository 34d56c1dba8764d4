// SPDX-License-Identifier: MIT
//
// A structure as it was, whole or in pieces, kept and put back:
//
//   const ductile::bullet::StructureSnapshot saved(frame);
//   ...
//   saved.put_back(frame);
//
// As many bodies as then, where they were, with the velocities that they had. With all else put
// back, too, every run from there is the same bit for bit in steps without a tolerance; contacts
// begin cold.
#pragma once

#include <vector>

#include "ductile/bullet/structure_in_time.hpp"
#include "ductile/structure/structure_save.hpp"

namespace ductile::bullet {

/// Plain value.
class StructureSnapshot {
  public:
    explicit StructureSnapshot(const StructureInTime& structure) : saved_(structure.save()) {
        for (const StructureInTime::Hold& hold : structure.holds_) holds_.push_back(hold.at);
    }
    /// Between steps. What was attached since stays so.
    /// @throws std::invalid_argument as StructureSave::require_of, and where an attachment was made
    /// anew in vain.
    void put_back(StructureInTime& structure) const {
        saved_.require_of(structure.course_);
        // before the new ones come, whose order in the world would hang on how many there are
        for (const PieceBody& piece : structure.pieces_) {
            structure.world_.engine().removeRigidBody(piece.body);
        }
        structure.put_back(saved_);
        for (std::size_t i = 0; i < holds_.size() && i < structure.holds_.size(); ++i) {
            structure.holds_[i].at = holds_[i];
        }
    }

  private:
    StructureSave saved_;
    std::vector<StructureHold> holds_;
};

} // namespace ductile::bullet
