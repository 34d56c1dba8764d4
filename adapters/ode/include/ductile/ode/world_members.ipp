// SPDX-License-Identifier: MIT
//
// Bodies of world.hpp that concern members and structures. A part of members.ipp.
#pragma once

#include <memory>

namespace ductile::ode {

DUCTILE_INLINE Members& World::members() {
    if (auto* const members = dynamic_cast<Members*>(members_.get())) return *members;
    auto made = std::make_unique<Members>();
    Members& members = *made;
    members_ = std::move(made);
    return members;
}
DUCTILE_INLINE void World::add(Divisible& member, std::string name) {
    if (solver_ == Solver::quick) {
        throw std::invalid_argument(
            "World.add.member: must not be added to a World of Solver::quick, as what its sweeps "
            "leave unsolved would yield");
    }
    member.enter(*this);
    for (dBodyID body : member.bodies()) {
        if (std::find(bodies_.begin(), bodies_.end(), body) == bodies_.end()) add(body);
    }
    members().add(member);
    for (const DivisionReport& one : member.reports(name)) {
        supervisor().add(one.key, one.name, one.ask);
    }
}
DUCTILE_INLINE void World::remove(Divisible& member) {
    auto* const members = dynamic_cast<Members*>(members_.get());
    if (members == nullptr || !members->has(member)) return;
    for (const DivisionReport& one : member.reports({})) supervisor().remove(one.key);
    rearrange(meter_.get(), [&] { member.leave(); });
    members->remove(member);
}

} // namespace ductile::ode
