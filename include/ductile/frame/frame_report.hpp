// SPDX-License-Identifier: MIT
//
// What a frame, and a run of frames, says of itself: how many parts it took, and what its budget
// did not allow to be resolved, in numbers and by joint.
#pragma once

#include <cstddef>
#include <vector>

namespace ductile {

/// What was left unresolved.
struct Unresolved {
    double energy = 0; ///< that may be in the wrong place [J]
    double travel = 0; ///< of a joint's rows [m | rad]
    double time = 0;   ///< length of the parts in which it was [s]

    /// Negated so that what is no number is there.
    [[nodiscard]] bool any() const noexcept { return !(energy <= 0) || !(time <= 0); }
    Unresolved& operator+=(const Unresolved& other) noexcept {
        energy += other.energy;
        travel += other.travel;
        time += other.time;
        return *this;
    }
};

/// The same of one joint.
struct UnresolvedJoint {
    std::size_t joint = 0; ///< as its world counts joints
    Unresolved left;
};

/// Of one frame.
struct FrameReport {
    int parts = 0;                       ///< that stand
    int rejected = 0;                    ///< that were put back
    int blows = 0;                       ///< without length
    int jumps = 0;                       ///< parts whose error does not come from their length
    std::size_t unreliable = 0;          ///< joints whose rows were not solved, of every part
    double error = 0;                    ///< estimate, all parts that stand [J]
    Unresolved left;                     ///< travel: of all joints together
    std::vector<UnresolvedJoint> joints; ///< of which something is left, in order of number

    /// Solves: what a frame costs.
    [[nodiscard]] int solves() const noexcept { return parts + rejected + blows; }
};

/// Of all frames so far.
struct RunReport {
    std::size_t frames = 0, parts = 0, rejected = 0, blows = 0, jumps = 0, unreliable = 0;
    int worst_frame = 0;     ///< solves of the dearest frame
    double error = 0;        ///< estimate [J]
    double plastic_work = 0; ///< of all joints [J]
    double tolerance = 0;    ///< that was asked for [-]
    Unresolved left;
    std::vector<UnresolvedJoint> joints;
    /// By contacts, pair by pair, and joints of the engine's that nobody drives, beyond what they
    /// took; 0 where no ledger is kept, no number where that is none [J].
    double brought_in = 0;
    /// By plastic joints that nobody drives, beyond what they took beside their flow; 0 where no
    /// ledger is kept [J].
    double given = 0;
    double stored = 0; ///< most that elastic joints held [J]
    double least = 0;  ///< strength × travel that nobody misses, of all joints [J]
    double of_one = 0; ///< the most of that of one row [J]

    /// Whether what the parts could not resolve, and what contacts and joints brought in beside
    /// what nobody misses, is within the tolerance of the plastic work (of joints: and of what they
    /// stored), and no joint was unreliable. False too where an estimate is no number.
    [[nodiscard]] bool believed() const noexcept {
        return left.energy <= tolerance * plastic_work &&
               brought_in <= tolerance * (plastic_work + of_one) &&
               given <= tolerance * (plastic_work + stored + least) && error < unlimited &&
               unreliable == 0;
    }
    void add(const FrameReport& frame, double work);

  private:
    static constexpr double unlimited = 1e300;
};

/// Adds to the entry of a joint, which is made where there is none; keeps the order.
void add_unresolved(std::vector<UnresolvedJoint>& joints, std::size_t joint,
                    const Unresolved& left);

} // namespace ductile

#ifndef DUCTILE_COMPILED
#include "ductile/frame/frame_report.ipp"
#endif
