// SPDX-License-Identifier: MIT
//
// Bodies of world_parts.hpp: blows, and what is done again with more sections open. A part of
// world_parts.ipp.
#pragma once

#include <optional>

namespace ductile::bullet {

DUCTILE_INLINE void WorldParts::do_again() {
    put_back();
    kept_ = false;
    rearrange(&meter_, [this] {
        members_->open_found();
        see_members();
        forces_.forget_gone(world_);
    });
    save();
}

/// Members are as whole as they are without it.
DUCTILE_INLINE void WorldParts::begin_blow() {
    if (members_->empty()) return;
    kept_ = false;
    close_held(Closing::before_blow);
    save();
    members_->begin_blow(closing_.found_bodies(), !thrown_.bodies().empty(), touching_);
    see_coming();
}

DUCTILE_INLINE void WorldParts::find_thrown() {
    std::vector<int> held;
    std::optional<bool> any; // both found where there is somebody to ask for
    thrown_.find(world_, [&](const btRigidBody& body) {
        if (members_->is_member(body)) return true;
        if (!any) {
            held = members_->held_islands();
            any = closing_.any_plastic(world_) || !held.empty();
        }
        if (!*any || body.isStaticOrKinematicObject()) return false;
        const int island = body.getIslandTag(); // none yet, of a body that is new
        return island < 0 || std::binary_search(held.begin(), held.end(), island) ||
               closing_.touches_plastic(world_, body);
    });
}

/// As bodies go that hang on members, were these not there.
DUCTILE_INLINE void WorldParts::see_coming() {
    const bool cut = members_->switch_holds(false);
    try {
        if (cut) tick(blow_length, false);
    } catch (...) { // a callback's
        put_back();
        throw;
    }
    members_->see_coming();
    if (cut) put_back(); // constraints are on again
}

DUCTILE_INLINE void WorldParts::close_held(Closing when) {
    rearrange(&meter_, [&] {
        const bool changed = members_->close_held(when);
        if (changed) see_bodies();
        return changed;
    });
}

/// Some came or went between two parts.
DUCTILE_INLINE void WorldParts::see_bodies() {
    see_members();
    closing_.forget_open();
    forces_.forget_gone(world_);
}

DUCTILE_INLINE const PartMotion& WorldParts::blow() try {
    closing_.show_struck(world_);
    if (members_->empty() && local_) save();
    begin_blow();
    for (tick_with_met(blow_length, false); members_->look_blow(blow_length);
         tick_with_met(blow_length, false)) {
        do_again();
    }
    thrown_.strike();
    motion_.closed = 0;
    motion_.contact_lost = false;
    return tell();
} catch (...) { // as a part's
    break_off();
    throw;
}

} // namespace ductile::bullet
