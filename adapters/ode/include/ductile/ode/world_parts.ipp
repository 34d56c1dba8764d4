// SPDX-License-Identifier: MIT
//
// Bodies of world_parts.hpp.
#pragma once

#include <algorithm>
#include <cmath>

#include "ductile/frame/part_settings.hpp"
#include "ductile/ode/world_parts.hpp"

namespace ductile::ode {

/// The world's settings of a part or a blow while this lives, and those of the user's joints.
class WorldParts::Settings {
  public:
    Settings(WorldParts& parts, double h, bool blow)
        : world_(parts.of_.world),
          own_(parts.own_settings_),
          erp_(dWorldGetERP(world_)),
          cfm_(dWorldGetCFM(world_)),
          layer_(dWorldGetContactSurfaceLayer(world_)) {
        dWorldSetERP(world_, dReal(blow ? 0 : part_erp(double(erp_), h)));
        dWorldSetContactSurfaceLayer(world_, std::max(layer_, dReal(closed_depth)));
        if (blow) dWorldSetCFM(world_, cfm_ * dReal(blow_compliance(h)));
        own_.rule(parts.bodies(), parts.standing_.our_joints(parts.of_.joints), h, parts.length_,
                  blow);
    }
    ~Settings() {
        own_.put_back();
        dWorldSetERP(world_, erp_);
        dWorldSetCFM(world_, cfm_);
        dWorldSetContactSurfaceLayer(world_, layer_);
    }
    Settings(const Settings&) = delete;
    Settings& operator=(const Settings&) = delete;

  private:
    dWorldID world_;
    OwnSettings& own_;
    dReal erp_, cfm_, layer_;
};

// ---- a frame

DUCTILE_INLINE void WorldParts::begin(double length) {
    leave(); // a frame that was not ended
    length_ = length;
    time_ = 0;
    of_.meter.set_owners([this](const void* body) { return of_.members->owner_of(body); });
    begin_driven();
    moved();
    may_be_local_ = true;
    bool as_left = thrown_.find(of_.bodies, of_.joints);
    as_left = forces_.hold(of_.bodies) && as_left;
    asleep_.clear();
    for (dBodyID body : of_.bodies) {
        if (dBodyIsEnabled(body) == 0) asleep_.push_back(body);
    }
    drop_forces();
    begin_bodies();
    for (PlasticConstraint* joint : of_.joints) as_left = !joint->begin_frame() && as_left;
    standing_.begin(of_.world, of_.bodies, of_.joints, as_left);
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
    widen();
    leave_bodies();
    metered_ = true;
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
    scope_.forget(body);
    std::erase(touched_, body);
    resting_.forget(body);
    std::erase(asleep_, body);
    thrown_.forget(body);
    std::erase_if(damped_, is_it);
    std::erase_if(driven_, is_it);
    std::erase_if(last_driven_, is_it);
    const auto has = [body](const auto& of) { return of.first.a == body || of.first.b == body; };
    for (auto* const seen : {&seen_, &kept_seen_}) std::erase_if(*seen, has);
    for (auto* const pushes : {&pushes_, &kept_pushes_}) std::erase_if(*pushes, has);
    closing_.forget(body);
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

/// The rest of the way of a part of `h` [s] that began at `time`.
DUCTILE_INLINE void WorldParts::drive_to_end(double time, double h) const {
    for (const Driven& driven : driven_) {
        drive(driven.course.later_velocity(time, h), driven.course.later_spin(time, h),
              driven.body);
    }
}

DUCTILE_INLINE void WorldParts::drive(const Vector3<double>& velocity, const Vector3<double>& spin,
                                      dBodyID body) const {
    dBodySetLinearVel(body, dReal(velocity.x()), dReal(velocity.y()), dReal(velocity.z()));
    dBodySetAngularVel(body, dReal(spin.x()), dReal(spin.y()), dReal(spin.z()));
}

DUCTILE_INLINE void WorldParts::end() {
    const bool were_aside = local_;
    leave();
    if (were_aside) look(); // what all hang together by
    double before = 0;
    const auto about_to = [&] { before = of_.meter.held().total(); };
    if (resting_.look(of_.bodies, of_.joints, length_, about_to)) {
        of_.meter.bodies_rearranged(before, Account::sleep);
    }
    // ODE keeps what was applied to a body that sleeps
    std::erase_if(asleep_, [](dBodyID body) { return dBodyIsEnabled(body) != 0; });
    forces_.apply_to(asleep_);
    slept_ = asleep_.size() == of_.bodies.size(); // as they were when it began
    of_.contacts.clear();
    if (of_.maker) of_.maker->clear();
    thrown_.leave(of_.bodies);
}

DUCTILE_INLINE void WorldParts::drop_forces() {
    for (dBodyID body : bodies()) {
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

DUCTILE_INLINE bool WorldParts::may_be_put_back() {
    if (!still_ || !standing_.is_calm(stir())) return true;
    metered_ = of_.keeps_ledger;
    // where a callback throws, bodies go back to where they were
    of_.meter.keep();
    snapshot_.take(bodies(), {});
    return false;
}

DUCTILE_INLINE void WorldParts::save() {
    kept_time_ = time_;
    of_.meter.keep();
    closing_.save();
    kept_seen_ = seen_;
    kept_pushes_ = pushes_;
    snapshot_.take(bodies(), of_.joints);
}

DUCTILE_INLINE void WorldParts::put_back() {
    snapshot_.put_back();
    of_.meter.put_back();
    closing_.put_back();
    seen_ = kept_seen_;
    pushes_ = kept_pushes_;
    time_ = kept_time_;
    moved();
    if (go_local()) save();
}

/// Into the middle of a part.
DUCTILE_INLINE void WorldParts::go_ahead(double h, double half) {
    forces_.apply_to(bodies());
    if (metered_) of_.meter.before_step(false); // contacts are to come
    const bool moved = half_ahead_.move(bodies(), half);
    if (half > 0) forces_.follow(bodies()); // to where their places are now
    if (!out_) of_.members->apply_forces();
    if (metered_ && (moved || !of_.members->empty())) of_.meter.bodies_ahead();
    if (half > 0) keep_spins(h);
}

DUCTILE_INLINE void WorldParts::solve(double h, bool blow,
                                      const std::function<void(double)>& step) {
    for (const NamedContact& named : of_.contacts) {
        of_.meter.add_contact(named.joint, named.contact.geom, named.by_law);
    }
    of_.meter.look_at_contacts();
    damp(blow ? 0 : h / length_);
    const Settings settings(*this, h, blow);
    const StoodAside waiting(aside());
    step(h);
    motion_.own = blow ? OwnForces() : own_settings_.forces(h);
    tell_of_soft(h);
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
    drive_as_at(time_);
    go_ahead(h, half);
    drive_as_at(end);
    if (!blow) closing_.see_motions(bodies());
    look(blow ? nullptr : &snapshot_, still_ && !blow);
    closed_ = std::numeric_limits<double>::infinity();
    rule_contacts(h, blow);
    if (blow) open_others();
    of_.members->before_solve(of_.contacts);
    if (!blow) begin_pushes();
    solve(h, blow, of_.solve);
    if (!blow) {
        closing_.see_forces(of_.contacts);
        remember_pushes();
        closed_ = closing_.closed(half, 0, apart_);
        closing_.remember();
    }
    if (!blow) drive_to_end(time_, h);
    half_ahead_.move_on(half);
    drive_as_at(end);
    time_ = end;
    of_.book(h);
    drop_forces(); // those of bodies that sleep stay in ODE
    metered_ ? of_.meter.after_step(h) : of_.meter.step_is_over();
    moved();
}

DUCTILE_INLINE const PartMotion& WorldParts::part(double h) try {
    // so short a part closes what is left of a gap: its impulses are a blow's
    const bool instant = h < shortest_part();
    if (h < length_ && go_local()) save();
    if (instant) begin_blow();
    const auto beyond = [&] {
        // a contact that began unforeseen pushed for too long: the frame cuts the part there first
        if (is_put_back(closed_ < h ? closed_ : 0, h)) return false;
        return instant ? of_.members->look_blow(h) : of_.members->look(h);
    };
    for (tick(h, false); beyond(); tick(h, false)) do_again();
    while (!touched_.empty()) {
        put_back();
        (void)join_touched();
        save();
        tick(h, false);
    }
    tell();
    motion_.rigid_work = metered_ ? of_.meter.step_of_plastic_joints() : 0;
    motion_.others_work = metered_ ? of_.meter.step_of_other_joints() : 0;
    motion_.stored = metered_ ? of_.meter.stored() : 0;
    motion_.closed_share = of_.members->closed_share();
    motion_.contact_lost = false;
    motion_.turned = 0;
    const bool stood = still_ && !motion_.flows() && is_still(h, apart_);
    if (!stood && closing_.any_plastic() && (of_.maker || closing_.any_stops())) {
        look();
        looked_ = true;
        closed_ = std::min(closed_, closing_.closed(h, h, apart_));
        if (may_misplace(motion_, h, apart_)) motion_.turned = closing_.turn(h);
        motion_.contact_lost = closing_.lost();
    }
    motion_.contact_work = 0;
    if (metered_ && motion_.flows()) {
        motion_.contact_work = of_.meter.step_of_contacts([this](const void* body) {
            return body != nullptr &&
                   closing_.is_plastic(static_cast<dBodyID>(const_cast<void*>(body)));
        });
    }
    motion_.closed = closed_ < h ? closed_ : 0;
    return motion_;
} catch (...) { // who makes contacts, or one of a member that was not named
    snapshot_.put_back();
    of_.meter.put_back();
    break_off();
    throw;
}

DUCTILE_INLINE void WorldParts::close_held(Closing when) {
    rearrange([this, when] { return of_.members->close_held(when, true); });
}

DUCTILE_INLINE const PartMotion& WorldParts::blow() {
    (void)go_local();
    thrown_.strike();
    begin_blow();
    for (tick(blow_length, true); of_.members->look_blow(blow_length); tick(blow_length, true)) {
        do_again();
    }
    motion_.closed = 0;
    motion_.contact_lost = false;
    return tell();
}

DUCTILE_INLINE void WorldParts::do_again() {
    put_back();
    rearrange([this] { of_.members->open_found(true); });
    save();
}

template <class Change>
void WorldParts::rearrange(const Change& change) {
    leave_bodies(); // pieces behave as the user's body does
    ductile::rearrange(&of_.meter, change);
    begin_bodies();
    moved();
    see_contacts(); // those that were seen were of other bodies
}

DUCTILE_INLINE void WorldParts::accept(double h) try {
    may_be_local_ = may_be_local_ && h == 0;
    seen_.clear();
    still_ = false;
    metered_ = true;
    stir_.reset(); // listeners may do what hands do
    const bool open = h > 0 && of_.members->any_open();
    if (open) of_.meter.rings_down(of_.members->count_vibration());
    of_.accept(h);
    if (open) close_held(Closing::after_step);
} catch (...) { // a listener's
    leave();
    throw;
}

DUCTILE_INLINE const PartMotion& WorldParts::tell() {
    motion_.rows.clear();
    standing_.forget_rows();
    islands_.clear();
    motion_.plastic_work = of_.members->closed_work();
    motion_.idle_work = of_.members->idle_work();
    motion_.closed_work = of_.members->unmissed_work();
    for (const PlasticConstraint* joint : of_.joints) {
        const std::size_t first = motion_.rows.size();
        joint->list_part_rows(of_.number(*joint), motion_.rows);
        const std::span<PartRow> rows = std::span(motion_.rows).subspan(first);
        int section = 0;
        const bool of_member = of_.members->key_of(*joint, section) != nullptr;
        const int island = of_member ? -1 : islands_.of(joint->id());
        for (PartRow& row : rows) {
            if (of_member) row.section = section + 1;
            row.island = island;
        }
        if (!rows.empty()) rows.front().work = joint->queries().absorbed_energy();
        standing_.note(rows);
        motion_.plastic_work += joint->queries().absorbed_energy();
    }
    return motion_;
}

} // namespace ductile::ode

#include "ductile/ode/world_parts_alone.ipp"    // IWYU pragma: keep
#include "ductile/ode/world_parts_contacts.ipp" // IWYU pragma: keep
