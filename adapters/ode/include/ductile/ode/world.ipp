// SPDX-License-Identifier: MIT
//
// Bodies of world.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <utility>

#include "ductile/ode/energy_meter.hpp"
#include "ductile/ode/island_solver.hpp"
#include "ductile/ode/precision_check.hpp"
#include "ductile/ode/world.hpp"
#include "ductile/ode/world_parts.hpp"
#include "ductile/ode/world_snapshot.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile::ode {

DUCTILE_INLINE World::World(dWorldID world, WorldParameters parameters)
    : SteppedWorld(std::move(parameters.warn)),
      world_(world),
      solver_(parameters.solver),
      islands_(std::make_unique<IslandSolver>()),
      members_(std::make_unique<Divisibles>()) {
    require_matching_precision();
    if (world == nullptr) throw std::invalid_argument("World.world = null: must be a world");
    set_rest_damping(check::non_negative("World.rest_damping", parameters.rest_damping, ""));
    tells_ledger_ = parameters.ledger;
    if (parameters.ledger || parameters.tolerance != 0)
        meter_ = std::make_unique<EnergyMeter>(world_);
    if (parameters.tolerance != 0) start_frames(parameters);
}
DUCTILE_INLINE void World::start_frames(const WorldParameters& parameters) {
    const FrameParameters frames{.tolerance = parameters.tolerance, .budget = parameters.budget};
    frames.validate("World");
    start_in_frames(frames);
    parts_ = std::make_unique<WorldParts>(WorldParts::Parts{
        .world = world_,
        .bodies = bodies_,
        .joints = plastic_,
        .contacts = contacts_,
        .maker = maker_,
        .meter = *meter_,
        .keeps_ledger = tells_ledger_,
        .members = members_,
        .solve = [this](double dt) { solve(dt); },
        .step = [this](double dt) { step_engine(dt); },
        .book = [this](double dt) { book(dt); },
        .number =
            [this](const PlasticConstraint& joint) {
                int section = 0;
                const void* key = members_->key_of(joint, section);
                return supervisor().number(key != nullptr ? key : &joint);
            },
        .accept =
            [this](double h) {
                let_go_of_broken();
                tell_of_members(); // what opened did so as the part began
                part_stands(h);
            },
    });
}
DUCTILE_INLINE World::World(dWorldID world, Solver solver)
    : World(world, WorldParameters{.solver = solver, .ledger = false, .warn = nullptr}) {}

DUCTILE_INLINE World::~World() {
    parts_.reset();
    members_->leave();
    for (PlasticConstraint* joint : plastic_) joint->left_world();
}

DUCTILE_INLINE void World::add(PlasticConstraint& joint, std::string name) {
    const dBodyID body = attached_bodies(joint.id()).a;
    const bool broken = joint.queries().broken();
    if (body != nullptr ? dBodyGetWorld(body) != world_ : !broken) {
        throw std::invalid_argument("World.add.joint: must be one between bodies of this world");
    }
    const auto rules_it = [&joint](const PlasticConstraint* other) {
        return other != &joint && other->motor() == joint.motor() && other->id() == joint.id() &&
               !other->queries().broken();
    };
    if (joint.motor() >= 0 && std::any_of(plastic_.begin(), plastic_.end(), rules_it)) {
        throw std::invalid_argument(
            "World.add.joint: must be the only one of that axis of ODE's joint");
    }
    supervisor().add(&joint, std::move(name), [&joint] { return joint.queries().report(); });
    take_in(joint);
}
DUCTILE_INLINE void World::take_in(PlasticConstraint& joint) {
    constraints_.push_back(&joint);
    plastic_.push_back(&joint);
    islands_->add(joint);
    joint.set_ahead(parts_ != nullptr);
    if (parts_ != nullptr) parts_->joints_changed();
    if (meter_) meter_->add(joint);
    keep(joint, [this, &joint] { forget(joint); });
    joint.came_into_world();
}
DUCTILE_INLINE void World::remove(PlasticConstraint& joint) {
    const bool was_here = std::find(plastic_.begin(), plastic_.end(), &joint) != plastic_.end();
    let_go(joint);
    forget(joint);
    if (was_here) joint.left_world();
}
DUCTILE_INLINE void World::forget(PlasticConstraint& joint) {
    supervisor().remove(&joint);
    std::erase(constraints_, &joint);
    std::erase(plastic_, &joint);
    islands_->remove(joint);
    if (parts_ != nullptr) parts_->joints_changed();
    if (meter_) meter_->remove(joint);
}
DUCTILE_INLINE void World::add(SteppedConstraint& constraint) {
    if (parts_ != nullptr) {
        throw std::invalid_argument(
            "World.add.constraint: must be a plastic joint in a world with a tolerance: others "
            "cannot be put back");
    }
    constraints_.push_back(&constraint);
    keep(constraint, [this, &constraint] { std::erase(constraints_, &constraint); });
}
DUCTILE_INLINE void World::remove(SteppedConstraint& constraint) {
    let_go(constraint);
    std::erase(constraints_, &constraint);
}

DUCTILE_INLINE void World::add(dBodyID body) {
    if (body == nullptr) throw std::invalid_argument("World.add.body = null: must be a body");
    if (dBodyGetWorld(body) != world_) {
        throw std::invalid_argument("World.add.body: must be a body of this world");
    }
    if (std::find(bodies_.begin(), bodies_.end(), body) != bodies_.end()) {
        throw std::invalid_argument("World.add.body: must not be in the world already");
    }
    bodies_.push_back(body);
    known_.enter(body);
    if (meter_) meter_->add(body);
    members_->body_came(body);
    if (parts_ != nullptr) parts_->came(body);
}
DUCTILE_INLINE void World::remove(dBodyID body) {
    std::erase(bodies_, body);
    number_bodies();
    if (meter_) meter_->remove(body);
    members_->body_left(body);
    forces_.forget(body);
    if (parts_ != nullptr) parts_->forget(body);
}

DUCTILE_INLINE void World::apply_force(dBodyID body, const Vector3<double>& force,
                                       const Vector3<double>& at) {
    if (body == nullptr) {
        throw std::invalid_argument("World.apply_force.body = null: must be a body");
    }
    check_placed_force(force, at);
    dBodyEnable(body);
    add_force(body, force, cross(difference(at, to_core(dBodyGetPosition(body))), force));
    if (parts_ != nullptr) parts_->place(body, force, at);
}

DUCTILE_INLINE bool World::are_joined(dBodyID a, dBodyID b) const {
    if (a == nullptr || b == nullptr) return false;
    for (int i = 0; i < dBodyGetNumJoints(a); ++i) {
        const dJointID joint = dBodyGetJoint(a, i); // none of a joint that broke
        if (dJointGetType(joint) == dJointTypeContact) continue;
        if (dJointGetBody(joint, 0) != b && dJointGetBody(joint, 1) != b) continue;
        const auto is_this = [joint](PlasticConstraint* one) {
            return one->id() == joint && one->island_rows() != nullptr;
        };
        if (std::any_of(plastic_.begin(), plastic_.end(), is_this)) return true;
    }
    return false;
}
DUCTILE_INLINE void World::add_contact(dJointID joint, const dContact& contact,
                                       bool between_joined) {
    if (parts_ != nullptr && !(maker_ && maker_->is_making())) {
        throw std::logic_error(
            "World.add_contact: in a world with a tolerance contacts are made by what on_contacts "
            "was given, as each part of a step needs its own");
    }
    try {
        require_contact(joint, contact);
        for (const int side : {0, 1}) require_known(dJointGetBody(joint, side));
    } catch (const std::invalid_argument& error) {
        if (refused_.empty()) refused_ = error.what();
        return;
    }
    const dBodyID a = dJointGetBody(joint, 0), b = dJointGetBody(joint, 1);
    if (members_->hang_together(a, b) ||
        (!between_joined && (are_joined(a, b) || members_->hold(a, b)))) {
        dJointDisable(joint);
        return;
    }
    contacts_.push_back({.joint = joint, .contact = contact});
}
DUCTILE_INLINE void World::on_contacts(const ContactParameters& parameters,
                                       std::function<void()> make) {
    if (maker_ && maker_->is_making()) {
        throw std::logic_error("World.on_contacts: must not be called while contacts are made");
    }
    if (make) {
        make = [this, makes = std::move(make)] {
            refused_.clear();
            makes();
            require_contacts();
        };
    }
    maker_.emplace(parameters, std::move(make));
}

// ---- what SteppedWorld asks of ODE

DUCTILE_INLINE void World::do_step(double dt) {
    if (maker_) {
        contacts_.clear(); // of a step that threw
        maker_->make(bodies_);
    }
    if (!members_->empty()) {
        step_with_members(dt);
        return;
    }
    if (meter_) {
        for (const NamedContact& named : contacts_) {
            meter_->add_contact(named.joint, named.contact.geom);
        }
        meter_->before_step();
    }
    solve(dt);
    book(dt);
    let_go_of_broken();
    if (meter_) meter_->after_step(dt);
    contacts_.clear();
    if (maker_) maker_->clear();
}

/// The step, again with more sections open until none that is closed is beyond its strength.
DUCTILE_INLINE void World::step_with_members(double dt) {
    forces_.hold(bodies_);
    if (snapshot_ == nullptr) snapshot_ = std::make_unique<WorldSnapshot>();
    for (;;) {
        snapshot_->take(bodies_, plastic_);
        members_->see_along(bodies_, dt);
        members_->before_solve(contacts_);
        members_->apply_forces();
        if (meter_) {
            meter_->keep();
            for (const NamedContact& named : contacts_) {
                meter_->add_contact(named.joint, named.contact.geom);
            }
            meter_->before_step();
        }
        solve(dt);
        book(dt);
        if (!members_->look(dt)) break;
        snapshot_->put_back();
        if (meter_) meter_->put_back();
        rearrange(meter_.get(), [this] { members_->open_found(false); });
        forces_.apply();
    }
    let_go_of_broken();
    if (meter_) meter_->after_step(dt);
    if (members_->any_open()) {
        const double vibration = members_->count_vibration();
        if (meter_) meter_->rings_down(vibration);
        rearrange(meter_.get(),
                  [this] { return members_->close_held(Closing::after_step, false); });
    }
    tell_of_members();
    members_->drop_forces();
    contacts_.clear();
    if (maker_) maker_->clear();
}
DUCTILE_INLINE void World::tell_of_members() {
    members_->tell([this](const void* key, int section, EventKind kind) {
        supervisor().tell_section(key, kind, section);
    });
}

DUCTILE_INLINE void World::solve(double dt) {
    if (!members_->empty()) require_slow();
    for (SteppedConstraint* constraint : constraints_) constraint->prepare(dt);
    // contacts of a member are often more than hold it, of which ODE's LCP loses some
    const bool frames = parts_ != nullptr;
    islands_->before_step(contacts_, dt, !frames,
                          frames ? members_->touched() : std::vector<dBodyID>{},
                          members_->held_by());
    for (NamedContact& named : contacts_) {
        if (named.stale && dJointIsEnabled(named.joint) != 0) maker_->renew(world_, named);
    }
    step_engine(dt);
    islands_->after_step();
    members_->after_solve();
}
DUCTILE_INLINE void World::step_engine(double dt) {
    if (solver_ == Solver::direct) {
        dWorldStep(world_, dReal(dt));
    } else {
        dWorldQuickStep(world_, dReal(dt));
    }
}
DUCTILE_INLINE void World::book(double dt) {
    for (SteppedConstraint* constraint : constraints_) constraint->commit(dt);
    share_work(std::span<PlasticConstraint* const>(plastic_), [this] { return islands(); });
    for (SteppedConstraint* constraint : constraints_) constraint->finish();
}
DUCTILE_INLINE void World::let_go_of_broken() {
    for (SteppedConstraint* constraint : constraints_) constraint->stand();
}

DUCTILE_INLINE PartEngine& World::begin_frame(double length) {
    for (SteppedConstraint* constraint : constraints_) {
        constraint->set_ahead(true);
    }
    parts_->begin(length);
    return *parts_;
}
DUCTILE_INLINE bool World::sleep_through(double length) {
    if (!parts_->sleeps()) return false;
    if (maker_) {
        contacts_.clear();
        maker_->make(bodies_);
        contacts_.clear();
        if (!parts_->sleeps()) return false; // who makes them woke a body
    }
    step_engine(length);
    if (maker_) maker_->clear();
    meter_->see_changes();
    return true;
}
DUCTILE_INLINE void World::end_frame() {
    parts_->end();
    members_->drop_forces();
    tell_of_members();
}

DUCTILE_INLINE const Ledger<double>* World::kept_ledger() const noexcept {
    return tells_ledger_ ? &meter_->ledger() : nullptr;
}

DUCTILE_INLINE bool World::has_body(const void* body) const {
    if (body == nullptr) return false;
    return std::find(bodies_.begin(), bodies_.end(), body) != bodies_.end() ||
           std::any_of(plastic_.begin(), plastic_.end(), [body](const PlasticConstraint* joint) {
               return joint->bodies().a == body || joint->bodies().b == body;
           });
}

DUCTILE_INLINE std::vector<std::size_t> World::islands() const {
    AddressMap<std::size_t> island_of; // by body
    std::vector<dBodyID> found;
    const auto find = [&](dBodyID body, std::size_t island) {
        if (!can_move(body) || island_of.find(body) != nullptr) return;
        island_of[body] = island;
        found.push_back(body);
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

#include "ductile/ode/world_checks.ipp" // IWYU pragma: keep
