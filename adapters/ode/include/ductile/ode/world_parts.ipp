// SPDX-License-Identifier: MIT
//
// Bodies of world_parts.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "ductile/frame/part_settings.hpp"
#include "ductile/ode/convert.hpp"
#include "ductile/ode/world_parts.hpp"

namespace ductile::ode {

/// The world's settings of a part or a blow while this lives.
class WorldParts::Settings {
  public:
    Settings(dWorldID world, double h, bool blow)
        : world_(world),
          erp_(dWorldGetERP(world)),
          cfm_(dWorldGetCFM(world)),
          layer_(dWorldGetContactSurfaceLayer(world)) {
        dWorldSetERP(world, dReal(blow ? 0 : part_erp(double(erp_), h)));
        dWorldSetContactSurfaceLayer(world, std::max(layer_, dReal(closed_depth)));
        if (blow) dWorldSetCFM(world, cfm_ * dReal(blow_compliance(h)));
    }
    ~Settings() {
        dWorldSetERP(world_, erp_);
        dWorldSetCFM(world_, cfm_);
        dWorldSetContactSurfaceLayer(world_, layer_);
    }
    Settings(const Settings&) = delete;
    Settings& operator=(const Settings&) = delete;

  private:
    dWorldID world_;
    dReal erp_, cfm_, layer_;
};

// ---- a frame

DUCTILE_INLINE void WorldParts::begin(double length) {
    leave(); // a frame that was not ended
    length_ = length;
    time_ = 0;
    begin_driven();
    looked_ = false;
    forces_.hold(of_.bodies);
    asleep_.clear();
    for (dBodyID body : of_.bodies) {
        if (dBodyIsEnabled(body) == 0) asleep_.push_back(body);
    }
    drop_forces();
    begin_bodies();
    for (PlasticConstraint* joint : of_.joints) joint->begin_frame();
}

DUCTILE_INLINE void WorldParts::begin_bodies() {
    for (dBodyID body : of_.bodies) {
        const Damped damped{body, dBodyGetLinearDamping(body), dBodyGetAngularDamping(body)};
        if (damped.linear != 0 || damped.angular != 0) damped_.push_back(damped);
    }
    resting_.begin(of_.bodies);
}
DUCTILE_INLINE void WorldParts::leave_bodies() {
    resting_.end();
    damp(1);
    damped_.clear();
}

DUCTILE_INLINE void WorldParts::leave() {
    leave_bodies();
    for (const Driven& driven : driven_) {
        drive(driven.mean.velocity, driven.mean.spin, driven.body);
    }
    if (driven_.empty()) return;
    std::swap(driven_, last_driven_);
    driven_.clear();
}

DUCTILE_INLINE void WorldParts::forget(dBodyID body) {
    const auto is_it = [body](const auto& kept) { return kept.body == body; };
    forces_.forget(body);
    resting_.forget(body);
    std::erase(asleep_, body);
    std::erase_if(damped_, is_it);
    std::erase_if(driven_, is_it);
    std::erase_if(last_driven_, is_it);
}

DUCTILE_INLINE void WorldParts::begin_driven() {
    for (dBodyID body : of_.bodies) {
        if (dBodyIsKinematic(body) == 0) continue;
        Driven driven{body, body_motion(body), {}};
        const auto before = std::find_if(last_driven_.begin(), last_driven_.end(),
                                         [body](const Driven& last) { return last.body == body; });
        if (before != last_driven_.end()) driven.course = before->course;
        driven.course.begin(driven.mean, length_);
        driven_.push_back(driven);
    }
}

/// Kinematic bodies have the velocities that they have `time` [s] after the frame's begin.
DUCTILE_INLINE void WorldParts::drive_as_at(double time) const {
    for (const Driven& driven : driven_) {
        drive(driven.course.velocity(time), driven.course.spin(time), driven.body);
    }
}

/// With those that take them, through a time with `time` as its middle, to where they should be.
DUCTILE_INLINE void WorldParts::go_as_at(double time) const {
    for (const Driven& driven : driven_) {
        drive(driven.course.going(time), driven.course.turning(time), driven.body);
    }
}

DUCTILE_INLINE void WorldParts::drive(const Vector3<double>& velocity, const Vector3<double>& spin,
                                      dBodyID body) const {
    dBodySetLinearVel(body, dReal(velocity.x()), dReal(velocity.y()), dReal(velocity.z()));
    dBodySetAngularVel(body, dReal(spin.x()), dReal(spin.y()), dReal(spin.z()));
}

DUCTILE_INLINE void WorldParts::end() {
    leave();
    const double before = of_.meter.held().total();
    if (resting_.look(of_.bodies, of_.joints, length_)) {
        of_.meter.bodies_rearranged(before, Account::sleep);
    }
    // ODE keeps what was applied to a body that sleeps
    std::erase_if(asleep_, [](dBodyID body) { return dBodyIsEnabled(body) != 0; });
    forces_.apply_to(asleep_);
    of_.contacts.clear();
    if (of_.maker) of_.maker->clear();
}

DUCTILE_INLINE void WorldParts::drop_forces() {
    for (dBodyID body : of_.bodies) {
        dBodySetForce(body, 0, 0, 0);
        dBodySetTorque(body, 0, 0, 0);
    }
}

DUCTILE_INLINE void WorldParts::damp(double share) {
    const auto scale = [share](dReal whole) {
        return share == 1 ? whole : dReal(1 - std::pow(1 - double(whole), share));
    };
    for (const auto& [body, linear, angular] : damped_) {
        dBodySetLinearDamping(body, scale(linear));
        dBodySetAngularDamping(body, scale(angular));
    }
}

// ---- a part

DUCTILE_INLINE void WorldParts::save() {
    early_ = 0;
    kept_time_ = time_;
    of_.meter.keep();
    closing_.save();
    kept_seen_ = seen_;
    snapshot_.take(of_.bodies, of_.joints);
}

DUCTILE_INLINE void WorldParts::put_back() {
    snapshot_.put_back();
    of_.meter.put_back();
    closing_.put_back();
    seen_ = kept_seen_;
    time_ = kept_time_;
    looked_ = false;
}

DUCTILE_INLINE void WorldParts::tick(double h, bool blow) {
    const double half = blow ? 0 : h / 2;
    const double end = blow ? time_ : time_ + h;
    for (const Driven& driven : driven_) {
        for (PlasticConstraint* joint : of_.joints) {
            joint->driven_begins(driven.body, driven.course.velocity(time_),
                                 driven.course.spin(time_));
        }
    }
    go_as_at(time_ + half / 2); // the mean of the first half
    forces_.apply();
    of_.members.apply_forces();
    of_.meter.before_step();
    half_ahead_.move(of_.bodies, half);
    drive_as_at(end);
    if (!blow) of_.meter.bodies_ahead();
    look(blow ? nullptr : &snapshot_);
    closed_ = std::numeric_limits<double>::infinity();
    rule_contacts(h, blow);
    if (blow) open_others();
    of_.members.before_solve(of_.contacts);
    for (const auto& [joint, contact] : of_.contacts) of_.meter.add_contact(joint, contact.geom);
    of_.meter.look_at_contacts();
    damp(blow ? 0 : h / length_);
    {
        const Settings settings(of_.world, h, blow);
        of_.solve(h);
    }
    if (!blow) {
        closing_.see_forces(of_.contacts);
        closed_ = closing_.closed(half, half, apart_);
        closing_.remember();
    }
    go_as_at(end - half / 2);
    half_ahead_.move_on(half);
    drive_as_at(end);
    time_ = end;
    of_.book(h);
    drop_forces(); // those of bodies that sleep stay in ODE
    of_.meter.after_step(h);
    looked_ = false;
}

DUCTILE_INLINE const PartMotion& WorldParts::part(double h) {
    // so short a part closes what is left of a gap: its impulses are a blow's
    const bool instant = h < shortest_part();
    if (instant) of_.members.begin_blow();
    const auto beyond = [&] {
        // a contact that began unforeseen pushed for too long: the frame cuts the part there first
        if (closed_ < h && early_++ < tries_at_gaps) return false;
        return instant ? of_.members.look_blow(h) : of_.members.look(h);
    };
    for (tick(h, false); beyond(); tick(h, false)) do_again();
    tell();
    motion_.rigid_work = of_.meter.step_of_plastic_joints();
    motion_.contact_work = of_.meter.step_of_contacts();
    motion_.contact_lost = false;
    if (closing_.any_plastic() && of_.maker) {
        look();
        looked_ = true;
        closed_ = std::min(closed_, closing_.closed(h, h / 2, apart_));
        motion_.contact_lost = closing_.lost();
        double spin = 0;
        for (const NamedContact& named : of_.contacts) {
            const AttachedBodies bodies = attached_bodies(named.joint);
            for (dBodyID body : {bodies.a, bodies.b}) {
                if (closing_.is_plastic(body)) spin = std::max(spin, norm(angular_velocity(body)));
            }
        }
        if (may_misplace(motion_, h, apart_)) say_turned(motion_, spin * h);
    }
    motion_.closed = closed_ < h ? closed_ : 0;
    return motion_;
}

DUCTILE_INLINE const PartMotion& WorldParts::blow() {
    if (!of_.members.empty()) save();
    of_.members.begin_blow();
    for (tick(blow_length, true); of_.members.look_blow(blow_length); tick(blow_length, true)) {
        do_again();
    }
    motion_.closed = 0;
    motion_.contact_lost = false;
    return tell();
}

DUCTILE_INLINE void WorldParts::do_again() {
    put_back();
    rearrange([this] { of_.members.open_found(true); });
    save();
}

template <class Change>
void WorldParts::rearrange(const Change& change) {
    leave_bodies(); // pieces behave as the user's body does
    const double before = of_.meter.held().total();
    change();
    of_.meter.bodies_rearranged(before);
    begin_bodies();
}

DUCTILE_INLINE void WorldParts::accept(double h) try {
    seen_.clear();
    const bool open = h > 0 && of_.members.any_open();
    if (open) of_.meter.rings_down(of_.members.count_vibration());
    of_.accept(h);
    if (open) rearrange([this] { of_.members.close_held(true); });
} catch (...) { // a listener's
    leave();
    throw;
}

DUCTILE_INLINE const PartMotion& WorldParts::tell() {
    motion_.rows.clear();
    motion_.plastic_work = of_.members.closed_work();
    motion_.closed_work = of_.members.unmissed_work();
    for (const PlasticConstraint* joint : of_.joints) {
        const std::size_t first = motion_.rows.size();
        joint->list_part_rows(of_.number(*joint), motion_.rows);
        int section = 0;
        if (of_.members.key_of(*joint, section) != nullptr) {
            for (std::size_t k = first; k < motion_.rows.size(); ++k) {
                motion_.rows[k].section = section + 1;
            }
        }
        motion_.plastic_work += joint->queries().absorbed_energy();
    }
    return motion_;
}

// ---- contacts

namespace detail {

/// With the normal on the first of its bodies.
[[nodiscard]] DUCTILE_INLINE std::pair<AttachedBodies, SeenContact> seen_contact(
    const NamedContact& named) {
    const AttachedBodies bodies = attached_bodies(named.joint);
    const Vector3<double> point = to_core(named.contact.geom.pos);
    return {bodies,
            {.point = point,
             .normal = scaled(bodies.reversed ? -1 : 1, to_core(named.contact.geom.normal)),
             .arm_a = arm_of(bodies.a, point),
             .arm_b = arm_of(bodies.b, point)}};
}
[[nodiscard]] DUCTILE_INLINE bool before(const AttachedBodies& x, const AttachedBodies& y) {
    const std::less<dBodyID> less;
    return x.a != y.a ? less(x.a, y.a) : less(x.b, y.b);
}

} // namespace detail

DUCTILE_INLINE void WorldParts::look(const WorldSnapshot* moved) try {
    of_.contacts.clear();
    if (of_.maker) of_.maker->make(of_.bodies);
    closing_.look(of_.contacts, of_.joints, of_.members.bodies());
} catch (...) {
    if (moved != nullptr) moved->put_poses_back();
    if (moved == &snapshot_) of_.meter.put_back();
    drop_forces();
    forces_.apply(); // as they were
    leave();
    throw;
}

DUCTILE_INLINE void WorldParts::rule_contacts(double h, bool blow) {
    for (NamedContact& named : of_.contacts) {
        dSurfaceParameters& surface = named.contact.surface;
        const auto [a, b, reversed] = attached_bodies(named.joint);
        const double gap = closed_depth - double(named.contact.geom.depth);
        const bool plastic = closing_.is_plastic(a) || closing_.is_plastic(b);
        if (!plastic && (surface.mode & (dContactSoftERP | dContactSoftCFM)) == 0) continue;
        if ((surface.mode & dContactSoftERP) == 0) surface.soft_erp = dWorldGetERP(of_.world);
        surface.mode |= dContactSoftERP;
        surface.soft_erp = dReal(blow ? 0 : overlap_erp(double(surface.soft_erp), h, length_));
        if (blow) surface.soft_cfm *= dReal(blow_compliance(h));
        if (!blow && plastic) {
            if ((surface.mode & dContactMotionN) == 0) surface.motionN = 0;
            surface.mode |= dContactMotionN;
            surface.motionN += dReal(turned(named, h) - std::max(0.0, 2 * gap / h));
        }
        const dJointID old = named.joint;
        named.joint = dJointCreateContact(of_.world, of_.maker->parameters().group, &named.contact);
        dJointAttach(named.joint, dJointGetBody(old, 0), dJointGetBody(old, 1));
        dJointSetFeedback(named.joint, dJointGetFeedback(old));
        dJointDisable(old);
    }
}

DUCTILE_INLINE double WorldParts::turned(const NamedContact& named, double h) const {
    const auto [bodies, now] = detail::seen_contact(named);
    const auto first = std::lower_bound(seen_.begin(), seen_.end(), bodies,
                                        [](const auto& seen, const AttachedBodies& key) {
                                            return detail::before(seen.first, key);
                                        });
    const SeenContact* nearest = nullptr;
    double least = std::numeric_limits<double>::infinity();
    for (auto seen = first; seen != seen_.end() && seen->first == bodies; ++seen) {
        const double distance = norm(difference(seen->second.point, now.point));
        if (!(distance < least)) continue;
        least = distance;
        nearest = &seen->second;
    }
    if (nearest == nullptr) return 0;
    const auto motion = [](dBodyID body) {
        return body == nullptr ? ContactBody{}
                               : ContactBody{linear_velocity(body), angular_velocity(body)};
    };
    return turned_contact(now, *nearest, motion(bodies.a), motion(bodies.b), h / 2, h / 2);
}

DUCTILE_INLINE void WorldParts::open_others() {
    for (const NamedContact& named : of_.contacts) {
        const auto [a, b, reversed] = attached_bodies(named.joint);
        if (!closing_.is_plastic(a) && !closing_.is_plastic(b)) dJointDisable(named.joint);
    }
}

DUCTILE_INLINE ClosingContacts WorldParts::closing(double h, double touching, double apart) {
    apart_ = apart;
    ClosingContacts found;
    if (!of_.maker) return found;
    if (!std::exchange(looked_, true)) look();
    seen_.clear();
    if (!closing_.any_plastic()) return found;
    for (const NamedContact& named : of_.contacts) seen_.push_back(detail::seen_contact(named));
    std::stable_sort(seen_.begin(), seen_.end(),
                     [](const auto& x, const auto& y) { return detail::before(x.first, y.first); });
    closing_.remember();
    found.strikes = closing_.strikes(touching);
    if (found.strikes) return found;
    found.time = closing_.next_gap(apart);
    if (!(found.time < h)) found.time = next_gap(h, apart);
    return found;
}

DUCTILE_INLINE double WorldParts::next_gap(double h, double apart) {
    constexpr double most = 4096;
    double next = std::numeric_limits<double>::infinity();
    const double lengths = closing_.lengths(*of_.maker, of_.bodies, h);
    if (!(lengths > 1)) return next; // the part itself is looked at twice
    const int looks = int(std::min(std::ceil(lengths), most));
    looked_from_.take(of_.bodies, {});
    for (int i = 1; i <= looks && !(next < h); ++i) {
        const double time = std::min(i / lengths, 1.0) * h;
        half_ahead_.move(of_.bodies, time);
        look(&looked_from_);
        next = closing_.closed(time, time, apart);
        looked_from_.put_poses_back();
    }
    looked_ = false;
    return lengths > most ? std::min(next, most / lengths * h) : next;
}

DUCTILE_INLINE double WorldParts::kinetic_energy() const { return of_.meter.held().kinetic; }

} // namespace ductile::ode
