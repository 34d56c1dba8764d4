// SPDX-License-Identifier: MIT
//
// Bodies of world_parts.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "ductile/bullet/convert.hpp"
#include "ductile/bullet/divisibles.hpp"
#include "ductile/bullet/front_solver.hpp"
#include "ductile/bullet/moving_bodies.hpp"
#include "ductile/bullet/world_parts.hpp"
#include "ductile/bullet/world_parts_joints.ipp" // IWYU pragma: keep
#include "ductile/frame/part_settings.hpp"

namespace ductile::bullet {

namespace detail {

/// A tick as stepSimulation does it, but for kinematic bodies, whose velocities are known, and
/// motion states. Bullet's own is not public.
struct SingleTick : btDiscreteDynamicsWorld {
    static void go(btDiscreteDynamicsWorld& world, btScalar h) {
        world.applyGravity();
        (world.*(&SingleTick::internalSingleStepSimulation))(h);
        world.clearForces();
    }
    /// Whether anybody is called in every tick, beside `actions`.
    [[nodiscard]] static bool calls_others(const btDiscreteDynamicsWorld& world, int actions) {
        return world.*(&SingleTick::m_internalTickCallback) != nullptr ||
               world.*(&SingleTick::m_internalPreTickCallback) != nullptr ||
               (world.*(&SingleTick::m_actions)).size() != actions;
    }
};

/// Of what moves in `h` [s] and was put elsewhere since the last tick: the look for gaps, before
/// the first one, asks the broadphase, which is told of it by a tick alone.
DUCTILE_INLINE void tell_broadphase(btDiscreteDynamicsWorld& world, btScalar h) {
    constexpr btScalar noticed = btScalar(1e-3); // [m | rad]
    for (btRigidBody* body : MovingBodies::all(world)) {
        const btBroadphaseProxy* proxy = body->getBroadphaseHandle();
        const bool goes = body->getLinearVelocity().length2() * h * h > noticed * noticed ||
                          body->getAngularVelocity().length2() * h * h > noticed * noticed;
        if (proxy == nullptr || !goes || !body->isActive() || body->isStaticOrKinematicObject()) {
            continue;
        }
        btVector3 low, high;
        body->getAabb(low, high);
        low += btVector3(noticed, noticed, noticed);
        high -= btVector3(noticed, noticed, noticed);
        bool known = true;
        for (int k = 0; k < 3; ++k) {
            known = known && proxy->m_aabbMin[k] <= low[k] && proxy->m_aabbMax[k] >= high[k];
        }
        if (!known) world.updateSingleAabb(body);
    }
}

/// Rows of a joint, of what hangs together as the last tick of all had it.
DUCTILE_INLINE void tell_island(const PlasticConstraint& joint, std::span<PartRow> rows) {
    const btRigidBody& a = joint.getRigidBodyA();
    const btRigidBody& body = a.isStaticOrKinematicObject() ? joint.getRigidBodyB() : a;
    for (PartRow& row : rows) row.island = body.getIslandTag();
    if (!rows.empty()) rows.front().work = joint.queries().absorbed_energy();
}

} // namespace detail

/// The solver's settings of a part or a blow of `h` in a frame of `frame` [s].
DUCTILE_INLINE void WorldParts::rule(btContactSolverInfo& info, btScalar h, double frame, bool blow,
                                     Lent<btScalar>& lent, Lent<int>& modes) {
    const auto part = double(h);
    constexpr btScalar bounces = btScalar(1e-20); // at 0 stops of Bullet's do not
    lent.put(info.m_erp, blow ? bounces : btScalar(part_erp(double(info.m_erp), part)));
    lent.put(info.m_erp2,
             blow ? btScalar(0) : btScalar(overlap_erp(double(info.m_erp2), part, frame)));
    if (!blow) return;
    modes.put(info.m_splitImpulse, 0);
    lent.put(info.m_globalCfm, info.m_globalCfm * btScalar(blow_compliance(part)));
}

DUCTILE_INLINE WorldParts::WorldParts(btDiscreteDynamicsWorld& world, FrontHold& front,
                                      EnergyMeter& meter,
                                      const std::unique_ptr<Divisibles>& members, Number number,
                                      Accept accept, bool keeps_ledger)
    : world_(world),
      front_(front),
      meter_(meter),
      members_(members),
      number_(std::move(number)),
      accept_(std::move(accept)),
      half_ahead_(world),
      islands_(MeetingIslands::enter(world)),
      closing_(members, ways_),
      keeps_ledger_(keeps_ledger),
      pairs_were_sorted_(world.getDispatchInfo().m_deterministicOverlappingPairs) {
    world_.getDispatchInfo().m_deterministicOverlappingPairs = true;
}

DUCTILE_INLINE WorldParts::~WorldParts() {
    if (!front_.is_alive()) return;
    half_ahead_.leave();
    if (islands_ != nullptr) islands_->leave(world_);
    world_.getDispatchInfo().m_deterministicOverlappingPairs = pairs_were_sorted_;
}

DUCTILE_INLINE void WorldParts::begin(double length) {
    widen(); // a frame that threw did not end
    same_forces_ = forces_.hold(world_);
    forces_act_ = true;
    ways_.begin(world_, btScalar(length));
    detail::tell_broadphase(world_, btScalar(length));
    time_ = 0;
    length_ = length;
    closing_.set_frame(length);
    meter_.set_owners([this](const void* body) { return members_->owner_of(body); });
    looked_ = decided_ = local_ = closes_ = at_risk_ = false;
    for (int i = 0; i < world_.getNumConstraints(); ++i) {
        PlasticConstraint* plastic = as_plastic(*world_.getConstraint(i));
        if (plastic == nullptr) continue;
        if (!plastic->in_world()) {
            throw std::logic_error(
                "World.step: a plastic joint must be put into a world with a tolerance by "
                "World::add or its own add_to, as Bullet's addConstraint does not say when a part "
                "ends");
        }
        plastic->begin_part();
    }
    find_thrown();
}

DUCTILE_INLINE void WorldParts::end() {
    world_.synchronizeMotionStates();
    widen();
    thrown_.leave(world_);
}

DUCTILE_INLINE void WorldParts::widen() {
    if (!std::exchange(narrow_, false)) return;
    meter_.set_scope(nullptr);
    meter_.narrow(true);
    closing_.set_scope(nullptr);
    members_->set_scope(nullptr);
}

DUCTILE_INLINE void WorldParts::find_risk() {
    suspects_.clear();
    int actions = 1; // half_ahead_'s, and one of each joint
    bool all = !same_forces_ || !members_->empty() || !ways_.empty();
    for (int i = 0; i < world_.getNumConstraints(); ++i) {
        btTypedConstraint& constraint = *world_.getConstraint(i);
        const btRigidBody &a = constraint.getRigidBodyA(), &b = constraint.getRigidBodyB();
        if (const PlasticConstraint* plastic = as_plastic(constraint)) {
            ++actions;
            if (!risk_.is_at_risk(i, *plastic, btScalar(length_))) continue;
        } else if (!constraint.isEnabled() ||
                   !(closing_.touches_plastic(world_, a) || closing_.touches_plastic(world_, b))) {
            continue;
        }
        for (const btRigidBody* body : {&a, &b}) {
            if (!body->isStaticOrKinematicObject()) suspects_.push_back(body);
        }
    }
    calls_others_ = detail::SingleTick::calls_others(world_, actions);
    at_risk_ = all || calls_others_ || !suspects_.empty();
}

DUCTILE_INLINE bool WorldParts::may_be_put_back() {
    if (!std::exchange(looked_, true)) find_risk();
    at_risk_ = at_risk_ || closes_;
    if (at_risk_) decide();
    return at_risk_;
}

DUCTILE_INLINE void WorldParts::save() {
    kept_ = true;
    kept_time_ = time_;
    meter_.keep();
    snapshot_.take(world_, front_.usual(), scope());
}

DUCTILE_INLINE void WorldParts::put_back() {
    snapshot_.put_back(world_, front_.usual(), scope(),
                       [this] { local_tick_.collide(world_, scope_); });
    meter_.put_back();
    if (local_) {
        for (btRigidBody* body : scope_.bodies()) body->clearForces();
    } else {
        world_.clearForces();
    }
    forces_act_ = false;
    time_ = kept_time_;
}

DUCTILE_INLINE void WorldParts::tick(double h, bool ahead) {
    const auto is_meant = [this](const btRigidBody& body) { return !local_ || scope_.has(body); };
    if (!std::exchange(forces_act_, false)) forces_.apply(is_meant);
    if (!ahead) members_->apply_forces();
    const bool metered = keeps_ledger_ || at_risk_;
    if (metered) meter_.before_step();
    PartStops stops;
    take_stops(stops);
    if (ahead) {
        if (at_risk_) {
            held_.see(manifolds(), half_, [this](const auto& body) { return concerns(body); });
        }
        const bool moved =
            half_ahead_.move(bodies_of(world_, scope()), btScalar(h), ways_, btScalar(time_));
        held_.let_go(manifolds(), half_ + h / 2,
                     [this](const auto& body) { return concerns(body); });
        time_ += h;
        forces_.follow(is_meant); // to where their places are now
        members_->apply_forces();
        if (metered && (moved || !members_->empty())) meter_.bodies_ahead();
        keep_spins(h);
    }
    members_->before_solve();
    stops.set(h, length_, double(world_.getSolverInfo().m_erp));
    Lent<btScalar> lent;
    Lent<int> modes;
    rule(world_.getSolverInfo(), btScalar(h), length_, !ahead, lent, modes);
    const HingeMotors motors(world_, btScalar(h / length_), lent);
    if (calls_others_) share_brakes(btScalar(h / length_), lent);
    front_.set_kind(ahead ? TickKind::part : TickKind::blow, length_, at_risk_ ? &held_ : nullptr);
    if (local_) {
        local_tick_.go(world_, scope_, btScalar(h),
                       [this, h] { half_ahead_.finish(scope_.bodies(), btScalar(h)); });
    } else {
        detail::SingleTick::go(world_, btScalar(h));
    }
    front_.set_kind(TickKind::step);
    stops.put_back();
    stop_met_ = stops.met(h, apart_);
    if (metered) meter_.after_step(double(btScalar(h)));
}

DUCTILE_INLINE void WorldParts::tick_with_met(double h, bool ahead) {
    do {
        tick(h, ahead);
    } while (local_ && join_touched());
}

DUCTILE_INLINE const PartMotion& WorldParts::part(double h) try {
    if (local_ && scope_.bodies().empty() && members_->empty()) { // all stands
        motion_.rigid_work = motion_.contact_work = motion_.closed = 0;
        motion_.contact_lost = false;
        motion_.turned = 0;
        motion_.own = {};
        return motion_;
    }
    // so short a part closes what is left of a gap: its impulses are a blow's
    const bool instant = h < shortest_part();
    if (instant) begin_blow();
    const auto look = [&] {
        if (members_->empty()) return false;
        // a contact that began unforeseen pushed for too long: the frame cuts the part there first
        motion_.closed = closed_early(h);
        if (is_put_back(motion_.closed, h)) return false;
        const auto length = double(btScalar(h));
        return instant ? members_->look_blow(length) : members_->look(length);
    };
    for (tick_with_met(h, true); look(); tick_with_met(h, true)) {
        do_again();
        (void)closing_.find(world_, h, touching_, apart_); // of other bodies
    }
    tell();
    const bool metered = keeps_ledger_ || at_risk_;
    motion_.rigid_work = metered ? meter_.step_of_plastic_joints() : 0;
    // they are right at the end of the part: what they give is no drift that is pulled back
    motion_.others_work = metered ? std::abs(meter_.step_of_other_joints()) : 0;
    motion_.stored = metered ? meter_.stored() : 0;
    motion_.own = front_.own();
    motion_.closed_share = members_->closed_share();
    motion_.contact_work = 0;
    if (metered && motion_.flows()) {
        motion_.contact_work = meter_.step_of_contacts([this](const void* body) {
            return body != nullptr && concerns(*static_cast<const btRigidBody*>(body));
        });
    }
    if (members_->empty()) motion_.closed = closed_early(h);
    look_at_pushes(h);
    return motion_;
} catch (...) { // a callback's, or of who makes what holds on to a member
    break_off();
    throw;
}

DUCTILE_INLINE std::span<btPersistentManifold* const> WorldParts::manifolds() {
    return manifolds_of(*world_.getDispatcher(), scope());
}

DUCTILE_INLINE bool WorldParts::concerns(const btCollisionObject& object) {
    const btRigidBody* body = btRigidBody::upcast(&object);
    return body != nullptr && !body->isStaticOrKinematicObject() &&
           closing_.touches_plastic(world_, *body);
}

/// Where what flows could be off by them: contacts that are gone, and how far they turned.
DUCTILE_INLINE void WorldParts::look_at_pushes(double h) {
    motion_.contact_lost = false;
    motion_.turned = 0;
    if (!at_risk_ || !may_misplace(motion_, h, apart_)) return;
    const auto concerned = [this](const auto& body) { return concerns(body); };
    motion_.turned = held_.turn(manifolds(), h, concerned);
    motion_.contact_lost = held_.lost(world_, manifolds(), h, concerned);
}

DUCTILE_INLINE void WorldParts::accept(double h) try {
    kept_ = false;
    half_ = h / 2;
    held_.accept();
    if (h > 0) meter_.rings_down(members_->count_vibration());
    const int objects = world_.getNumCollisionObjects();
    accept_(h);
    if (world_.getNumCollisionObjects() != objects) see_bodies(); // a listener took some out
    if (h > 0 && !members_->empty()) close_held(Closing::after_step);
} catch (...) { // a listener's
    break_off();
    throw;
}

DUCTILE_INLINE const PartMotion& WorldParts::tell() {
    if (local_ && members_->empty()) { // whose joints come and go
        motion_.plastic_work = motion_.idle_work = outside_work_;
        for (const LocalScope::Joint& entry : scope_.joints()) {
            const PlasticConstraint& joint = *entry.joint;
            rows_.clear();
            joint.list_part_rows(number(entry.place, joint), rows_);
            detail::tell_island(joint, rows_);
            std::copy(rows_.begin(), rows_.end(),
                      motion_.rows.begin() + std::ptrdiff_t(first_row_[std::size_t(entry.place)]));
            risk_.note(entry.place, joint, rows_);
            motion_.plastic_work += joint.queries().absorbed_energy();
        }
        return motion_;
    }
    motion_.rows.clear();
    motion_.plastic_work = members_->closed_work();
    motion_.idle_work = members_->idle_work() + (local_ ? outside_work_ : 0);
    motion_.closed_work = members_->unmissed_work();
    first_row_.resize(std::size_t(world_.getNumConstraints()));
    for (int i = 0; i < world_.getNumConstraints(); ++i) {
        const std::size_t first = first_row_[std::size_t(i)] = motion_.rows.size();
        const PlasticConstraint* plastic = as_plastic(*world_.getConstraint(i));
        if (plastic == nullptr) continue;
        plastic->list_part_rows(number(i, *plastic), motion_.rows);
        const std::span<PartRow> rows = std::span(motion_.rows).subspan(first);
        int section = 0;
        if (!members_->empty() && members_->key_of(*plastic, section) != nullptr) {
            for (PartRow& row : rows) row.section = section + 1;
        } else {
            detail::tell_island(*plastic, rows);
        }
        risk_.note(i, *plastic, rows);
        motion_.plastic_work += plastic->queries().absorbed_energy();
    }
    return motion_;
}

DUCTILE_INLINE ClosingContacts WorldParts::closing(double h, double touching, double apart) {
    touching_ = touching;
    apart_ = apart;
    const double ahead = decided_ ? h : std::max(h, length_);
    ClosingContacts found = closing_.find(world_, ahead, touching, apart);
    while (local_ && !closing_.foreign().empty()) {
        join(std::vector<btRigidBody*>(closing_.foreign()));
        found = closing_.find(world_, ahead, touching, apart);
    }
    see_stops(ahead, found);
    found.strikes = found.strikes || !thrown_.bodies().empty();
    closes_ = found.strikes || found.time <= ahead || closing_.any_soft();
    if (closes_) decide();
    return found;
}

} // namespace ductile::bullet

#include "ductile/bullet/world_parts_alone.ipp"  // IWYU pragma: keep
#include "ductile/bullet/world_parts_blows.ipp"  // IWYU pragma: keep
#include "ductile/bullet/world_parts_bodies.ipp" // IWYU pragma: keep
