// SPDX-License-Identifier: MIT
//
// Bodies of world_parts.hpp: the islands that are done in parts alone. A part of world_parts.ipp.
#pragma once

#include <utility>
#include <vector>

#include "ductile/ode/local_scope.hpp"

namespace ductile::ode {

DUCTILE_INLINE bool WorldParts::go_local() {
    if (!std::exchange(may_be_local_, false) || !of_.maker || !of_.members->empty()) return false;
    if (!scope_.find(of_.world, of_.bodies, of_.joints, forces_, length_)) return false;
    of_.meter.see_changes();
    began_.take(scope_.out(), {});
    local_ = true;
    of_.meter.set_scope(&scope_, true);
    tick_out(length_);
    of_.meter.set_scope(&scope_);
    scope_.out_went();
    return true;
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
    out_ = looked_ = false;
}

DUCTILE_INLINE void WorldParts::join_met(double h) {
    if (!local_) return;
    std::vector<dBodyID> met = scope_.met(forces_, h);
    if (met.empty()) return;
    of_.meter.set_scope(nullptr);
    const double before = of_.meter.held().total();
    began_.put_back(met);
    of_.meter.bodies_rearranged(before, Account::integration);
    looked_ = false;
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

} // namespace ductile::ode
