// SPDX-License-Identifier: MIT
//
// Bodies of structures.hpp.
#pragma once

#include <algorithm>
#include <numeric>

#include "ductile/vocabulary/address_book.hpp"
#include "ductile/world/structures.hpp"

namespace ductile {

DUCTILE_INLINE void Structures::add(StructureMember& joint) {
    members_.push_back({&joint});
    changed_ = true;
}
DUCTILE_INLINE void Structures::remove(const StructureMember& joint) {
    const auto is = [&joint](const Member& member) { return member.joint == &joint; };
    const auto found = std::find_if(members_.begin(), members_.end(), is);
    if (found == members_.end()) return;
    stir(found->structure);
    members_.erase(found);
    changed_ = true;
}

DUCTILE_INLINE void Structures::look() {
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
        member.joint->damp(calm ? damping_ * member.joint->swing()->quiet : 0);
        if (!state.rests) member.joint->keep_awake();
    }
}

DUCTILE_INLINE void Structures::stir(std::size_t structure) {
    for (const Member& member : members_) {
        if (member.structure != structure || structure == none) continue;
        if (SwingState<double>* swing = member.joint->swing()) swing->stir();
    }
}

DUCTILE_INLINE void Structures::find_changes() {
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

DUCTILE_INLINE void Structures::find() {
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

} // namespace ductile
