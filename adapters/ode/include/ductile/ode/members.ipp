// SPDX-License-Identifier: MIT
//
// Bodies of members.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "ductile/ode/closing_contacts.hpp"
#include "ductile/ode/convert.hpp"
#include "ductile/ode/energy_meter.hpp"
#include "ductile/ode/half_ahead.hpp"
#include "ductile/ode/members.hpp"
#include "ductile/ode/world_snapshot.hpp"

namespace ductile::ode {

// ---- who is here

DUCTILE_INLINE void Members::add(Divisible& member) {
    members_.push_back({&member});
    note_bodies();
}
DUCTILE_INLINE void Members::remove(Divisible& member) {
    std::erase_if(members_, [&](const Course& course) { return course.of == &member; });
    forget(member);
    note_bodies();
}
DUCTILE_INLINE void Members::leave() {
    for (const Course& course : std::exchange(members_, {})) course.of->leave();
    note_bodies();
}

DUCTILE_INLINE void Members::note_bodies() {
    bodies_.clear();
    owners_.clear();
    for (std::size_t i = 0; i < members_.size(); ++i) {
        members_[i].bodies = members_[i].of->bodies();
        for (dBodyID body : members_[i].bodies) {
            bodies_.push_back(body);
            owners_[body] = i;
        }
    }
}
DUCTILE_INLINE void Members::body_left(dBodyID body) {
    for (const Course& course : members_) course.of->body_left(body);
}
DUCTILE_INLINE void Members::body_came(dBodyID body) {
    for (const Course& course : members_) course.of->body_came(body);
}

DUCTILE_INLINE const void* Members::key_of(const PlasticConstraint& joint, int& section) const {
    const AttachedBodies bodies = joint.bodies();
    for (dBodyID body : {bodies.a, bodies.b}) {
        const std::size_t* owner = owners_.find(body);
        if (owner == nullptr) continue;
        if (const void* key = key_in(members_[*owner], joint, section)) return key;
    }
    return nullptr;
}
DUCTILE_INLINE bool Members::hang_together(dBodyID a, dBodyID b) const {
    if (members_.empty() || a == nullptr || b == nullptr) return false;
    const std::size_t *of_a = owners_.find(a), *of_b = owners_.find(b);
    return of_a != nullptr && of_b != nullptr && *of_a == *of_b &&
           members_[*of_a].of->hangs_together(a, b);
}
DUCTILE_INLINE bool Members::hold(dBodyID a, dBodyID b) const {
    const auto holds = [this](dBodyID own, dBodyID other) {
        const std::size_t* of = owners_.find(own);
        return of != nullptr && members_[*of].of->holds(own, other);
    };
    return a != nullptr && b != nullptr && (holds(a, b) || holds(b, a));
}
DUCTILE_INLINE void Members::require_possible() const {
    for (const Course& course : members_) course.of->require_possible();
}

// ---- around the solve

DUCTILE_INLINE void Members::apply_forces() {
    for (const Course& course : members_) course.of->apply_forces();
}
DUCTILE_INLINE void Members::drop_forces() {
    for (const Course& course : members_) course.of->drop_forces();
}

DUCTILE_INLINE const dJointFeedback* Members::feedback_of(dJointID joint) {
    if (const dJointFeedback* has = dJointGetFeedback(joint)) return has;
    borrowers_.push_back(joint);
    dJointSetFeedback(joint, &lent_.emplace_back());
    return &lent_.back();
}
DUCTILE_INLINE void Members::take_feedback_back() {
    for (dJointID joint : std::exchange(borrowers_, {})) dJointSetFeedback(joint, nullptr);
}

DUCTILE_INLINE void Members::see_ahead(std::span<const NamedContact> contacts) {
    list_contacts(contacts);
    for (const Course& course : members_) {
        if (is_passed(course)) passed_.push_back(&course);
    }
}

namespace detail {

[[nodiscard]] DUCTILE_INLINE std::vector<MovingGeom> geoms_of(dBodyID body) {
    std::vector<MovingGeom> geoms;
    for (dGeomID geom = dBodyGetFirstGeom(body); geom != nullptr; geom = dBodyGetNextGeom(geom)) {
        geoms.emplace_back(geom);
    }
    return geoms;
}

/// Whether the two overlap on the way of the first one's body in `dt` [s], its ends left out.
[[nodiscard]] DUCTILE_INLINE bool meets_on_way(const MovingGeom& driven, const MovingGeom& stands,
                                               double dt) {
    constexpr double of_both = 0.4, most = 1000;
    const double way = driven.speed() * dt;
    const double looks =
        std::min(std::ceil(way / (of_both * (driven.thickness + stands.thickness))), most);
    if (looks < 2 || !driven.may_reach(stands, way) || !driven.may_touch(stands)) return false;
    const std::span<const dBodyID> body(&driven.body, 1);
    WorldSnapshot from;
    from.take(body, {});
    HalfAhead ahead;
    bool met = false;
    for (double i = 1; i < looks && !met; ++i) {
        (void)ahead.move(body, dt * i / looks);
        dContactGeom contact;
        met = dCollide(driven.geom, stands.geom, 1, &contact, int(sizeof contact)) > 0;
        from.put_poses_back();
    }
    return met;
}

} // namespace detail

DUCTILE_INLINE void Members::see_along(std::span<const dBodyID> bodies, double dt) {
    for (dBodyID body : bodies) {
        if (dBodyIsKinematic(body) == 0 || owners_.find(body) != nullptr) continue;
        for (const detail::MovingGeom& driven : detail::geoms_of(body)) {
            for (const Course& course : members_) {
                for (dBodyID own : course.bodies) {
                    if (can_move(own)) continue;
                    for (const detail::MovingGeom& stands : detail::geoms_of(own)) {
                        if (detail::meets_on_way(driven, stands, dt)) passed_.push_back(&course);
                    }
                }
            }
        }
    }
}

DUCTILE_INLINE void Members::before_solve(std::span<const NamedContact> contacts) {
    if (members_.empty()) return;
    list_contacts(contacts);
    for (const Course& course : members_) require_named(course);
    held_by_.clear();
    for (const Course& course : members_) {
        course.of->before_solve(held_by_);
        const bool ahead = std::find(passed_.begin(), passed_.end(), &course) != passed_.end();
        if (ahead || is_passed(course)) course.of->driven_through();
    }
    // of a step that was not looked at joints kept what is another's now; its contacts may be gone
    passed_.clear();
    for (dJointID joint : held_by_) {
        const bool kept =
            std::find(borrowers_.begin(), borrowers_.end(), joint) != borrowers_.end();
        if (kept) dJointSetFeedback(joint, nullptr);
    }
    borrowers_.clear();
    lent_.clear(); // not sooner: the ledger reads it when the step stands
    for (dJointID joint : held_by_) static_cast<void>(feedback_of(joint));
    for (Course& course : members_) {
        for (Touch& touch : course.touches) touch.feedback = feedback_of(touch.joint);
    }
}
DUCTILE_INLINE void Members::list_contacts(std::span<const NamedContact> contacts) {
    for (Course& course : members_) course.touches.clear();
    for (const NamedContact& named : contacts) {
        if (dJointIsEnabled(named.joint) == 0) continue;
        const AttachedBodies bodies = attached_bodies(named.joint);
        for (const bool of_a : {true, false}) {
            const std::size_t* owner = owners_.find(of_a ? bodies.a : bodies.b);
            if (owner == nullptr) continue;
            Touch touch{named.joint, bodies, of_a, to_core(named.contact.geom.pos),
                        scaled(bodies.reversed ? -1 : 1, to_core(named.contact.geom.normal))};
            touch.closing = touch.closing_speed();
            members_[*owner].touches.push_back(touch);
        }
    }
}
DUCTILE_INLINE void Members::require_named(const Course& course) {
    std::size_t contacts = 0;
    for (dBodyID body : course.bodies) {
        for (int i = 0, count = dBodyGetNumJoints(body); i < count; ++i) {
            const dJointID joint = dBodyGetJoint(body, i);
            contacts += dJointGetType(joint) == dJointTypeContact && dJointIsEnabled(joint) != 0;
        }
    }
    if (contacts == course.touches.size()) return;
    throw std::logic_error(
        "World.step: a contact of a member was not named: World::add_contact each, once");
}

DUCTILE_INLINE bool Members::is_passed(const Course& course) {
    constexpr double noticed = 1e-6; // [m/s]
    return std::any_of(course.touches.begin(), course.touches.end(), [](const Touch& touch) {
        return !can_move(touch.bodies.a) && !can_move(touch.bodies.b) && touch.closing > noticed;
    });
}

DUCTILE_INLINE std::vector<dBodyID> Members::touched() const {
    std::vector<dBodyID> found;
    for (const Course& course : members_) {
        for (const Touch& touch : course.touches) {
            for (dBodyID body : {touch.bodies.a, touch.bodies.b}) {
                if (can_move(body)) found.push_back(body);
            }
        }
    }
    return found;
}

DUCTILE_INLINE void Members::after_solve() const {
    for (const Course& course : members_) course.of->after_solve();
}

// ---- after it

DUCTILE_INLINE void Members::begin_blow(double noticed) const {
    for (const Course& course : members_) course.of->begin_blow(noticed);
}
DUCTILE_INLINE bool Members::look(double dt, bool blow) {
    bool any = false;
    share_ = 0;
    for (Course& course : members_) {
        course.found.clear();
        if (blow) {
            course.of->find_struck(dt, course.touches, course.found);
        } else {
            course.of->find_beyond(dt, course.touches, course.found);
            share_ = std::max(share_, std::min(course.of->most_share(), 1.0));
        }
        any = any || !course.found.empty();
    }
    take_feedback_back();
    return any;
}

DUCTILE_INLINE void Members::open_found(bool ahead) {
    struct Attached {
        dBodyID a, b; ///< as the user attached them
    };
    for (Course& course : members_) {
        if (course.found.empty()) continue;
        std::vector<Attached> attached;
        for (const Touch& touch : course.touches) {
            attached.push_back({dJointGetBody(touch.joint, 0), dJointGetBody(touch.joint, 1)});
        }
        course.of->open(course.found, ahead);
        // one between two of its pieces comes twice, one after the other
        for (std::size_t i = 0, next = 0; i < attached.size(); i = next) {
            const dJointID joint = course.touches[i].joint;
            for (; next < attached.size() && course.touches[next].joint == joint; ++next) {
                const Touch& touch = course.touches[next];
                const bool first = touch.of_a != touch.bodies.reversed;
                (first ? attached[i].a : attached[i].b) = course.of->body_of(touch.segment);
            }
            dJointAttach(joint, attached[i].a, attached[i].b);
            wake(joint);
        }
        happened(course, std::exchange(course.found, {}), EventKind::split);
    }
    note_bodies();
}

DUCTILE_INLINE double Members::count_vibration() const {
    double sum = 0;
    for (const Course& course : members_) sum += course.of->count_vibration();
    return sum;
}

DUCTILE_INLINE bool Members::close_held(Closing when, bool ahead) {
    bool changed = false;
    for (const Course& course : members_) {
        const std::vector<int> closed = course.of->close_held(when, ahead);
        changed = changed || !closed.empty();
        happened(course, closed, EventKind::fused);
    }
    if (changed) note_bodies();
    return changed;
}

} // namespace ductile::ode

#include "ductile/ode/world_members.ipp" // IWYU pragma: keep
