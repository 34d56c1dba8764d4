// SPDX-License-Identifier: MIT
//
// Bodies of members.hpp.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "ductile/bullet/contact_load.hpp"
#include "ductile/bullet/members.hpp"
#include "ductile/bullet/moving_bodies.hpp"
#include "ductile/bullet/plastic_constraint.hpp"
#include "ductile/bullet/soft_contacts.hpp"

namespace ductile::bullet {

DUCTILE_INLINE void Members::add(Course course) {
    members_.push_back(std::move(course));
    look_at_all_ = true;
    note_bodies(members_.size() - 1);
}
DUCTILE_INLINE std::vector<std::string> Members::add(Member& member, std::function<void()> ends) {
    member.enter(world_);
    member.ends_ = std::move(ends);
    member.pushed_ = [this, &member] { pushed_.push_back(&member); };
    if (!member.forces_.empty()) pushed_.push_back(&member);
    member.rearranged_ = [this, &member] { rearranged(member); };
    add({.of = &member, .member = &member});
    return member.remarks();
}
DUCTILE_INLINE void Members::add(Divisible& structure) {
    add({.of = &structure, .member = nullptr});
}

/// The last one takes its place.
DUCTILE_INLINE void Members::remove(std::size_t i) {
    forget(*members_[i].of);
    here_.clear();
    closed_work_.reset();
    idle_work_.reset();
    unmissed_work_.reset();
    for (Course& course : members_) course.here = false;
    const std::size_t last = members_.size() - 1;
    for (const std::size_t leaves : {i, last}) {
        Course& course = members_[leaves];
        for (const btCollisionObject* body : course.bodies) owners_.erase(body);
        course.bodies.clear();
        if (std::exchange(course.watched, false)) std::erase(watched_, leaves);
    }
    if (i != last) members_[i] = std::move(members_[last]);
    members_.pop_back();
    if (i != last) note_bodies(i);
}
DUCTILE_INLINE void Members::remove(Member& member) {
    for (std::size_t i = 0; i < members_.size(); ++i) {
        if (members_[i].member != &member) continue;
        remove(i);
        break;
    }
    const Divisible* const key = &member;
    std::erase_if(idle_changes_, [key](const auto& entry) { return entry.first == key; });
    std::erase(pushed_, &member);
    member.leave();
}
DUCTILE_INLINE void Members::remove(Divisible& structure) {
    for (std::size_t i = 0; i < members_.size(); ++i) {
        if (members_[i].of != &structure) continue;
        remove(i);
        break;
    }
}

DUCTILE_INLINE void Members::rearranged(const Divisible& structure) {
    look_at_all_ = true;
    for (std::size_t i = 0; i < members_.size(); ++i) {
        if (members_[i].of != &structure) continue;
        members_[i].direct = Course::at_once; // whatever went before
        note_bodies(i);
    }
}
DUCTILE_INLINE void Members::note_bodies(std::size_t i) {
    Course& course = members_[i];
    closed_work_.reset();
    idle_work_.reset();
    unmissed_work_.reset();
    for (const btCollisionObject* body : course.bodies) owners_.erase(body);
    course.bodies.clear();
    for (const PieceBody& piece : course.of->all_pieces()) {
        if (piece.body == &btTypedConstraint::getFixedBody()) continue;
        course.bodies.push_back(piece.body);
        owners_[piece.body] = i;
    }
    const bool quiet = course.of->whole() && !course.of->doubts(); // what it reports stays
    if (course.member != nullptr && std::exchange(course.asked, !quiet) == quiet) {
        idle_changes_.emplace_back(course.of, quiet);
    }
    const bool watched = !course.of->idle() || course.direct > 0;
    if (std::exchange(course.watched, watched) == watched) return;
    if (watched) {
        watched_.push_back(i);
    } else {
        std::erase(watched_, i);
    }
}

DUCTILE_INLINE bool Members::has(const Member& member) const noexcept {
    return std::any_of(members_.begin(), members_.end(),
                       [&](const Course& course) { return course.member == &member; });
}

DUCTILE_INLINE std::vector<int> Members::held_islands() const {
    std::vector<int> islands;
    over_holds([&islands](const Attachment& hold) {
        islands.push_back(hold.constraint->getRigidBodyA().getIslandTag());
        islands.push_back(hold.constraint->getRigidBodyB().getIslandTag());
    });
    std::sort(islands.begin(), islands.end());
    return islands;
}

DUCTILE_INLINE const void* Members::key_of(const PlasticConstraint& joint, int& section) const {
    for (const btRigidBody* body : {&joint.getRigidBodyA(), &joint.getRigidBodyB()}) {
        const auto owner = owners_.find(body);
        if (owner == owners_.end()) continue;
        if (const void* key = key_in(members_[owner->second], joint, section)) return key;
    }
    return nullptr;
}

DUCTILE_INLINE double Members::closed_work() const {
    if (!closed_work_) closed_work_ = DivisibleList::closed_work();
    return *closed_work_;
}
DUCTILE_INLINE double Members::idle_work() const {
    if (!idle_work_) idle_work_ = DivisibleList::idle_work();
    return *idle_work_;
}
DUCTILE_INLINE double Members::unmissed_work() const {
    if (!unmissed_work_) unmissed_work_ = DivisibleList::unmissed_work();
    return *unmissed_work_;
}

DUCTILE_INLINE void Members::apply_forces() {
    for (const std::size_t i : watched_) { // structures are
        if (members_[i].member == nullptr) members_[i].of->apply_forces();
    }
    for (Member* member : pushed_)
        members_[owners_[member->pieces_.back().body]].of->apply_forces();
}
DUCTILE_INLINE void Members::drop_forces() {
    for (const std::size_t i : watched_) {
        if (members_[i].member == nullptr) members_[i].of->drop_forces();
    }
    for (Member* member : pushed_) members_[owners_[member->pieces_.back().body]].of->drop_forces();
    pushed_.clear();
}

// ---- before the solve

DUCTILE_INLINE auto Members::course_of(const btCollisionObject& object) -> Course* {
    const auto found = owners_.find(&object);
    return found != owners_.end() ? &members_[found->second] : nullptr;
}

DUCTILE_INLINE void Members::list(Course& course) {
    if (course.here) return;
    course.here = true;
    course.left = 0;
    here_.push_back(&course);
    course.of->begin();
}

DUCTILE_INLINE void Members::before_solve() {
    if (members_.empty()) return;
    forget_doubts();
    before_.resize(std::size_t(world_.getNumCollisionObjects()));
    for (const btRigidBody* body : bodies_of(world_, scope_)) {
        before_[std::size_t(body->getWorldArrayIndex())] = {body->getCenterOfMassTransform(),
                                                            body->getLinearVelocity(),
                                                            body->getAngularVelocity()};
    }
    for (Course* course : here_) course->here = false;
    here_.clear();
    if (world_.getGravity() != gravity_) look_at_all_ = true;
    gravity_ = world_.getGravity();
    if (look_at_all_) {
        for (Course& course : members_) list(course);
    }
    for (const std::size_t i : watched_) list(members_[i]);
    for (const Member* member : pushed_) list(members_[owners_[member->pieces_.back().body]]);
    direct_.any = false;
    for (Course* course : here_) course->of->require_possible();
    if (world_.getNumCollisionObjects() != objects_) { // somebody may have taken one out
        for (Course& course : members_) course.of->require_possible();
        objects_ = world_.getNumCollisionObjects();
    }
    if (!driven_.empty()) see_driven();
    for (const Course* course : here_) {
        if (course->direct == 0) continue;
        if (!direct_.any) direct_.by_place.assign(before_.size(), 0);
        direct_.any = true;
        for (const PieceBody& piece : course->of->all_pieces()) {
            const int place = piece.body->getWorldArrayIndex();
            if (place >= 0) direct_.by_place[std::size_t(place)] = 1;
        }
    }
}

// ---- after it

DUCTILE_INLINE double Members::noticed_impulse(const Course& course, double dt) {
    constexpr double noticed = 0.1; // of the strength, at an arm of its length
    if (course.member == nullptr) return 0;
    const MemberCourse& of = course.member->course_;
    return noticed * of.least_strength() * dt / of.member().length();
}

DUCTILE_INLINE void Members::read_sums(double dt, bool blow) {
    for (const btPersistentManifold* each : manifolds_of(*world_.getDispatcher(), scope_)) {
        const btPersistentManifold& manifold = *each;
        if (manifold.getNumContacts() == 0) continue;
        const btCollisionObject &a = *manifold.getBody0(), &b = *manifold.getBody1();
        Course *of_a = course_of(a), *of_b = course_of(b);
        if (of_a == nullptr && of_b == nullptr) continue;
        // what sleeps was not solved
        const bool solved = (a.isActive() && !a.isStaticOrKinematicObject()) ||
                            (b.isActive() && !b.isStaticOrKinematicObject());
        if (!solved && blow) continue;
        double sum = 0;
        bool gives = false;
        for (int k = 0; k < manifold.getNumContacts(); ++k) {
            const btManifoldPoint& point = manifold.getContactPoint(k);
            gives = gives || gives_way(point);
            sum += std::abs(double(point.m_appliedImpulse)) +
                   std::abs(double(point.m_appliedImpulseLateral1)) +
                   std::abs(double(point.m_appliedImpulseLateral2));
        }
        if (!(sum > 0)) continue;
        for (const bool side_a : {true, false}) {
            Course* course = side_a ? of_a : of_b;
            if (course == nullptr) continue;
            const bool clamped = (side_a ? a : b).isStaticObject();
            if (!solved) {
                if (clamped) asleep_.push_back({course, {&manifold, side_a, true, 0}, sum});
                continue;
            }
            list(*course);
            course->of->touch({&manifold, side_a}, sum);
            if (!blow && ahead_ && course->direct == 0 && gives) {
                course->left = std::numeric_limits<double>::infinity(); // Bullet's own spring
            } else if (!blow && course->direct == 0 && course->member != nullptr) {
                course->left += detail::left_by_sweeps(manifold, dt, noticed_impulse(*course, dt),
                                                       2 * course->member->description().length());
            }
            if (clamped && !blow) acted_[&manifold] = dt;
        }
    }
    for (auto& [course, touch, sum] : asleep_) { // carries on as when it was solved
        const auto acted = acted_.find(touch.manifold);
        if (!course->here || acted == acted_.end()) continue;
        touch.share = dt / acted->second;
        course->of->touch(touch, touch.share * sum);
    }
    asleep_.clear();
    for (Course* course : here_) course->of->sum_up(dt);
}

DUCTILE_INLINE bool Members::is_decided(Course& course) {
    const bool was_direct = course.direct > 0 || !course.of->whole();
    course.direct = Course::at_once;
    note_bodies(std::size_t(&course - members_.data()));
    return was_direct;
}

DUCTILE_INLINE bool Members::look(double dt) {
    if (members_.empty()) return false;
    read_sums(dt, false);
    const btVector3 gravity = world_.getGravity();
    bool any = false;
    share_ = 0;
    for (Course* course : here_) {
        course->found.clear();
        const bool vain = course->left > 0 && course->left > noticed_impulse(*course, dt);
        const double share = course->of->most_share(dt, before_, gravity);
        share_ = std::max(share_, std::min(share, 1.0));
        if (!vain && !(share > 1)) {
            if (course->direct > 0 && --course->direct == 0) {
                note_bodies(std::size_t(course - members_.data()));
            }
            continue;
        }
        course->of->find_beyond(dt, before_, gravity, course->found);
        note_doubts(*course);
        if (course->found.empty() && !vain && (course->direct > 0 || !course->of->is_held()))
            continue;
        any = true;
        if (!is_decided(*course)) course->found.clear();
    }
    if (!any) look_at_all_ = false;
    return any;
}

DUCTILE_INLINE void Members::begin_blow(std::span<const btRigidBody* const> closing, bool thrown,
                                        double noticed) {
    for (Course& course : members_) {
        course.of->begin_blow(noticed);
        if (thrown && course.of->is_held()) (void)is_decided(course);
    }
    const auto solve_at_once = [this](const btCollisionObject& object) {
        if (Course* course = course_of(object)) (void)is_decided(*course);
    };
    const auto closes = [closing](const btCollisionObject* object) {
        return std::find(closing.begin(), closing.end(), object) != closing.end();
    };
    for (const btRigidBody* body : closing) solve_at_once(*body);
    for (const btPersistentManifold* manifold : manifolds_of(*world_.getDispatcher(), scope_)) {
        if (manifold->getNumContacts() == 0) continue;
        if (closes(manifold->getBody0())) solve_at_once(*manifold->getBody1());
        if (closes(manifold->getBody1())) solve_at_once(*manifold->getBody0());
    }
}

DUCTILE_INLINE bool Members::look_blow(double dt) {
    if (members_.empty()) return false;
    read_sums(dt, true);
    const btVector3 gravity = world_.getGravity();
    bool any = false;
    for (Course* course : here_) {
        course->found.clear();
        if (!course->of->touched()) continue;
        course->of->find_struck(dt, before_, gravity, course->found);
        note_doubts(*course);
        if (course->found.empty()) continue;
        any = true;
        if (!is_decided(*course)) course->found.clear();
    }
    return any;
}

/// They themselves brought and took bodies, and nobody else since there were `before` in the world.
DUCTILE_INLINE void Members::count_own(int before) {
    if (objects_ == before) objects_ = world_.getNumCollisionObjects();
}

DUCTILE_INLINE void Members::open_found() {
    const int before = world_.getNumCollisionObjects();
    for (Course* course : here_) {
        if (course->found.empty()) continue;
        course->of->open(course->found, ahead_);
        happened(*course, std::exchange(course->found, {}), EventKind::split);
        note_bodies(std::size_t(course - members_.data()));
    }
    count_own(before);
}

DUCTILE_INLINE double Members::count_vibration() const {
    double sum = 0;
    for (const Course* course : here_) sum += course->of->count_vibration();
    return sum;
}

DUCTILE_INLINE bool Members::close_held(Closing when) {
    bool changed = false;
    const int before = world_.getNumCollisionObjects();
    for (Course* course : here_) {
        const std::vector<int> closed = course->of->close_held(when, ahead_);
        if (closed.empty()) continue;
        changed = true;
        happened(*course, closed, EventKind::fused);
        note_bodies(std::size_t(course - members_.data()));
    }
    count_own(before);
    return changed;
}

DUCTILE_INLINE void Members::tell_idle(const TellIdle& tell) {
    for (const auto& [key, idle] : std::exchange(idle_changes_, {})) tell(key, idle);
}

} // namespace ductile::bullet

#include "ductile/bullet/world_members.ipp" // IWYU pragma: keep
