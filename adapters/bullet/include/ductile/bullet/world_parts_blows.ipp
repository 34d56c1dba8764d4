// SPDX-License-Identifier: MIT
//
// Bodies of world_parts.hpp: blows, and what is done again with more sections open. A part of
// world_parts.ipp.
#pragma once

#include "ductile/bullet/members.hpp"
#include "ductile/frame/part_settings.hpp"

namespace ductile::bullet {

DUCTILE_INLINE void WorldParts::do_again() {
    put_back();
    const double before = meter_.held().total();
    members_.open_found();
    meter_.bodies_rearranged(before);
    save();
}

/// Members are as whole as they are without it.
DUCTILE_INLINE void WorldParts::begin_blow() {
    if (members_.empty()) return;
    close_held(Closing::before_blow);
    save();
    members_.begin_blow(closing_.found_bodies(), thrown_.strike(), touching_);
    see_coming();
}

/// As bodies go that hang on members, were these not there.
DUCTILE_INLINE void WorldParts::see_coming() {
    const bool cut = members_.cut();
    try {
        if (cut) tick(blow_length, false);
    } catch (...) { // a callback's
        put_back();
        throw;
    }
    members_.see_coming();
    if (cut) put_back(); // constraints are on again
}

DUCTILE_INLINE void WorldParts::close_held(Closing when) {
    const double before = meter_.held().total();
    if (!members_.close_held(when)) return;
    meter_.bodies_rearranged(before);
    closing_.forget_open();
}

DUCTILE_INLINE const PartMotion& WorldParts::blow() {
    if (members_.empty() && local_) save();
    begin_blow();
    for (tick(blow_length, false); members_.look_blow(blow_length); tick(blow_length, false)) {
        do_again();
    }
    while (local_ && join_touched()) tick(blow_length, false);
    motion_.closed = 0;
    motion_.contact_lost = false;
    return tell();
}

} // namespace ductile::bullet
