// SPDX-License-Identifier: MIT
//
// Bodies of island_solver.hpp.
#pragma once

#include <algorithm>

#include "ductile/ode/island_solver.hpp"

namespace ductile::ode {

DUCTILE_INLINE void IslandSolver::add(PlasticConstraint& joint) {
    members_.push_back({&joint, joint.island_rows()});
    indexed_ = false;
}
DUCTILE_INLINE void IslandSolver::remove(PlasticConstraint& joint) {
    std::erase_if(members_, [&joint](const Member& member) { return member.joint == &joint; });
    kept_.erase(&joint);
    indexed_ = false;
}

DUCTILE_INLINE void IslandSolver::index_members() {
    member_of_.clear();
    for (std::size_t i = 0; i < members_.size(); ++i) {
        if (members_[i].rows != nullptr) member_of_[members_[i].joint->id()] = i;
    }
    indexed_ = true;
}

// ---- a step

DUCTILE_INLINE void IslandSolver::before_step(const std::vector<NamedContact>& contacts, double dt,
                                              bool may_sleep, std::span<const dBodyID> others,
                                              std::span<const dJointID> of_members) {
    of_members_ = of_members;
    ahead_ = !may_sleep;
    if (members_.empty() && others.empty()) return;
    if (!indexed_) index_members();
    ++step_;
    number_.clear();
    contact_of_.clear();
    for (std::size_t i = 0; i < contacts.size(); ++i) {
        if (contacts[i].slides_only()) contact_of_[contacts[i].joint] = i;
    }
    for (const Member& member : members_) {
        const AttachedBodies bodies = member.joint->bodies();
        if (member.seen == step_ || !member.acts()) continue;
        const dBodyID first = can_move(bodies.a) ? bodies.a : bodies.b;
        if (!can_move(first) || number_.find(first) != nullptr) continue;
        const bool known = gather(first);
        bool ours = known && awake_;
        if (ours) {
            Kept& kept = kept_of(*member.joint);
            ours = !may_sleep || !falls_asleep(kept, dt);
            if (ours) solve(kept.solver, contacts, dt);
        }
        if (ours) continue;
        for (const std::size_t joint : joints_) members_[joint].rows->make_rows(dt);
    }
    for (const dBodyID body : others) {
        if (number_.find(body) != nullptr || !gather(body)) continue;
        const auto is_awake = [](dBodyID each) { return dBodyIsEnabled(each) != 0; };
        if (std::none_of(bodies_.begin(), bodies_.end(), is_awake)) continue;
        solve::IslandSolver alone;
        solve(alone, contacts, dt);
    }
    std::erase_if(kept_, [this](const auto& entry) { return entry.second.used != step_; });
    std::erase_if(owns_, [this](const auto& entry) { return entry.second.seen != step_; });
}

DUCTILE_INLINE void IslandSolver::after_step() {
    for (const dJointID joint : std::exchange(disabled_, {})) dJointEnable(joint);
    for (const auto& [body, samples] : std::exchange(kept_awake_, {})) {
        dBodySetAutoDisableAverageSamplesCount(body, unsigned(samples));
    }
}

DUCTILE_INLINE IslandSolver::Own* IslandSolver::own_of(dJointID joint) {
    if (std::find(of_members_.begin(), of_members_.end(), joint) != of_members_.end()) {
        return nullptr;
    }
    const auto found = owns_.find(joint);
    if (found != owns_.end() && (found->second.seen == step_ || found->second.joint.is_same())) {
        return &found->second;
    }
    if (!OwnJoint::is_known(joint)) return nullptr;
    if (found == owns_.end()) {
        return &owns_.try_emplace(joint, Own{OwnJoint(joint), owns_seen_++}).first->second;
    }
    found->second.joint = OwnJoint(joint);
    return &found->second;
}

/// All that hangs together with a body; false where not all of it is known.
DUCTILE_INLINE bool IslandSolver::gather(dBodyID first) {
    constexpr int no_seat = -1;
    bool known = true;
    joints_.clear();
    touches_.clear();
    owned_.clear();
    bodies_.assign(1, first);
    number_[first] = no_seat;
    awake_ = false;
    for (std::size_t at = 0; at < bodies_.size(); ++at) {
        const dBodyID body = bodies_[at];
        awake_ = awake_ || dBodyIsEnabled(body) != 0;
        for (int i = 0, count = dBodyGetNumJoints(body); i < count; ++i) {
            const dJointID joint = dBodyGetJoint(body, i);
            if (dJointIsEnabled(joint) == 0) continue;
            if (const std::size_t* member = member_of_.find(joint)) {
                Member& found = members_[*member];
                if (std::exchange(found.seen, step_) != step_ && found.rows->acts()) {
                    joints_.push_back(*member);
                }
            } else if (const std::size_t* touch = contact_of_.find(joint)) {
                touches_.push_back(*touch);
            } else if (Own* own = own_of(joint)) {
                if (std::exchange(own->seen, step_) == step_) continue; // from its other body
                owned_.push_back(own);
                known = known && own->joint.fits();
            } else {
                known = false;
            }
            for (const int side : {0, 1}) {
                const dBodyID other = dJointGetBody(joint, side);
                if (other == nullptr) continue;
                if (!can_move(other)) {
                    awake_ = awake_ || dBodyIsEnabled(other) != 0;
                } else if (number_.find(other) == nullptr) {
                    number_[other] = no_seat;
                    bodies_.push_back(other);
                }
            }
        }
    }
    // not in the order in which ODE happens to list them
    std::sort(joints_.begin(), joints_.end());
    std::sort(touches_.begin(), touches_.end());
    touches_.erase(std::unique(touches_.begin(), touches_.end()), touches_.end());
    std::sort(owned_.begin(), owned_.end(),
              [](const Own* a, const Own* b) { return a->number < b->number; });
    return known;
}

DUCTILE_INLINE bool IslandSolver::falls_asleep(Kept& kept, double dt) const {
    const Idle before = std::exchange(kept.idle, {});
    if (!std::all_of(bodies_.begin(), bodies_.end(), is_idle)) return false;
    const auto rests = [this](std::size_t joint) { return members_[joint].rows->rests(); };
    if (!std::all_of(joints_.begin(), joints_.end(), rests)) return false;
    const Idle now{before.steps + 1, before.time + dt};
    for (const dBodyID body : bodies_) {
        if (now.steps >= dBodyGetAutoDisableSteps(body) &&
            now.time >= double(dBodyGetAutoDisableTime(body))) {
            continue;
        }
        kept.idle = now;
        return false;
    }
    for (const dBodyID body : bodies_) {
        dBodyDisable(body);
        dBodySetLinearVel(body, 0, 0, 0);
        dBodySetAngularVel(body, 0, 0, 0);
    }
    return true;
}

DUCTILE_INLINE void IslandSolver::solve(solve::IslandSolver& solver,
                                        const std::vector<NamedContact>& contacts, double dt) {
    island_.clear();
    free_.clear();
    contact_rows_.clear();
    for (const std::size_t i : joints_) {
        const AttachedBodies bodies = members_[i].joint->bodies();
        take_seat(bodies.a, dt);
        take_seat(bodies.b, dt);
    }
    for (const Own* own : owned_) {
        for (const int side : {0, 1}) take_seat(dJointGetBody(own->joint.id(), side), dt);
    }
    for (const std::size_t i : touches_) {
        for (const int side : {0, 1}) take_seat(dJointGetBody(contacts[i].joint, side), dt);
    }
    for (const std::size_t i : joints_) {
        const AttachedBodies bodies = members_[i].joint->bodies();
        members_[i].rows->open_rows(island_, seat(bodies.a), seat(bodies.b), dt);
    }
    for (Own* own : owned_) {
        const AttachedBodies bodies = attached_bodies(own->joint.id());
        own->joint.open_rows(island_, seat(bodies.a), seat(bodies.b), dt, ahead_);
    }
    for (const std::size_t i : touches_) {
        const AttachedBodies bodies = attached_bodies(contacts[i].joint);
        contact_rows_.emplace_back(contacts[i], island_, seat(bodies.a), seat(bodies.b), dt);
    }
    solver.solve(island_);
    if (ahead_ && turns(dt)) solver.solve(island_);
    for (const std::size_t i : joints_) members_[i].rows->close_rows(island_, dt);
    for (const Own* own : owned_) own->joint.close_rows(island_, dt);
    for (const ContactRows& rows : contact_rows_) rows.close(island_, dt);
    set_aside(contacts);
}

/// Asks the rows of a solved island for what fits the velocities with which its bodies leave the
/// part; true where that is something else.
DUCTILE_INLINE bool IslandSolver::turns(double dt) {
    bool any = false;
    for (const std::size_t i : joints_) {
        const AttachedBodies bodies = members_[i].joint->bodies();
        any = members_[i].rows->turn_rows(island_, seat(bodies.a), seat(bodies.b), dt) || any;
    }
    for (Own* own : owned_) {
        const AttachedBodies bodies = attached_bodies(own->joint.id());
        any = own->joint.turn_rows(island_, seat(bodies.a), seat(bodies.b), dt) || any;
    }
    return any;
}

/// For ODE's step.
DUCTILE_INLINE void IslandSolver::set_aside(const std::vector<NamedContact>& contacts) {
    const auto disable = [this](dJointID joint) {
        dJointDisable(joint);
        disabled_.push_back(joint);
    };
    for (const Own* own : owned_) disable(own->joint.id());
    for (const std::size_t i : touches_) disable(contacts[i].joint);
    for (const dBodyID body : bodies_) {
        if (dBodyIsEnabled(body) == 0) dBodyEnable(body);
        const int samples = dBodyGetAutoDisableAverageSamplesCount(body);
        if (dBodyGetAutoDisableFlag(body) == 0 || samples == 0) continue;
        // not by its flag, with which ODE forgets the body's own steps and time
        dBodySetAutoDisableAverageSamplesCount(body, 0);
        kept_awake_.emplace_back(body, samples);
    }
}

DUCTILE_INLINE void IslandSolver::take_seat(dBodyID body, double dt) {
    if (!can_move(body)) return;
    int& number = number_[body];
    if (number >= 0) return;
    number = int(free_.size());
    const BodyState<double>& free = free_.emplace_back(free_state(body, dt));
    const double each = free.inverse_mass;
    island_.bodies.push_back(solve::island_body({each, each, each}, free.inverse_inertia));
}

DUCTILE_INLINE IslandSeat IslandSolver::seat(dBodyID body) const {
    if (!can_move(body)) {
        return {.velocity = linear_velocity(body), .spin = angular_velocity(body)};
    }
    const int number = *number_.find(body);
    const BodyState<double>& free = free_[std::size_t(number)];
    return {number, free.velocity, free.spin};
}

DUCTILE_INLINE IslandSolver::Kept& IslandSolver::kept_of(const PlasticConstraint& first) {
    Kept& kept = kept_[&first];
    kept.used = step_;
    return kept;
}

} // namespace ductile::ode
