// SPDX-License-Identifier: MIT
//
// Bodies of world_parts.hpp: the islands that are done again alone. A part of world_parts.ipp.
#pragma once

#include <LinearMath/btAabbUtil2.h>

namespace ductile::bullet {

DUCTILE_INLINE void WorldParts::decide() {
    if (std::exchange(decided_, true)) return;
    if (!std::exchange(looked_, true)) find_risk();
    for (const btRigidBody* body : closing_.found_bodies()) suspects_.push_back(body);
    for (const btRigidBody* body : thrown_.bodies()) suspects_.push_back(body);
    at_risk_ = true;
    if (!ways_.empty() || calls_others_ || islands_ == nullptr) return;
    if (!members_->empty() && !closes_ && !members_->any_open()) return;
    if (!LocalTick::is_possible(world_, front_.usual())) return;
    if (is_little()) {
        try_all();
    } else if (most_stands()) {
        leave_what_stands();
    }
}

/// Bullet's own ticks look at all that stands, too. What joints without members told of themselves
/// is known from a part of all.
DUCTILE_INLINE bool WorldParts::most_stands() const {
    constexpr std::size_t many = 16; // bodies by one that moves
    return !members_->empty() &&
           MovingBodies::all(world_).size() * many < std::size_t(world_.getNumCollisionObjects());
}
DUCTILE_INLINE void WorldParts::leave_what_stands() {
    const auto bodies = MovingBodies::all(world_);
    scope_.set(world_, {bodies.begin(), bodies.end()});
    local_ = true;
    outside_work_ = 0;
    outside_.clear();
    look_at(scope_);
}

/// Whether less than half of the bodies are in islands of suspects, as the last tick had them.
DUCTILE_INLINE bool WorldParts::is_little() const {
    const auto objects = std::size_t(world_.getNumCollisionObjects());
    std::vector<char> suspected(2 * objects + 1), by_place(objects);
    for (const btRigidBody* body : suspects_) {
        if (body->getWorldArrayIndex() < 0) continue; // somebody took it out
        const int tag = body->getIslandTag();         // none yet, of a body that is new here
        by_place[std::size_t(body->getWorldArrayIndex())] = 1;
        if (tag >= 0 && std::size_t(tag) < suspected.size()) suspected[std::size_t(tag)] = 1;
    }
    const auto bodies = MovingBodies::all(world_);
    const auto of_these = std::count_if(bodies.begin(), bodies.end(), [&](const btRigidBody* body) {
        const int tag = body->getIslandTag();
        return by_place[std::size_t(body->getWorldArrayIndex())] || members_->is_member(*body) ||
               (tag >= 0 && std::size_t(tag) < suspected.size() && suspected[std::size_t(tag)]);
    });
    return 2 * std::size_t(of_these) < bodies.size();
}

DUCTILE_INLINE void WorldParts::try_all() {
    frame_.take(world_, front_.usual());
    meter_.keep();
    were_enabled_.clear();
    for (const btTypedConstraint* constraint : constraints_of(world_, nullptr)) {
        were_enabled_.push_back(constraint->isEnabled());
    }
    std::vector<char> chosen(std::size_t(world_.getNumCollisionObjects()));
    choose_members(chosen);
    tick(length_, true);
    tell();
    choose_members(chosen);
    std::vector<btRigidBody*> trouble = find_trouble(chosen);
    if (2 * trouble.size() >= MovingBodies::all(world_).size()) {
        frame_.put_back(world_, front_.usual());
        meter_.put_back();
        world_.clearForces();
    } else {
        scope_.set(world_, std::move(trouble));
        local_ = true;
        meter_.keep_step(double(btScalar(length_)));
        go_back_alone(scope_);
        frame_.leave_out(scope_);
        narrow_to(scope_);
    }
    forces_act_ = false;
    time_ = 0;
}

DUCTILE_INLINE void WorldParts::choose_members(std::vector<char>& chosen) {
    if (members_->empty()) return;
    const auto choose = [&](const btCollisionObject& a, const btCollisionObject& b) {
        if (!members_->is_member(a) && !members_->is_member(b)) return;
        for (const btCollisionObject* object : {&a, &b}) {
            if (object->isStaticOrKinematicObject() || object->getWorldArrayIndex() < 0) continue;
            chosen[std::size_t(object->getWorldArrayIndex())] = 1;
        }
    };
    for (const btRigidBody* body : MovingBodies::all(world_)) choose(*body, *body);
    for (const btTypedConstraint* constraint : constraints_of(world_, nullptr)) {
        choose(constraint->getRigidBodyA(), constraint->getRigidBodyB());
    }
    for (const btPersistentManifold* manifold : manifolds_of(*world_.getDispatcher(), nullptr)) {
        if (manifold->getNumContacts() > 0) choose(*manifold->getBody0(), *manifold->getBody1());
    }
}

DUCTILE_INLINE void WorldParts::see_members() {
    if (!local_) return;
    std::vector<const btRigidBody*> before(scope_.bodies().begin(), scope_.bodies().end());
    std::sort(before.begin(), before.end());
    std::vector<btRigidBody*> bodies;
    for (btRigidBody* body : MovingBodies::all(world_)) {
        if (members_->is_member(*body) || std::binary_search(before.begin(), before.end(), body)) {
            bodies.push_back(body);
        }
    }
    scope_.set(world_, std::move(bodies));
}

/// Of islands, before and after the part of all, with something in trouble, beside the chosen.
DUCTILE_INLINE std::vector<btRigidBody*> WorldParts::find_trouble(std::vector<char>& chosen) {
    const auto bodies = MovingBodies::all(world_);
    const auto choose = [&chosen](const btRigidBody& body) {
        if (!body.isStaticOrKinematicObject() && body.getWorldArrayIndex() >= 0) {
            chosen[std::size_t(body.getWorldArrayIndex())] = 1;
        }
    };
    for (const btRigidBody* body : closing_.found_bodies()) choose(*body);
    for (const btRigidBody* body : thrown_.bodies()) choose(*body);
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

DUCTILE_INLINE void WorldParts::look_at(const LocalScope& scope) {
    narrow_ = true;
    meter_.set_scope(&scope);
    closing_.set_scope(&scope);
    members_->set_scope(&scope);
}

DUCTILE_INLINE void WorldParts::narrow_to(LocalScope& scope) {
    look_at(scope);
    meter_.narrow();
    outside_work_ = 0;
    outside_.clear();
    for (btTypedConstraint* constraint : constraints_of(world_, nullptr)) {
        const PlasticConstraint* plastic = as_plastic(*constraint);
        if (plastic == nullptr || scope.has(*constraint)) continue;
        outside_work_ += plastic->queries().absorbed_energy();
        outside_.push_back(constraint);
    }
    std::sort(outside_.begin(), outside_.end());
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
        for (btRigidBody* body : scope_.bodies()) body->clearForces(); // members' own, too
    }
    scope_.set(world_, std::move(joined));
    narrow_to(scope_);
    forces_act_ = false;
}

/// The frame ends here: what stood aside went through all of it.
DUCTILE_INLINE void WorldParts::break_off() {
    if (!local_) return;
    if (std::exchange(kept_, false)) put_back();
    see_members();
    std::vector<btRigidBody*> aside;
    for (btRigidBody* body : MovingBodies::all(world_)) {
        if (!scope_.has(*body)) aside.push_back(body);
    }
    if (!aside.empty()) join(aside);
}

DUCTILE_INLINE std::size_t WorldParts::number(int place, const PlasticConstraint& joint) {
    if (!members_->empty()) return number_(joint); // their joints come and go
    if (numbers_.size() <= std::size_t(place)) numbers_.resize(std::size_t(place) + 1);
    auto& [known, number] = numbers_[std::size_t(place)];
    if (known != &joint) {
        known = &joint;
        number = number_(joint);
    }
    return number;
}

} // namespace ductile::bullet
