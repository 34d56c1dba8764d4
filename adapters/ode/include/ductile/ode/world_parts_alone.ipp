// SPDX-License-Identifier: MIT
//
// Bodies of world_parts.hpp: the islands that are done in parts alone. A part of world_parts.ipp.
#pragma once

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

#include "ductile/ode/local_scope.hpp"

namespace ductile::ode {

DUCTILE_INLINE bool WorldParts::go_local() {
    if (!std::exchange(may_be_local_, false) || !of_.maker) return false;
    if (!scope_.find(of_.world, of_.bodies, of_.joints, of_.members->bodies(), forces_, length_)) {
        return false;
    }
    metered_ = true;
    of_.meter.see_changes();
    began_.take(scope_.out(), {});
    local_ = true;
    of_.meter.set_scope(&scope_, true);
    tick_out(length_);
    of_.meter.set_scope(&scope_);
    scope_.out_went();
    (void)join_touched();
    return true;
}

DUCTILE_INLINE void WorldParts::came(dBodyID body) {
    slept_ = false;
    if (local_) scope_.take_in({&body, 1});
}

DUCTILE_INLINE void WorldParts::widen() {
    out_ = false;
    if (std::exchange(local_, false)) of_.meter.set_scope(nullptr);
}

DUCTILE_INLINE void WorldParts::tick_out(double h) {
    out_ = true;
    go_ahead(h, h / 2);
    look(&began_);
    rule_contacts(h, false);
    solve(h, false, of_.step);
    half_ahead_.move_on(h / 2);
    drop_forces();
    of_.meter.after_step(h);
    out_ = false;
    moved();
}

DUCTILE_INLINE void WorldParts::join(std::vector<dBodyID> met) {
    met = scope_.with_theirs(std::move(met));
    of_.meter.set_scope(nullptr);
    ductile::rearrange(
        &of_.meter, [&] { began_.put_back(met); }, Account::integration);
    moved();
    if (time_ > 0) { // as far as the others are
        joining_.set(of_.bodies, met);
        std::swap(scope_, joining_);
        of_.meter.set_scope(&scope_, true);
        tick_out(time_);
        of_.meter.set_scope(nullptr);
        std::swap(scope_, joining_);
    }
    scope_.take_in(met);
    of_.meter.set_scope(&scope_);
}

DUCTILE_INLINE bool WorldParts::join_touched() {
    if (touched_.empty()) return false;
    join(std::exchange(touched_, {}));
    return true;
}

/// Contacts of those that stand aside are none of this part, though the user made them.
DUCTILE_INLINE void WorldParts::leave_aside() {
    touched_.clear();
    if (!local_) return;
    std::erase_if(of_.contacts, [this](const NamedContact& named) {
        const auto [a, b, reversed] = attached_bodies(named.joint);
        const bool of_in = scope_.has(a) || scope_.has(b);
        bool of_out = false;
        for (dBodyID body : {a, b}) {
            if (body == nullptr || scope_.has(body)) continue;
            of_out = true;
            if (of_in) touched_.push_back(body);
        }
        if (out_ ? !of_in : !of_out) return false;
        dJointDisable(named.joint);
        return true;
    });
    std::sort(touched_.begin(), touched_.end(), std::less<dBodyID>());
    touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());
}

} // namespace ductile::ode
