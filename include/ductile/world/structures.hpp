// SPDX-License-Identifier: MIT
//
// Joints that hang together by bodies that move: a structure. One that swings or flows is kept
// awake, one that is quiet is damped until it rests (joint/swing.hpp), all of it or nothing.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <vector>

#include "ductile/joint/swing.hpp"
#include "ductile/vocabulary/address_book.hpp"

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
    void add(StructureMember& joint) {
        members_.push_back({&joint});
        changed_ = true;
    }
    /// The rest of its structure is stirred.
    void remove(const StructureMember& joint) {
        const auto is = [&joint](const Member& member) { return member.joint == &joint; };
        const auto found = std::find_if(members_.begin(), members_.end(), is);
        if (found == members_.end()) return;
        stir(found->structure);
        members_.erase(found);
        changed_ = true;
    }
    /// τ of a quiet structure, for each second that it has been [-]; 0: none.
    void set_damping(double damping) noexcept { damping_ = damping; }
    /// Before a step, and after it.
    void look() {
        find_changes();
        if (changed_) find();
        state_.assign(states_, {});
        for (const Member& member : members_) {
            if (member.acts) state_[member.structure].add(*member.joint->swing());
        }
        for (const Member& member : members_) {
            if (!member.acts) continue;
            const State& state = state_[member.structure];
            member.joint->swing()->share(state.stirs, state.flows);
            const bool calm = state.quiet && !state.stirs;
            member.joint->damp(calm ? damping_ * member.joint->swing()->calm() : 0);
            if (!state.rests) member.joint->keep_awake();
        }
    }

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

    void stir(std::size_t structure) {
        for (const Member& member : members_) {
            if (member.structure != structure || structure == none) continue;
            if (SwingState<double>* swing = member.joint->swing()) swing->stir();
        }
    }
    /// Joints that broke, fell asleep or were woken.
    void find_changes() {
        for (Member& member : members_) {
            SwingState<double>* swing = member.joint->swing();
            const bool acts = swing != nullptr && member.joint->is_awake_member();
            const bool woken = acts && member.seen;
            member.seen = true;
            if (acts == member.acts) continue;
            if (woken) swing->stir();
            if (swing == nullptr) stir(member.structure);
            member.acts = acts;
            changed_ = true;
        }
    }
    void find() {
        AddressMap<std::size_t> of_body; // its first joint
        std::vector<std::size_t> parent(members_.size());
        std::iota(parent.begin(), parent.end(), std::size_t(0));
        const auto root = [&parent](std::size_t i) {
            while (parent[i] != i) i = parent[i] = parent[parent[i]];
            return i;
        };
        for (std::size_t i = 0; i < members_.size(); ++i) {
            if (!members_[i].acts) continue;
            for (const void* body : members_[i].joint->moving_bodies()) {
                if (body == nullptr) continue;
                if (const std::size_t* first = of_body.find(body)) {
                    parent[root(i)] = root(*first);
                } else {
                    of_body[body] = i;
                }
            }
        }
        for (std::size_t i = 0; i < members_.size(); ++i) members_[i].structure = root(i);
        states_ = members_.size();
        changed_ = false;
    }

    std::vector<Member> members_;
    std::vector<State> state_; ///< by structure
    std::size_t states_ = 0;
    double damping_ = rest_damping<double>;
    bool changed_ = false;
};

} // namespace ductile
