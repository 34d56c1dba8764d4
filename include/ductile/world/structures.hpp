// SPDX-License-Identifier: MIT
//
// Joints that hang together by bodies that move: a structure. One that swings or flows is kept
// awake, one that is quiet is damped until it rests (joint/swing.hpp), all of it or nothing.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "ductile/joint/swing.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile {

/// What a structure asks of a joint. Not thread-safe.
class StructureMember {
  public:
    /// Null of a joint that cannot tell, or is broken.
    [[nodiscard]] virtual SwingState<double>* swing() noexcept { return nullptr; }
    /// False while the engine leaves it out.
    [[nodiscard]] virtual bool is_awake_member() const { return false; }
    /// Addresses; null for one that does not move.
    [[nodiscard]] virtual std::array<const void*, 2> moving_bodies() const { return {}; }
    /// Least τ of its elastic axes in the steps to come [s].
    virtual void damp(double /*time*/) noexcept {}
    /// The engine is not to put its bodies to sleep yet.
    virtual void keep_awake() {}

  protected:
    StructureMember() = default;
    StructureMember(const StructureMember&) = default;
    StructureMember& operator=(const StructureMember&) = default;
    virtual ~StructureMember() = default;
};

/// Not thread-safe. O(joints) a call; structures are found anew where a joint came or went.
class Structures {
  public:
    void add(StructureMember& joint);
    /// The rest of its structure is stirred.
    void remove(const StructureMember& joint);
    /// τ of a quiet structure, for each second since something stirred [-]; 0: none.
    void set_damping(double damping) noexcept { damping_ = damping; }
    /// Before a step, and after it.
    void look();

  private:
    static constexpr std::size_t none = std::size_t(-1);
    struct Member {
        StructureMember* joint;
        std::size_t structure = none;
        bool acts = false; ///< it is awake, and holds
        bool seen = false; ///< what it remembered before is its own
    };
    struct State {
        bool stirs = false, flows = false, quiet = true, rests = true;

        void add(const SwingState<double>& swing) noexcept {
            stirs = stirs || swing.stirs();
            flows = flows || swing.flows;
            quiet = quiet && swing.is_quiet();
            rests = rests && swing.rests();
        }
    };

    void stir(std::size_t structure);
    /// Joints that broke, fell asleep or were woken.
    void find_changes();
    void find();

    std::vector<Member> members_;
    std::vector<State> state_; ///< by structure
    std::size_t states_ = 0;
    double damping_ = rest_damping<double>;
    bool changed_ = false;
};

} // namespace ductile

#ifndef DUCTILE_COMPILED
#include "ductile/world/structures.ipp"
#endif
