// SPDX-License-Identifier: MIT
//
// Bodies of members.hpp.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "ductile/bullet/convert.hpp"
#include "ductile/bullet/members.hpp"

namespace ductile::bullet {

DUCTILE_INLINE void Members::add(Member& member, std::function<void()> ends) {
    member.enter(world_);
    member.ends_ = std::move(ends);
    members_.push_back({.tick = MemberTick(member), .found = {}});
}

DUCTILE_INLINE void Members::remove(Member& member) {
    std::erase_if(members_, [&](const Course& course) { return &course.tick.member() == &member; });
    std::erase_if(happened_, [&](const Happened& entry) { return entry.member == &member; });
    member.leave();
}

DUCTILE_INLINE bool Members::has(const Member& member) const noexcept {
    return std::any_of(members_.begin(), members_.end(),
                       [&](const Course& course) { return &course.tick.member() == &member; });
}

DUCTILE_INLINE const Member* Members::owner(const PlasticConstraint& joint, int& section) const {
    for (const Course& course : members_) {
        for (const Member::OpenSection& open : course.tick.member().joints_) {
            if (open.hinge.get() != &joint) continue;
            section = open.section;
            return &course.tick.member();
        }
    }
    return nullptr;
}

DUCTILE_INLINE double Members::closed_work() const {
    double sum = 0;
    for (const Course& course : members_) sum += course.tick.member().course_.closed_work();
    return sum;
}

DUCTILE_INLINE double Members::unmissed_work() const {
    double least = 0;
    for (const Course& course : members_) {
        const double work = course.tick.member().course_.unmissed_work();
        if (least == 0 || (work > 0 && work < least)) least = work;
    }
    return least;
}

DUCTILE_INLINE bool Members::is_member(const btCollisionObject& object) const {
    const int place = object.getWorldArrayIndex();
    return place >= 0 && place < int(number_.size()) && number_[std::size_t(place)] >= 0;
}

DUCTILE_INLINE void Members::apply_forces() {
    for (Course& course : members_) {
        for (const Member::Force& force : course.tick.member().forces_) {
            btRigidBody& body = course.tick.member().body_of(force.segment);
            if (body.isStaticObject()) continue;
            const btTransform pose = course.tick.member().pose(force.segment);
            body.applyForce(to_bullet(force.force),
                            pose * to_bullet(force.in_segment) - body.getCenterOfMassPosition());
        }
    }
}
DUCTILE_INLINE void Members::drop_forces() {
    for (Course& course : members_) course.tick.member().forces_.clear();
}

// ---- before the solve

DUCTILE_INLINE void Members::number_bodies() {
    const auto& objects = world_.getCollisionObjectArray();
    number_.assign(std::size_t(objects.size()), -1);
    for (std::size_t i = 0; i < members_.size(); ++i) {
        for (const PieceBody& piece : members_[i].tick.member().pieces_) {
            const int place = piece.body->getWorldArrayIndex();
            if (place < 0 || place >= objects.size() || objects[place] != piece.body) continue;
            number_[std::size_t(place)] = int(i);
        }
    }
}

DUCTILE_INLINE auto Members::course_of(const btCollisionObject& object) -> Course* {
    const int place = object.getWorldArrayIndex();
    if (place < 0 || place >= int(number_.size())) return nullptr;
    const int number = number_[std::size_t(place)];
    return number >= 0 ? &members_[std::size_t(number)] : nullptr;
}

DUCTILE_INLINE void Members::before_solve() {
    number_bodies();
    const auto& objects = world_.getCollisionObjectArray();
    before_.resize(std::size_t(objects.size()));
    for (int i = 0; i < objects.size(); ++i) {
        const btRigidBody* body = btRigidBody::upcast(objects[i]);
        if (body == nullptr) continue;
        before_[std::size_t(i)] = {body->getLinearVelocity(), body->getAngularVelocity()};
    }
    direct_.any = false;
    direct_.by_place.assign(std::size_t(objects.size()), 0);
    for (Course& course : members_) {
        const Member& member = course.tick.member();
        member.require_possible();
        if (course.direct > 0) {
            direct_.any = true;
            for (const btRigidBody* body : member.pieces()) {
                direct_.by_place[std::size_t(body->getWorldArrayIndex())] = 1;
            }
        }
        course.tick.begin();
    }
}

// ---- after it

DUCTILE_INLINE void Members::read_sums(double dt) {
    btDispatcher& dispatcher = *world_.getDispatcher();
    for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
        const btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(i);
        if (manifold.getNumContacts() == 0) continue;
        const btCollisionObject &a = *manifold.getBody0(), &b = *manifold.getBody1();
        Course *of_a = course_of(a), *of_b = course_of(b);
        if (of_a == nullptr && of_b == nullptr) continue;
        // what sleeps was not solved
        const bool solved = (a.isActive() && !a.isStaticOrKinematicObject()) ||
                            (b.isActive() && !b.isStaticOrKinematicObject());
        if (!solved) continue;
        double sum = 0;
        for (int k = 0; k < manifold.getNumContacts(); ++k) {
            const btManifoldPoint& point = manifold.getContactPoint(k);
            sum += std::abs(double(point.m_appliedImpulse)) +
                   std::abs(double(point.m_appliedImpulseLateral1)) +
                   std::abs(double(point.m_appliedImpulseLateral2));
        }
        if (!(sum > 0)) continue;
        for (const bool side_a : {true, false}) {
            Course* course = side_a ? of_a : of_b;
            if (course != nullptr) course->tick.touch(manifold, side_a, sum);
        }
    }
    for (Course& course : members_) course.tick.sum_up(dt);
}

DUCTILE_INLINE bool Members::is_decided(Course& course) {
    constexpr int ticks = 60;
    const bool was_direct = course.direct > 0 || !course.tick.member().whole();
    course.direct = ticks;
    return was_direct;
}

DUCTILE_INLINE bool Members::look(double dt) {
    if (members_.empty()) return false;
    read_sums(dt);
    const btVector3 gravity = world_.getGravity();
    bool any = false;
    for (Course& course : members_) {
        course.found.clear();
        if (!course.tick.may_be_beyond(dt, before_, gravity)) {
            course.direct = std::max(0, course.direct - 1);
            continue;
        }
        course.tick.read(dt, before_, gravity);
        course.found =
            course.tick.member().course_.beyond(course.tick.steps(), course.tick.loads(), dt);
        if (course.found.empty()) continue;
        any = true;
        if (!is_decided(course)) course.found.clear();
    }
    return any;
}

DUCTILE_INLINE void Members::begin_blow() {
    for (Course& course : members_) course.tick.member().course_.begin_blow();
}

DUCTILE_INLINE bool Members::look_blow(double dt) {
    if (members_.empty()) return false;
    read_sums(dt);
    const btVector3 gravity = world_.getGravity();
    bool any = false;
    for (Course& course : members_) {
        course.found.clear();
        if (!course.tick.touched()) continue;
        course.tick.read(dt, before_, gravity);
        if (!(course.tick.strike().energy > 0)) continue;
        const int section = course.tick.member().course_.struck(
            course.tick.steps(), course.tick.loads(), course.tick.strike());
        if (section == no_section) continue;
        any = true;
        if (is_decided(course)) course.found.push_back(section);
    }
    return any;
}

DUCTILE_INLINE void Members::open_found() {
    for (Course& course : members_) {
        if (course.found.empty()) continue;
        course.tick.member().open(course.found, share_);
        for (const int section : course.found) {
            happened_.push_back({&course.tick.member(), section, EventKind::split});
        }
        course.found.clear();
    }
}

DUCTILE_INLINE bool Members::close_held() {
    bool changed = false;
    for (Course& course : members_) {
        Member& member = course.tick.member();
        if (member.joints_.empty()) continue;
        member.note_sections();
        const std::vector<int> held = member.course_.held();
        if (held.empty()) continue;
        member.close(held, share_);
        for (const int section : held) {
            happened_.push_back({&member, section, EventKind::fused});
        }
        changed = true;
    }
    return changed;
}

DUCTILE_INLINE void Members::tell(const Tell& tell) {
    for (const Happened& entry : std::exchange(happened_, {})) {
        tell(*entry.member, entry.section, entry.kind);
    }
}

} // namespace ductile::bullet
