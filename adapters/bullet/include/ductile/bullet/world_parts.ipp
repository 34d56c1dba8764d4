// SPDX-License-Identifier: MIT
//
// Bodies of world_parts.hpp.
#pragma once

#include <LinearMath/btAabbUtil2.h>

#include <algorithm>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <utility>

#include "ductile/bullet/convert.hpp"
#include "ductile/bullet/front_solver.hpp"
#include "ductile/bullet/members.hpp"
#include "ductile/bullet/moving_bodies.hpp"
#include "ductile/bullet/world_parts.hpp"

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

} // namespace detail

/// The solver's settings of a part or a blow while this lives.
class WorldParts::Settings {
  public:
    Settings(btContactSolverInfo& info, btScalar h, bool blow) : info_(info), usual_(info) {
        constexpr btScalar removed_in = btScalar(5e-3), as_in = btScalar(1e-4); // [s]
        const btScalar most = blow ? btScalar(0) : h / removed_in;
        info.m_erp = std::min(info.m_erp, most);
        info.m_erp2 = std::min(info.m_erp2, most);
        if (!blow) return;
        info.m_splitImpulse = 0;
        info.m_globalCfm *= h / as_in; // a compliance is divided by the tick
    }
    ~Settings() {
        info_.m_erp = usual_.m_erp;
        info_.m_erp2 = usual_.m_erp2;
        info_.m_splitImpulse = usual_.m_splitImpulse;
        info_.m_globalCfm = usual_.m_globalCfm;
    }
    Settings(const Settings&) = delete;
    Settings& operator=(const Settings&) = delete;

  private:
    btContactSolverInfo& info_;
    btContactSolverInfo usual_;
};

DUCTILE_INLINE WorldParts::WorldParts(btDiscreteDynamicsWorld& world, FrontHold& front,
                                      EnergyMeter& meter, Members& members, Number number,
                                      Accept accept, bool keeps_ledger)
    : world_(world),
      front_(front),
      meter_(meter),
      members_(members),
      number_(std::move(number)),
      accept_(std::move(accept)),
      half_ahead_(world),
      islands_(MeetingIslands::enter(world)),
      closing_(members),
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
    time_ = 0;
    length_ = length;
    looked_ = decided_ = local_ = closes_ = at_risk_ = false;
    for (int i = 0; i < world_.getNumConstraints(); ++i) {
        PlasticConstraint* plastic = as_plastic(*world_.getConstraint(i));
        if (plastic == nullptr) continue;
        if (!plastic->in_world()) {
            throw std::logic_error(
                "World.step: a plastic joint must be put into a world with a tolerance by "
                "World::add "
                "or its own add_to, as Bullet's addConstraint does not say when a part ends");
        }
        plastic->begin_part();
    }
}

DUCTILE_INLINE void WorldParts::end() {
    world_.synchronizeMotionStates();
    widen();
}

DUCTILE_INLINE void WorldParts::widen() {
    if (!std::exchange(narrow_, false)) return;
    meter_.set_scope(nullptr);
    meter_.narrow(true);
    closing_.set_scope(nullptr);
}

DUCTILE_INLINE void WorldParts::find_risk() {
    suspects_.clear();
    int actions = 1; // half_ahead_'s, and one of each joint
    bool all = !same_forces_ || !members_.empty() || !ways_.empty();
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
    if (!std::exchange(forces_act_, false)) {
        forces_.apply([this](const btRigidBody& body) { return !local_ || scope_.has(body); });
    }
    members_.apply_forces();
    const bool metered = keeps_ledger_ || at_risk_;
    if (metered) meter_.before_step();
    if (ahead) {
        half_ahead_.move(local_ ? scope_.bodies() : MovingBodies::all(world_), btScalar(h), ways_,
                         btScalar(time_));
        time_ += h;
        if (metered) meter_.bodies_ahead();
    }
    members_.before_solve();
    const Settings settings(world_.getSolverInfo(), btScalar(h), !ahead);
    front_.set_kind(ahead ? TickKind::part : TickKind::blow);
    if (local_) {
        local_tick_.go(world_, scope_, btScalar(h),
                       [this, h] { half_ahead_.finish(scope_.bodies(), btScalar(h)); });
    } else {
        detail::SingleTick::go(world_, btScalar(h));
    }
    front_.set_kind(TickKind::step);
    if (metered) meter_.after_step(double(btScalar(h)));
}

DUCTILE_INLINE const PartMotion& WorldParts::part(double h) {
    if (local_ && scope_.bodies().empty()) { // all stands
        motion_.rigid_work = motion_.contact_work = motion_.closed = 0;
        return motion_;
    }
    for (tick(h, true); members_.look(double(btScalar(h))); tick(h, true)) do_again();
    while (local_ && join_touched()) tick(h, true);
    tell();
    const bool metered = keeps_ledger_ || at_risk_;
    motion_.rigid_work = metered ? meter_.step_of_plastic_joints() : 0;
    motion_.contact_work = metered ? meter_.step_of_contacts() : 0;
    motion_.closed = closing_.closed_early(world_, h, apart_);
    return motion_;
}

DUCTILE_INLINE void WorldParts::do_again() {
    put_back();
    const double before = meter_.held().total();
    members_.open_found();
    meter_.bodies_rearranged(before);
    save();
}

DUCTILE_INLINE const PartMotion& WorldParts::blow() {
    constexpr double instant = 1e-9;
    if (!members_.empty() || local_) save();
    members_.begin_blow();
    for (tick(instant, false); members_.look_blow(instant); tick(instant, false)) do_again();
    while (local_ && join_touched()) tick(instant, false);
    motion_.closed = 0;
    return tell();
}

DUCTILE_INLINE void WorldParts::accept(double h) {
    accept_(h);
    if (!(h > 0) || members_.empty()) return;
    const double before = meter_.held().total();
    if (members_.close_held()) meter_.bodies_rearranged(before);
}

DUCTILE_INLINE const PartMotion& WorldParts::tell() {
    if (local_) {
        motion_.plastic_work = outside_work_;
        for (const LocalScope::Joint& entry : scope_.joints()) {
            const PlasticConstraint& joint = *entry.joint;
            rows_.clear();
            joint.list_part_rows(number(entry.place, joint), rows_);
            std::copy(rows_.begin(), rows_.end(),
                      motion_.rows.begin() + std::ptrdiff_t(first_row_[std::size_t(entry.place)]));
            risk_.note(entry.place, joint, rows_);
            motion_.plastic_work += joint.queries().absorbed_energy();
        }
        return motion_;
    }
    motion_.rows.clear();
    motion_.plastic_work = members_.closed_work();
    motion_.closed_work = members_.unmissed_work();
    first_row_.resize(std::size_t(world_.getNumConstraints()));
    for (int i = 0; i < world_.getNumConstraints(); ++i) {
        const std::size_t first = first_row_[std::size_t(i)] = motion_.rows.size();
        const PlasticConstraint* plastic = as_plastic(*world_.getConstraint(i));
        if (plastic == nullptr) continue;
        plastic->list_part_rows(number(i, *plastic), motion_.rows);
        int section = 0;
        if (!members_.empty() && members_.key_of(*plastic, section) != nullptr) {
            for (std::size_t k = first; k < motion_.rows.size(); ++k) {
                motion_.rows[k].section = section + 1;
            }
        }
        risk_.note(i, *plastic, std::span(motion_.rows).subspan(first));
        motion_.plastic_work += plastic->queries().absorbed_energy();
    }
    return motion_;
}

// ---- islands that are done again alone

DUCTILE_INLINE void WorldParts::decide() {
    if (std::exchange(decided_, true)) return;
    if (!std::exchange(looked_, true)) find_risk();
    for (const btRigidBody* body : closing_.found_bodies()) suspects_.push_back(body);
    at_risk_ = true;
    if (!members_.empty() || !ways_.empty() || calls_others_ || islands_ == nullptr) return;
    if (!is_little() || !LocalTick::is_possible(world_, front_.usual())) return;
    try_all();
}

/// Whether less than half of the bodies are in islands of suspects, as the last tick had them.
DUCTILE_INLINE bool WorldParts::is_little() const {
    const auto objects = std::size_t(world_.getNumCollisionObjects());
    std::vector<char> suspected(2 * objects + 1), by_place(objects);
    for (const btRigidBody* body : suspects_) {
        const int tag = body->getIslandTag(); // none yet, of a body that is new here
        by_place[std::size_t(body->getWorldArrayIndex())] = 1;
        if (tag >= 0 && std::size_t(tag) < suspected.size()) suspected[std::size_t(tag)] = 1;
    }
    const auto bodies = MovingBodies::all(world_);
    const auto of_these = std::count_if(bodies.begin(), bodies.end(), [&](const btRigidBody* body) {
        const int tag = body->getIslandTag();
        return by_place[std::size_t(body->getWorldArrayIndex())] ||
               (tag >= 0 && std::size_t(tag) < suspected.size() && suspected[std::size_t(tag)]);
    });
    return 2 * std::size_t(of_these) < bodies.size();
}

DUCTILE_INLINE void WorldParts::try_all() {
    frame_.take(world_, front_.usual());
    meter_.keep();
    were_enabled_.clear();
    for (int i = 0; i < world_.getNumConstraints(); ++i) {
        were_enabled_.push_back(world_.getConstraint(i)->isEnabled());
    }
    tick(length_, true);
    tell();
    std::vector<btRigidBody*> trouble = find_trouble();
    if (2 * trouble.size() >= MovingBodies::all(world_).size()) {
        frame_.put_back(world_, front_.usual());
        meter_.put_back();
        world_.clearForces();
    } else {
        scope_.set(world_, std::move(trouble));
        local_ = narrow_ = true;
        meter_.keep_step(double(btScalar(length_)));
        go_back_alone(scope_);
        narrow_to(scope_);
    }
    forces_act_ = false;
    time_ = 0;
}

/// Of islands, before and after the part of all, with something in trouble.
DUCTILE_INLINE std::vector<btRigidBody*> WorldParts::find_trouble() {
    const auto bodies = MovingBodies::all(world_);
    std::vector<char> chosen(std::size_t(world_.getNumCollisionObjects()));
    const auto choose = [&chosen](const btRigidBody& body) {
        if (!body.isStaticOrKinematicObject()) {
            chosen[std::size_t(body.getWorldArrayIndex())] = 1;
        }
    };
    for (const btRigidBody* body : closing_.found_bodies()) choose(*body);
    if (closing_.closed_early(world_, length_, apart_) > 0) {
        for (const btRigidBody* body : closing_.found_bodies()) choose(*body);
    }
    for (int i = 0; i < world_.getNumConstraints(); ++i) {
        btTypedConstraint& constraint = *world_.getConstraint(i);
        if (as_plastic(constraint) == nullptr) continue;
        const std::size_t first = first_row_[std::size_t(i)];
        const std::size_t next = i + 1 < world_.getNumConstraints() ? first_row_[std::size_t(i + 1)]
                                                                    : motion_.rows.size();
        const auto rows = std::span(motion_.rows).subspan(first, next - first);
        const bool broke = were_enabled_[std::size_t(i)] && !constraint.isEnabled();
        if (!broke && std::none_of(rows.begin(), rows.end(), [](const PartRow& row) {
                return row.moves() || row.too_far > 0;
            })) {
            continue;
        }
        choose(constraint.getRigidBodyA());
        choose(constraint.getRigidBodyB());
    }
    add_reached(chosen);
    std::vector<btRigidBody*> result;
    for (btRigidBody* body : bodies) {
        if (chosen[std::size_t(body->getWorldArrayIndex())]) result.push_back(body);
    }
    return result;
}

/// Islands of the chosen, and whoever is near enough to meet them within the frame, with theirs.
DUCTILE_INLINE void WorldParts::add_reached(std::vector<char>& chosen) const {
    const auto bodies = MovingBodies::all(world_);
    std::vector<char> before(2 * chosen.size() + 1), after(2 * chosen.size() + 1);
    const auto mark = [](std::vector<char>& tags, int tag) -> char& {
        static char none;
        none = 0;
        return tag >= 0 && std::size_t(tag) < tags.size() ? tags[std::size_t(tag)] : none;
    };
    const auto place = [](const btRigidBody& body) {
        return std::size_t(body.getWorldArrayIndex());
    };
    /// Where it was in the part of all, or may have been.
    struct Swept {
        btVector3 low, high;
        explicit Swept(const btRigidBody& body, btScalar h) {
            detail::ShapeReach reach;
            const btScalar way =
                h * (body.getLinearVelocity().length() + detail::turning_speed(body, reach)) +
                btScalar(0.02);                                          // as Bullet knows contacts
            const btBroadphaseProxy& proxy = *body.getBroadphaseProxy(); // in its middle
            low = proxy.m_aabbMin - btVector3(way, way, way);
            high = proxy.m_aabbMax + btVector3(way, way, way);
        }
    };
    for (bool more = true; more;) {
        more = false;
        frame_.tell_islands([&](const btRigidBody& body, int tag) {
            if (chosen[place(body)]) mark(before, tag) = 1;
        });
        for (const btRigidBody* body : bodies) {
            if (chosen[place(*body)]) mark(after, body->getIslandTag()) = 1;
        }
        frame_.tell_islands([&](const btRigidBody& body, int tag) {
            if (chosen[place(body)] || !(mark(before, tag) || mark(after, body.getIslandTag()))) {
                return;
            }
            chosen[place(body)] = 1;
            more = true;
        });
        if (more) continue;
        std::vector<Swept> ways;
        for (const btRigidBody* body : bodies) {
            if (chosen[place(*body)]) ways.emplace_back(*body, btScalar(length_));
        }
        for (const btRigidBody* body : bodies) {
            if (chosen[place(*body)] || !body->isActive()) continue;
            const Swept way(*body, btScalar(length_));
            const bool meets = std::any_of(ways.begin(), ways.end(), [&way](const Swept& other) {
                return TestAabbAgainstAabb2(way.low, way.high, other.low, other.high);
            });
            if (!meets) continue;
            chosen[place(*body)] = 1;
            more = true;
        }
    }
}

/// From the end of the part of all to the frame's begin.
DUCTILE_INLINE void WorldParts::go_back_alone(LocalScope& scope) {
    meter_.set_scope(&scope);
    meter_.narrow();
    meter_.take_back();
    frame_.put_back(world_, front_.usual(), &scope,
                    [this, &scope] { local_tick_.collide(world_, scope); });
    for (btRigidBody* body : scope.bodies()) body->clearForces();
    meter_.moved_back();
}

DUCTILE_INLINE void WorldParts::narrow_to(LocalScope& scope) {
    meter_.set_scope(&scope);
    meter_.narrow();
    closing_.set_scope(&scope);
    outside_work_ = 0;
    for (int i = 0; i < world_.getNumConstraints(); ++i) {
        const PlasticConstraint* plastic = as_plastic(*world_.getConstraint(i));
        if (plastic == nullptr || scope.has_joint(world_.getConstraint(i))) continue;
        outside_work_ += plastic->queries().absorbed_energy();
    }
}

DUCTILE_INLINE bool WorldParts::join_touched() {
    if (local_tick_.touched().empty()) return false;
    put_back();
    join(std::vector<btRigidBody*>(local_tick_.touched()));
    save();
    return true;
}

DUCTILE_INLINE void WorldParts::join(const std::vector<btRigidBody*>& met) {
    std::vector<char> chosen(std::size_t(world_.getNumCollisionObjects()));
    for (const btRigidBody* body : met) chosen[std::size_t(body->getWorldArrayIndex())] = 1;
    std::vector<btRigidBody*> joined(scope_.bodies().begin(), scope_.bodies().end()), others;
    std::vector<int> tags;
    for (const btRigidBody* body : MovingBodies::all(world_)) {
        if (chosen[std::size_t(body->getWorldArrayIndex())]) tags.push_back(body->getIslandTag());
    }
    for (btRigidBody* body : MovingBodies::all(world_)) {
        if (scope_.has(*body)) continue;
        const bool same = std::find(tags.begin(), tags.end(), body->getIslandTag()) != tags.end();
        if (same || chosen[std::size_t(body->getWorldArrayIndex())]) others.push_back(body);
    }
    joined.insert(joined.end(), others.begin(), others.end());
    const double now = time_;
    joining_.set(world_, std::move(others));
    go_back_alone(joining_);
    if (now > 0) { // alone: what it touched in the part of all is its own island
        std::swap(scope_, joining_);
        meter_.set_scope(&scope_);
        time_ = 0;
        tick(now, true);
        std::swap(scope_, joining_);
    }
    scope_.set(world_, std::move(joined));
    narrow_to(scope_);
    forces_act_ = false;
}

DUCTILE_INLINE std::size_t WorldParts::number(int place, const PlasticConstraint& joint) {
    if (!members_.empty()) return number_(joint); // their joints come and go
    if (numbers_.size() <= std::size_t(place)) numbers_.resize(std::size_t(place) + 1);
    auto& [known, number] = numbers_[std::size_t(place)];
    if (known != &joint) {
        known = &joint;
        number = number_(joint);
    }
    return number;
}

DUCTILE_INLINE ClosingContacts WorldParts::closing(double h, double touching, double apart) {
    apart_ = apart;
    const double ahead = decided_ ? h : std::max(h, length_);
    ClosingContacts found = closing_.find(world_, ahead, touching, apart);
    while (local_ && !closing_.foreign().empty()) {
        join(std::vector<btRigidBody*>(closing_.foreign()));
        found = closing_.find(world_, ahead, touching, apart);
    }
    closes_ = found.strikes || found.time <= ahead;
    if (closes_) decide();
    return found;
}

DUCTILE_INLINE double WorldParts::kinetic_energy() const {
    double sum = 0;
    for (const btRigidBody* body : local_ ? scope_.bodies() : MovingBodies::all(world_)) {
        if (!(body->getInvMass() > 0) || body->isStaticOrKinematicObject()) continue;
        const btVector3 spin =
            body->getAngularVelocity() * body->getCenterOfMassTransform().getBasis();
        sum += double(body->getLinearVelocity().length2()) / (2 * double(body->getInvMass()));
        for (int k = 0; k < 3; ++k) {
            const btScalar inverse = body->getInvInertiaDiagLocal()[k];
            if (inverse > 0) sum += double(spin[k] * spin[k]) / (2 * double(inverse));
        }
    }
    return sum;
}

} // namespace ductile::bullet
