// SPDX-License-Identifier: MIT
//
// Bodies of world.hpp.
#pragma once

#include <sstream>
#include <stdexcept>

#include "ductile/bullet/energy_meter.hpp"
#include "ductile/bullet/front_solver.hpp"
#include "ductile/bullet/precision_check.hpp"
#include "ductile/bullet/world.hpp"
#include "ductile/bullet/world_parts.hpp"
#include "ductile/bullet/world_snapshot.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile::bullet {

namespace detail {

/// As Bullet's solvers know the joint.
DUCTILE_INLINE const void* address(const PlasticConstraint& joint) {
    return static_cast<const btTypedConstraint*>(&joint);
}
DUCTILE_INLINE const void* address(const MultiBodyPlasticConstraint& joint) { return &joint; }

/// `enter()` puts the joint into Bullet's world.
template <class Joint, class Report, class Enter>
void look_after(Supervisor& supervisor, Joint& joint, std::string name, const Report& report,
                const Enter& enter) {
    supervisor.add(address(joint), std::move(name), report);
    if (joint.in_world()) return;
    try {
        enter();
    } catch (...) {
        supervisor.remove(address(joint));
        throw;
    }
}

} // namespace detail

DUCTILE_INLINE World::World(btDiscreteDynamicsWorld& world, WorldParameters parameters)
    : SteppedWorld(std::move(parameters.warn)),
      world_(world),
      members_(std::make_unique<Divisibles>()) {
    require_matching_precision();
    if (dynamic_cast<btMultiBodyDynamicsWorld*>(&world_) == nullptr) {
        front_ = std::make_unique<FrontHold>(world_);
    }
    set_rest_damping(check::non_negative("World.rest_damping", parameters.rest_damping, ""));
    tells_ledger_ = parameters.ledger;
    const double tolerance =
        parameters.tolerance.value_or(can_put_back() ? FrameParameters{}.tolerance : 0.0);
    if (parameters.ledger || tolerance != 0) meter_ = std::make_unique<EnergyMeter>(world_);
    if (tolerance == 0) return;
    start_frames(tolerance, parameters.budget);
    front_->set_springs(parameters.springs);
}

/// WorldSnapshot knows rigid bodies alone.
DUCTILE_INLINE bool World::can_put_back() const noexcept {
    return front_ != nullptr && world_.getWorldType() == BT_DISCRETE_DYNAMICS_WORLD;
}

DUCTILE_INLINE void World::start_frames(double tolerance, int budget) {
    const FrameParameters frames{.tolerance = tolerance, .budget = budget};
    frames.validate("World");
    if (!can_put_back()) {
        throw std::invalid_argument(
            "World.tolerance: must not be asked of a world of multibodies or soft bodies");
    }
    start_in_frames(frames);
    parts_ = std::make_unique<WorldParts>(
        world_, *front_, *meter_, members_,
        [this](const PlasticConstraint& joint) {
            int section = 0;
            const void* key = members_->key_of(joint, section);
            return supervisor().number(key != nullptr ? key : detail::address(joint));
        },
        [this](double h) {
            tell_of_members(); // what opened did so as the part began
            if (parts_->is_local()) {
                part_stands(h, [this](const void* joint) { return !parts_->is_outside(joint); });
            } else {
                part_stands(h);
            }
        },
        tells_ledger_);
}

DUCTILE_INLINE PartEngine& World::begin_frame(double length) {
    tell_idle(true);
    tell_ahead();
    members_->set_ahead(true);
    parts_->begin(length);
    return *parts_;
}
DUCTILE_INLINE void World::end_frame() {
    parts_->end();
    if (parts_->is_local()) { // the joints that were not done again
        part_stands(0, [this](const void* joint) { return parts_->is_outside(joint); });
    }
    members_->drop_forces();
    tell_of_members();
    tell_of_springs();
}
DUCTILE_INLINE void World::tell_of_springs() {
    if (told_of_springs_ || !front_->softened()) return;
    told_of_springs_ = true;
    const auto& [body, other, share] = *front_->softened();
    std::ostringstream line;
    line.precision(2);
    line << "ductile: a spring between body " << body << " and ";
    other < 0 ? line << "the static world" : line << "body " << other;
    line
        << " came to a plastic joint with " << 100 * share
        << " % of its stiffness, to which Bullet limits it in frames of this length; let the World "
           "solve such springs, too (springs)";
    supervisor().say(line.str());
}

DUCTILE_INLINE World::~World() {
    parts_.reset();
    if (front_ != nullptr && front_->is_alive()) front_->set_direct(nullptr);
    for (PlasticConstraint* joint : told_ahead_) joint->set_ahead(false);
}

DUCTILE_INLINE void World::add(PlasticConstraint& joint, std::string name) {
    detail::look_after(
        supervisor(), joint, std::move(name), [&joint] { return joint.queries().report(); },
        [&] { joint.add_to(world_); });
    keep(joint, [this, &joint] { forget(joint); });
    joints_.push_back(&joint);
    if (parts_ != nullptr) parts_->forget_numbers();
}
DUCTILE_INLINE void World::add(MultiBodyPlasticConstraint& joint, std::string name) {
    detail::look_after(
        supervisor(), joint, std::move(name), [&joint] { return joint.report(); },
        [&] { joint.add_to(world_of_multibodies()); });
    keep(joint, [this, &joint] { supervisor().remove(detail::address(joint)); });
}

/// One that is idle from now on still says what became of it in this step: `after` that.
DUCTILE_INLINE void World::tell_idle(bool after) {
    if (!after) {
        members_->tell_idle([this](const void* key, bool idle) {
            if (!idle) supervisor().set_idle(key, false);
            idle_.emplace_back(key, idle);
        });
        return;
    }
    tell_idle(false);
    for (const auto& [key, idle] : idle_) supervisor().set_idle(key, idle);
    idle_.clear();
}
DUCTILE_INLINE void World::tell_of_members() {
    tell_idle(false);
    members_->tell([this](const void* key, int section, EventKind kind) {
        supervisor().tell_section(key, kind, section);
    });
}

DUCTILE_INLINE void World::apply_force(btRigidBody& body, const Vector3<double>& force,
                                       const Vector3<double>& at) {
    check_placed_force(force, at);
    body.activate();
    body.applyForce(to_bullet(force), to_bullet(at) - body.getCenterOfMassPosition());
    if (parts_ != nullptr) parts_->place(body, force, at);
}

DUCTILE_INLINE void World::remove(PlasticConstraint& joint) {
    if (!supervisor().knows(detail::address(joint))) return;
    let_go(joint);
    forget(joint);
    joint.set_ahead(false);
    if (joint.in_world()) joint.remove_from(world_);
}
DUCTILE_INLINE void World::remove(MultiBodyPlasticConstraint& joint) {
    if (!supervisor().knows(detail::address(joint))) return;
    let_go(joint);
    supervisor().remove(detail::address(joint));
    if (joint.in_world()) joint.remove_from(world_of_multibodies());
}

DUCTILE_INLINE void World::forget(PlasticConstraint& joint) {
    supervisor().remove(detail::address(joint));
    if (meter_) meter_->forget(joint);
    if (parts_ != nullptr) parts_->forget_numbers();
    told_ahead_.erase(&joint);
    std::erase(joints_, &joint);
}

DUCTILE_INLINE void World::tell_ahead() {
    for (int i = 0; i < world_.getNumConstraints(); ++i) {
        PlasticConstraint* joint = as_plastic(*world_.getConstraint(i));
        if (joint == nullptr || joint->is_ahead()) continue; // in every frame the same
        joint->set_ahead(true);
        if (!told_ahead_.insert(joint).second) continue;
        if (!supervisor().knows(detail::address(*joint))) {
            keep(*joint, [this, joint] { forget(*joint); });
        }
    }
}

DUCTILE_INLINE bool World::holds_multibodies() const noexcept {
    const auto* world = dynamic_cast<const btMultiBodyDynamicsWorld*>(&world_);
    return world != nullptr && world->getNumMultibodies() > 0;
}

DUCTILE_INLINE btMultiBodyDynamicsWorld& World::world_of_multibodies() const {
    auto* world = dynamic_cast<btMultiBodyDynamicsWorld*>(&world_);
    if (world == nullptr) {
        throw std::invalid_argument(
            "World.world: must be a btMultiBodyDynamicsWorld for the joint of a multibody");
    }
    return *world;
}

// ---- what SteppedWorld asks of Bullet

DUCTILE_INLINE void World::require_possible(double dt) {
    if (!(dt > double(SIMD_EPSILON))) {
        check::fail("World.step.dt", dt, "s", "longer than Bullet's shortest step");
    }
    for (const PlasticConstraint* joint : joints_) joint->require_bodies_in_world();
    members_->require_known();
    members_->list_driven();
}
DUCTILE_INLINE void World::do_step(double dt) {
    if (!members_->empty()) {
        step_with_members(dt);
        return;
    }
    const bool keeps_ledger = meter_ && !holds_multibodies();
    if (keeps_ledger) meter_->before_step();
    world_.stepSimulation(btScalar(dt), 0);
    if (keeps_ledger) meter_->after_step(double(btScalar(dt)));
}

/// The step, again with more sections open until none that is closed is beyond its strength.
DUCTILE_INLINE void World::step_with_members(double dt) {
    members_->set_ahead(false);
    tell_idle(true);
    if (snapshot_ == nullptr) snapshot_ = std::make_unique<WorldSnapshot>();
    for (;;) {
        snapshot_->take(world_, front_->usual());
        members_->apply_forces(); // before the ledger asks for them
        if (meter_) meter_->keep();
        if (meter_) meter_->before_step();
        members_->before_solve();
        world_.stepSimulation(btScalar(dt), 0);
        if (!members_->look(double(btScalar(dt)))) break;
        snapshot_->put_back(world_, front_->usual());
        if (meter_) meter_->put_back();
        rearrange(meter_.get(), [this] { members_->open_found(); });
    }
    if (meter_) meter_->after_step(double(btScalar(dt)));
    const double vibration = members_->count_vibration();
    if (meter_) meter_->rings_down(vibration);
    rearrange(meter_.get(), [this] { return members_->close_held(Closing::after_step); });
    tell_of_members();
    members_->drop_forces();
}

DUCTILE_INLINE bool World::has_body(const void* body) const {
    const auto& objects = world_.getCollisionObjectArray();
    for (int i = 0; i < objects.size(); ++i) {
        if (objects[i] == body && !objects[i]->isStaticObject()) return true;
    }
    return false;
}
DUCTILE_INLINE const Ledger<double>* World::kept_ledger() const noexcept {
    return tells_ledger_ && !holds_multibodies() ? &meter_->ledger() : nullptr;
}

} // namespace ductile::bullet
