// SPDX-License-Identifier: MIT
//
// Bodies of world.hpp.
#pragma once

#include <algorithm>
#include <span>
#include <stdexcept>
#include <unordered_map>

#include "ductile/ode/precision_check.hpp"
#include "ductile/ode/world.hpp"
#include "ductile/vocabulary/check.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::ode {

DUCTILE_INLINE World::World(dWorldID world, WorldParameters parameters)
    : SteppedWorld(std::move(parameters.warn)), world_(world), solver_(parameters.solver) {
    require_matching_precision();
    if (world == nullptr) throw std::invalid_argument("World.world = null: must be a world");
    set_rest_damping(check::non_negative("World.rest_damping", parameters.rest_damping, ""));
    if (parameters.ledger) meter_.emplace(world_);
}
DUCTILE_INLINE World::World(dWorldID world, Solver solver)
    : World(world, WorldParameters{.solver = solver, .ledger = false, .warn = nullptr}) {}

DUCTILE_INLINE void World::add(PlasticConstraint& joint, std::string name) {
    const dBodyID body = dJointGetBody(joint.id(), 0);
    if (body != nullptr && dBodyGetWorld(body) != world_) {
        throw std::invalid_argument("World.add.joint: must be one between bodies of this world");
    }
    supervisor().add(&joint, std::move(name), [&joint] { return joint.queries().report(); });
    constraints_.push_back(&joint);
    plastic_.push_back(&joint);
    islands_.add(joint);
    if (meter_) meter_->add(joint);
    keep(joint, [this, &joint] { forget(joint); });
    joint.came_into_world();
}
DUCTILE_INLINE void World::remove(PlasticConstraint& joint) {
    let_go(joint);
    forget(joint);
}
DUCTILE_INLINE void World::forget(PlasticConstraint& joint) {
    supervisor().remove(&joint);
    std::erase(constraints_, &joint);
    std::erase(plastic_, &joint);
    islands_.remove(joint);
    if (meter_) meter_->remove(joint);
}
DUCTILE_INLINE void World::add(SteppedConstraint& constraint) {
    constraints_.push_back(&constraint);
    keep(constraint, [this, &constraint] { std::erase(constraints_, &constraint); });
}
DUCTILE_INLINE void World::remove(SteppedConstraint& constraint) {
    let_go(constraint);
    std::erase(constraints_, &constraint);
}

DUCTILE_INLINE void World::add(dBodyID body) {
    if (body == nullptr) throw std::invalid_argument("World.add.body = null: must be a body");
    if (std::find(bodies_.begin(), bodies_.end(), body) != bodies_.end()) {
        throw std::invalid_argument("World.add.body: must not be in the world already");
    }
    bodies_.push_back(body);
    if (meter_) meter_->add(body);
}
DUCTILE_INLINE void World::remove(dBodyID body) {
    std::erase(bodies_, body);
    if (meter_) meter_->remove(body);
}

// ---- what SteppedWorld asks of ODE

DUCTILE_INLINE void World::require_possible(double) {
    for (const SteppedConstraint* constraint : constraints_) constraint->check();
}
DUCTILE_INLINE void World::do_step(double dt) {
    if (meter_) {
        for (const auto& [joint, contact] : contacts_) meter_->add_contact(joint, contact.geom);
        meter_->before_step();
    }
    for (SteppedConstraint* constraint : constraints_) constraint->prepare(dt);
    islands_.before_step(contacts_, dt);
    if (solver_ == Solver::direct) {
        dWorldStep(world_, dReal(dt));
    } else {
        dWorldQuickStep(world_, dReal(dt));
    }
    islands_.after_step();
    for (SteppedConstraint* constraint : constraints_) constraint->commit(dt);
    share_work(std::span<PlasticConstraint* const>(plastic_), [this] { return islands(); });
    for (SteppedConstraint* constraint : constraints_) constraint->finish();
    if (meter_) meter_->after_step(dt);
    contacts_.clear();
}

DUCTILE_INLINE bool World::has_body(const void* body) const {
    if (body == nullptr) return false;
    return std::find(bodies_.begin(), bodies_.end(), body) != bodies_.end() ||
           std::any_of(plastic_.begin(), plastic_.end(), [body](const PlasticConstraint* joint) {
               return joint->bodies().a == body || joint->bodies().b == body;
           });
}

DUCTILE_INLINE std::vector<std::size_t> World::islands() const {
    std::unordered_map<dBodyID, std::size_t> island_of;
    std::vector<dBodyID> found;
    const auto find = [&](dBodyID body, std::size_t island) {
        if (can_move(body) && island_of.emplace(body, island).second) found.push_back(body);
    };
    std::vector<std::size_t> result;
    for (const PlasticConstraint* joint : plastic_) {
        const AttachedBodies pair = joint->bodies();
        const dBodyID body = can_move(pair.a) ? pair.a : pair.b;
        find(body, result.size());
        while (!found.empty()) {
            const dBodyID next = found.back();
            found.pop_back();
            for (int i = 0; i < dBodyGetNumJoints(next); ++i) {
                const dJointID other = dBodyGetJoint(next, i);
                for (const int side : {0, 1}) find(dJointGetBody(other, side), island_of[next]);
            }
        }
        result.push_back(can_move(body) ? island_of[body] : result.size());
    }
    return result;
}

} // namespace ductile::ode
