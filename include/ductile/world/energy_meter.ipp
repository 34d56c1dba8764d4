// SPDX-License-Identifier: MIT
//
// Bodies of energy_meter.hpp.
#pragma once

#include <algorithm>
#include <functional>
#include <numeric>
#include <utility>

#include "ductile/joint/gyroscopic.hpp"
#include "ductile/vocabulary/linkage.hpp"
#include "ductile/world/energy_meter.hpp"

namespace ductile {

namespace detail {

/// Kinetic energy of a body with these velocities [J].
DUCTILE_INLINE double kinetic_energy(const MeteredBody& body, const Vector3<double>& velocity,
                                     const Vector3<double>& spin) {
    return body.mass * dot(velocity, velocity) / 2 + dot(spin, times(body.inertia, spin)) / 2;
}

} // namespace detail

DUCTILE_INLINE void EnergyMeter::open() {
    ledger_.open(held());
    last_ = ledger_.held();
    pairs_ = {};
}

DUCTILE_INLINE HeldEnergy<double> EnergyMeter::held() const {
    HeldEnergy<double> result = outside_;
    plastic_.clear();
    list_plastic_joints(plastic_);
    // joints first: one that books its step now may give a break's energy back to its bodies
    for (const auto& [joint, a, b] : plastic_) result.elastic += joint->stored_energy();
    bodies_.clear();
    list_bodies(bodies_);
    for (const MeteredBody& body : bodies_) {
        result.kinetic += detail::kinetic_energy(body, body.velocity, body.spin);
        result.potential -= dot(body.weight, body.position);
    }
    return result;
}

DUCTILE_INLINE void EnergyMeter::see_changes() {
    const HeldEnergy<double> now = held();
    ledger_.supply(now.total() - last_.total());
    last_ = now;
    ledger_.update(last_);
}

DUCTILE_INLINE void EnergyMeter::before_step(bool watches) {
    step_plastic_ = step_others_ = 0;
    pairs_.begin_step(!narrow_);
    see_changes();
    course_numbers_.clear();
    courses_.clear();
    for (const MeteredBody& body : bodies_) {
        if (course_numbers_.enter(body.body) < courses_.size()) continue; // listed twice
        courses_.emplace_back().start = body;
    }
    plastic_numbers_.clear();
    plastic_start_.clear();
    for (const auto& [joint, a, b] : plastic_) {
        if (plastic_numbers_.enter(joint) < plastic_start_.size()) continue;
        plastic_start_.push_back({joint->absorbed_energy(), joint->damped_energy(),
                                  joint->stored_energy(), joint->release().energy});
    }
    if (watches) watch_step();
}

DUCTILE_INLINE void EnergyMeter::bodies_rearranged(double before, Account account) {
    const double gained = held().total() - before;
    ledger_.book(account, -gained);
    last_.kinetic += gained; // what was changed from outside is seen by the next step
    ledger_.update(last_);
}

DUCTILE_INLINE void EnergyMeter::rings_down(double energy) {
    ledger_.book(Account::plastic, -energy);
    ledger_.book(Account::vibration, energy);
}

DUCTILE_INLINE void EnergyMeter::keep() {
    kept_.ledger = ledger_;
    kept_.last = last_;
    kept_.taken = taken_;
}

DUCTILE_INLINE void EnergyMeter::put_back() {
    ledger_ = kept_.ledger;
    last_ = kept_.last;
    pairs_.take_back();
    // joints that came since keep their numbers
    std::fill(std::copy(kept_.taken.begin(), kept_.taken.end(), taken_.begin()), taken_.end(), 0.0);
}

DUCTILE_INLINE void EnergyMeter::bodies_ahead() {
    bodies_.clear();
    list_bodies(bodies_);
    for (const MeteredBody& body : bodies_) {
        Course* course = course_of(body.body);
        if (course == nullptr) continue;
        MeteredBody& start = course->start;
        const Vector3<double> moved = difference(body.position, start.position);
        const double turning = detail::kinetic_energy(start, start.velocity, start.spin) -
                               detail::kinetic_energy(body, start.velocity, start.spin);
        course->ahead = dot(body.weight, moved) + turning;
        ledger_.book(Account::integration, course->ahead);
        start.position = body.position;
        start.inertia = body.inertia;
        start.force = body.force;
        start.torque = body.torque;
    }
}

DUCTILE_INLINE void EnergyMeter::add_gyroscopic(const void* body, const Vector3<double>& impulse) {
    if (Course* course = course_of(body)) course->gyroscopic = impulse;
}

DUCTILE_INLINE void EnergyMeter::after_step(double dt) {
    const HeldEnergy<double> now = held();
    for (const MeteredBody& body : bodies_) {
        Course* course = course_of(body.body);
        if (course == nullptr) continue;
        MeteredBody& start = course->start;
        const double before = detail::kinetic_energy(start, start.velocity, start.spin);
        damp(start, dt);
        course->damped = before - detail::kinetic_energy(start, start.velocity, start.spin);
        course->velocity_after = body.velocity;
        course->spin_after = body.spin;
        course->asleep_after = body.asleep;
    }
    undo_releases();
    book_lists(dt);
    end_watch();
    last_ = now;
    ledger_.update(last_);
}

DUCTILE_INLINE void EnergyMeter::book_lists(double dt) {
    for (const MeteredBody& body : bodies_) {
        const Course* course = course_of(body.body);
        if (course != nullptr) book_body(*course, body, dt);
    }
    joints_.clear();
    list_joints(joints_);
    contacts_.clear();
    list_contacts(dt, contacts_);
    find_islands();
    for (const MeteredJoint& joint : joints_) book_joint(joint, dt);
    for (MeteredContact& contact : contacts_) book_contact(contact);
    ledger_.set_brought_in(pairs_.brought_in());
}

// ---- a step of some of the bodies

DUCTILE_INLINE void EnergyMeter::swap_record() noexcept {
    std::swap(course_numbers_, record_.course_numbers);
    std::swap(plastic_numbers_, record_.plastic_numbers);
    courses_.swap(record_.courses);
    plastic_start_.swap(record_.plastic_start);
    pairs_.swap_step(record_.pairs);
}

DUCTILE_INLINE void EnergyMeter::keep_step(double dt) {
    swap_record();
    record_.dt = dt;
}

DUCTILE_INLINE void EnergyMeter::narrow(bool all, bool begins) {
    outside_ = {};
    narrow_ = !all && !begins;
    if (all) return;
    const HeldEnergy<double> listed = held();
    outside_ = {last_.kinetic - listed.kinetic, last_.potential - listed.potential,
                last_.elastic - listed.elastic};
}

DUCTILE_INLINE void EnergyMeter::take_back() {
    (void)held(); // lists them
    swap_record();
    sign_ = -1;
    for (const MeteredBody& body : bodies_) {
        if (const Course* course = course_of(body.body)) {
            add(Account::integration, course->ahead);
        }
    }
    book_lists(record_.dt);
    sign_ = 1;
    swap_record();
}

DUCTILE_INLINE void EnergyMeter::moved_back() {
    last_ = held();
    ledger_.update(last_);
}

DUCTILE_INLINE EnergyMeter::Course* EnergyMeter::course_of(const void* body) {
    const std::size_t number = course_numbers_.find(body);
    return number != AddressBook::unknown ? &courses_[number] : nullptr;
}

DUCTILE_INLINE void EnergyMeter::find_islands() {
    island_.resize(courses_.size());
    std::iota(island_.begin(), island_.end(), std::size_t(0));
    const auto join = [this](const void* a, const void* b) {
        const std::size_t of_a = course_numbers_.find(a), of_b = course_numbers_.find(b);
        constexpr std::size_t unknown = AddressBook::unknown;
        if (of_a != unknown && of_b != unknown) island_[island_of(of_a)] = island_of(of_b);
    };
    for (const MeteredJoint& joint : joints_) join(joint.a, joint.b);
    for (const MeteredContact& contact : contacts_) join(contact.a, contact.b);
    for (const auto& [joint, a, b] : plastic_) join(a, b);
    plastic_island_.assign(courses_.size(), 0);
    for (const auto& [joint, a, b] : plastic_) {
        for (const void* body : {a, b}) {
            const std::size_t course = course_numbers_.find(body);
            if (course != AddressBook::unknown) plastic_island_[island_of(course)] = 1;
        }
    }
}

DUCTILE_INLINE std::size_t EnergyMeter::island_of(std::size_t course) {
    for (; island_[course] != course; course = island_[course]) {
        island_[course] = island_[island_[course]];
    }
    return course;
}

DUCTILE_INLINE bool EnergyMeter::is_plastic(const void* body) {
    const std::size_t course = course_numbers_.find(body);
    return course != AddressBook::unknown && plastic_island_[island_of(course)] != 0;
}

DUCTILE_INLINE const EnergyMeter::PlasticStart* EnergyMeter::start_of(
    const PairQueries* joint) const {
    const std::size_t number = plastic_numbers_.find(joint);
    return number != AddressBook::unknown ? &plastic_start_[number] : nullptr;
}

DUCTILE_INLINE double EnergyMeter::taken_by_address(const void* joint) const {
    const std::size_t number = taken_numbers_.find(joint);
    return number != AddressBook::unknown ? taken_[number] : 0;
}

DUCTILE_INLINE void EnergyMeter::take_back(const void* body, const VelocityChange<double>& change) {
    if (Course* course = course_of(body)) {
        course->velocity_after = difference(course->velocity_after, change.linear);
        course->spin_after = difference(course->spin_after, change.angular);
    }
}

/// A break's release acted after the solve; the rows' work wants the velocities before it.
DUCTILE_INLINE void EnergyMeter::undo_releases() {
    for (const auto& [joint, a, b] : plastic_) {
        const PlasticStart* start = start_of(joint);
        const BreakRelease<double>& release = joint->release();
        if (start == nullptr || release.energy == start->released) continue;
        take_back(a, release.a);
        take_back(b, release.b);
    }
}

DUCTILE_INLINE void EnergyMeter::book_body(const Course& course, const MeteredBody& now,
                                           double dt) {
    const MeteredBody& start = course.start;
    if (course.asleep_after) { // also one that a user put to sleep while it moved
        add(Account::sleep, course.damped +
                                detail::kinetic_energy(start, start.velocity, start.spin) -
                                detail::kinetic_energy(now, now.velocity, now.spin));
        return;
    }
    const Vector3<double> velocities = sum(start.velocity, course.velocity_after);
    const Vector3<double> spins = sum(start.spin, course.spin_after);
    ledger_.supply(sign_ * dt * (dot(start.force, velocities) + dot(start.torque, spins)) / 2);

    const Vector3<double> moved = difference(now.position, start.position);
    const double potential = dot(now.weight, moved) - dt * dot(now.weight, velocities) / 2;
    const Vector3<double>& w = course.spin_after;
    const double turning = (dot(w, times(start.inertia, w)) - dot(w, times(now.inertia, w))) / 2;
    const Vector3<double> turned = wobbles(start.inertia, start.spin)
                                       ? gyroscopic_impulse(start, dt)
                                       : Vector3<double>(0, 0, 0);
    const double gyroscopic = -dot(sum(turned, course.gyroscopic), spins) / 2;
    add(Account::integration, course.damped + potential + turning + gyroscopic);
}

/// Work that a force and a torque about the centre of mass do on a body over the step [J].
DUCTILE_INLINE double EnergyMeter::work(const void* body, const Vector3<double>& force,
                                        const Vector3<double>& torque, double dt) {
    const Course* course = course_of(body);
    // an engine leaves what it told of a sleeping body's joint as it was
    if (course == nullptr || course->asleep_after) return 0;
    const Vector3<double> velocities = sum(course->start.velocity, course->velocity_after);
    const Vector3<double> spins = sum(course->start.spin, course->spin_after);
    return dt / 2 * (dot(force, velocities) + dot(torque, spins));
}

DUCTILE_INLINE void EnergyMeter::book_joint(const MeteredJoint& joint, double dt) {
    const double taken = -work(joint.a, joint.force_a, joint.torque_a, dt) -
                         work(joint.b, joint.force_b, joint.torque_b, dt);
    double named = 0;
    if (const PlasticStart* before = start_of(joint.plastic)) {
        const double flow = joint.plastic->absorbed_energy() - before->absorbed;
        const double damped = joint.plastic->damped_energy() - before->damped;
        add(Account::plastic, flow);
        add(Account::damping, damped);
        // what a break released was taken by the row and given back after the solve; what was
        // stored then is set free inside the part
        named = flow + damped + joint.plastic->stored_energy() - before->stored +
                joint.plastic->release().energy - before->released;
    }
    add(Account::joints, taken - named);
    constexpr double instant = 1e-7; // what it takes in a blow it has no right to give back
    if (joint.driven) {
        // who drives it pays
    } else if (joint.plastic != nullptr) {
        step_plastic_ += taken - named;
    } else if (dt > instant) {
        const double own = work(joint.b, joint.own_force, joint.own_torque_b, dt) -
                           work(joint.a, joint.own_force, joint.own_torque_a, dt);
        const bool plastic = is_plastic(joint.a) || is_plastic(joint.b);
        const void* account = joint.account != nullptr ? joint.account : joint.joint;
        book_pair({account, nullptr}, plastic, joint.powered ? taken - own : taken);
        if (plastic) step_others_ += taken - own;
    }
    const std::size_t number = taken_numbers_.enter(joint.joint);
    if (number == taken_.size()) taken_.push_back(0);
    taken_[number] += sign_ * taken;
}

DUCTILE_INLINE void EnergyMeter::book_contact(MeteredContact& contact) {
    const Vector3<double> twice = difference(velocity_sum(contact.a, contact.point_a),
                                             velocity_sum(contact.b, contact.point_b));
    const double taken = -dot(contact.normal, twice) / 2;
    contact.taken = taken - dot(contact.normal, contact.driven_velocity);
    add(Account::contact, taken);
    add(Account::friction, -dot(contact.tangential, twice) / 2);
    if (contact.driven) return;
    PairAccounts::Pair pair{contact.a, contact.b};
    bool plastic = is_plastic(contact.a) || is_plastic(contact.b);
    for (const void** body : {&pair.first, &pair.second}) {
        const void* owner = contact.gives && owner_of_ ? owner_of_(*body) : nullptr;
        if (owner == nullptr) continue;
        *body = owner;
        plastic = true;
    }
    // engines have the two in any order, and another one of another piece
    if (std::less<const void*>()(pair.second, pair.first)) std::swap(pair.first, pair.second);
    book_pair(pair, plastic, contact.taken);
}

DUCTILE_INLINE void EnergyMeter::book_pair(const PairAccounts::Pair& pair, bool plastic,
                                           double taken) {
    if (sign_ < 0 && plastic) {
        pairs_.take_back(pair);
    } else { // one account for all that no plastic joint holds
        pairs_.book(plastic ? pair : PairAccounts::Pair(), sign_ * taken);
    }
}

DUCTILE_INLINE double EnergyMeter::step_of_contacts(
    const std::function<bool(const void*)>& counts) const {
    double sum = 0;
    for (const MeteredContact& contact : contacts_) {
        if (contact.gives) continue;
        if (counts(contact.a) || counts(contact.b)) sum += contact.taken;
    }
    return sum;
}

DUCTILE_INLINE Vector3<double> EnergyMeter::velocity_sum(const void* body,
                                                         const Vector3<double>& point) {
    const Course* course = course_of(body);
    // an engine leaves what it told of a sleeping body's contacts as it was, too
    if (course == nullptr || course->asleep_after) return Vector3<double>::Zero();
    const Vector3<double> arm = difference(point, course->start.position);
    const Vector3<double> spins = sum(course->start.spin, course->spin_after);
    const Vector3<double> velocities = sum(course->start.velocity, course->velocity_after);
    return sum(velocities, cross(spins, arm));
}

} // namespace ductile
