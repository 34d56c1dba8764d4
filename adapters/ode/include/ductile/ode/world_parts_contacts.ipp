// SPDX-License-Identifier: MIT
//
// Bodies of world_parts.hpp: contacts, who makes them, what they are asked and which close. A part
// of world_parts.ipp.
#pragma once

#include "ductile/frame/frame_rules.hpp"
#include "ductile/joint/gyroscopic.hpp"

namespace ductile::ode {

DUCTILE_INLINE void WorldParts::look(const WorldSnapshot* moved, bool still) try {
    of_.contacts.clear();
    {
        const Untouched waiting(aside());
        if (of_.maker) of_.maker->make(bodies());
    }
    leave_aside();
    if (!out_) closing_.look(of_.contacts, of_.joints, of_.members->bodies(), length_, still);
} catch (...) {
    of_.contacts.clear();
    if (of_.maker) of_.maker->clear();
    if (moved != nullptr) moved->put_poses_back();
    if (moved == &snapshot_) of_.meter.put_back();
    break_off();
    throw;
}
DUCTILE_INLINE void WorldParts::break_off() {
    drop_forces();
    forces_.apply(); // as they were
    leave();
}

DUCTILE_INLINE void WorldParts::rule_contacts(double h, bool blow) {
    soft_.clear();
    parted_.clear();
    for (const PlasticConstraint* joint : of_.joints) {
        if (joint->queries().broken()) parted_.push_back(joint->bodies());
    }
    for (NamedContact& named : of_.contacts) {
        dSurfaceParameters& surface = named.contact.surface;
        const ContactClosing it(named);
        const bool plastic = closing_.is_plastic(it.bodies.a) || closing_.is_plastic(it.bodies.b);
        const std::optional<SoftContact> soft = it.softness(named, length_);
        if (soft && plastic && !blow) {
            soften(named, it, *soft, h);
            continue;
        }
        const bool own = (surface.mode & (dContactSoftERP | dContactSoftCFM)) != 0;
        const auto depth = double(named.contact.geom.depth);
        const double closing = blow ? 0 : closes(it, depth, h, plastic);
        const bool parted = std::any_of(parted_.begin(), parted_.end(),
                                        [&](const auto& pair) { return it.bodies.are_of(pair); });
        const bool others = !plastic && !own && !soft && !parted && !(closing > 0);
        if (others && (blow || !is_thrown_out(depth, h))) continue;
        if ((surface.mode & dContactSoftERP) == 0) surface.soft_erp = dWorldGetERP(of_.world);
        surface.mode |= dContactSoftERP;
        if (soft && !blow) {
            const Softness spring =
                part_spring({double(surface.soft_erp), named.cfm(of_.world)}, h, length_);
            surface.mode |= dContactSoftCFM;
            surface.soft_erp = dReal(spring.erp);
            surface.soft_cfm = dReal(spring.compliance);
        } else {
            const double erp = overlap_erp(double(surface.soft_erp), h, length_);
            surface.soft_erp = dReal(blow ? 0 : parted ? parted_erp(erp, depth, h) : erp);
        }
        if (blow) surface.soft_cfm *= dReal(blow_compliance(h));
        if (!blow) {
            if ((surface.mode & dContactMotionN) == 0) surface.motionN = 0;
            surface.mode |= dContactMotionN;
            surface.motionN += dReal((plastic ? turned(it, h) : 0) - closing);
            if (plastic) hold_turning(named, it, h);
        }
        named.stale = true;
        if (!plastic)
            of_.maker->renew(of_.world, named); // others' islands may not be ODE's to solve
    }
}
/// Of bodies that overlap by `depth` [m]: a part of `h` [s] would push them apart faster than the
/// frame, as if that were 5 ms long.
DUCTILE_INLINE bool WorldParts::is_thrown_out(double depth, double h) const {
    constexpr double noticed = 0.05; // [m/s]
    const auto usual = double(dWorldGetERP(of_.world));
    const double more = part_erp(usual, h) - overlap_erp(usual, h, length_);
    return h < length_ && (depth - closed_depth) * more > noticed * h;
}

/// No more of it pushes than what ODE would correct in a frame.
DUCTILE_INLINE void WorldParts::soften(NamedContact& named, const ContactClosing& it,
                                       const SoftContact& soft, double h) {
    dSurfaceParameters& surface = named.contact.surface;
    const auto most = double(dWorldGetContactMaxCorrectingVel(of_.world));
    const double layer = double(dWorldGetContactSurfaceLayer(of_.world));
    const double deep = std::max(0.0, double(named.contact.geom.depth) - layer);
    const double share = soft.stiffness / (soft.damping + length_ * soft.stiffness); // erp/frame
    const double motion = (surface.mode & dContactMotionN) != 0 ? double(surface.motionN) : 0;
    const double turned = this->turned(it, h), start = -it.speed + turned - motion;
    const LawRow law = soft.row(share * deep > most ? most / share : deep, start, h);
    named.by_law = true;
    surface.mode |= dContactSoftERP | dContactSoftCFM | dContactMotionN;
    surface.mode &= ~dContactBounce;
    surface.soft_erp = 0;
    surface.soft_cfm = dReal(law.compliance * h);
    surface.motionN = dReal(law.target + turned + motion);
    hold_turning(named, it, h);
    named.stale = true;
    soft_.push_back({soft, named.joint, it, start, turned + motion});
}
/// As the bodies leave a part of `h` [s].
DUCTILE_INLINE void WorldParts::tell_of_soft(double h) {
    for (const auto& [soft, joint, it, start, turned] : soft_) {
        const dJointFeedback* feedback = dJointGetFeedback(joint);
        if (feedback == nullptr) continue;
        const double force = dot(it.seen.normal, to_core(feedback->f1));
        const double end = -it.speed_of(contact_body(it.bodies.a), contact_body(it.bodies.b));
        soft.tell(motion_.own, force, start, end - turned, h);
    }
}

DUCTILE_INLINE double WorldParts::closes(const ContactClosing& it, double depth, double h,
                                         bool plastic) const {
    // what a blow stopped closes no more, although that strikes a little early
    const double left = plastic && it.closes() ? 2 * (it.depth() - depth) / h : 0;
    const bool known = depth > closed_depth / 2;
    const double to = known ? 0 : std::clamp(2 * (closed_depth - depth) / h, 0.0, it.sinks);
    return std::max(left, to);
}

DUCTILE_INLINE double WorldParts::turned(const ContactClosing& it, double h) const {
    const SeenContact* then = nearest(seen_, it.bodies, it.seen.point);
    if (then == nullptr) return 0;
    return turned_contact(it.seen, *then, contact_body(it.bodies.a), contact_body(it.bodies.b),
                          h / 2, h / 2);
}

/// Friction that holds is right at the end of a part of `h` [s].
DUCTILE_INLINE void WorldParts::hold_turning(NamedContact& named, const ContactClosing& it,
                                             double h) {
    dSurfaceParameters& surface = named.contact.surface;
    const Vector3<double> turns = turning_arms(contact_body(it.bodies.a), it.seen.arm_a,
                                               contact_body(it.bodies.b), it.seen.arm_b);
    if (turns.isZero()) return;
    const auto along = detail::friction_directions(named.contact, it.seen.normal);
    const auto move = [&](int flag, dReal& motion, const Vector3<double>& way) {
        if ((surface.mode & flag) == 0) motion = 0;
        surface.mode |= flag;
        motion -= dReal(h / 2 * dot(way, turns));
    };
    move(dContactMotion1, surface.motion1, along[0]);
    move(dContactMotion2, surface.motion2, along[1]);
}

DUCTILE_INLINE void WorldParts::begin_pushes() {
    for (NamedContact& named : of_.contacts) {
        const Push* last =
            nearest(pushes_, attached_bodies(named.joint), to_core(named.contact.geom.pos));
        if (last != nullptr) named.force = last->force;
    }
}
DUCTILE_INLINE void WorldParts::remember_pushes() {
    pushes_.clear();
    for (const NamedContact& named : of_.contacts) {
        const dJointFeedback* feedback = dJointGetFeedback(named.joint);
        if (feedback == nullptr) continue;
        pushes_.emplace_back(attached_bodies(named.joint),
                             Push{to_core(named.contact.geom.pos), to_core(feedback->f1)});
    }
    sort_by_bodies(pushes_);
}

DUCTILE_INLINE void WorldParts::open_others() {
    for (const NamedContact& named : of_.contacts) {
        const auto [a, b, reversed] = attached_bodies(named.joint);
        const bool plastic = closing_.is_plastic(a) || closing_.is_plastic(b);
        const ContactClosing it(named);
        if (!plastic || it.rebounds(named) || it.softness(named, length_)) {
            dJointDisable(named.joint);
        }
    }
}

/// As ODE's step does: where the part is solved they may be apart.
DUCTILE_INLINE void WorldParts::wake_touched() const {
    for (const NamedContact& named : of_.contacts) {
        const auto [a, b, reversed] = attached_bodies(named.joint);
        if (a == nullptr || b == nullptr || dBodyIsEnabled(a) == dBodyIsEnabled(b)) continue;
        const dBodyID asleep = dBodyIsEnabled(a) != 0 ? b : a;
        if (can_move(asleep)) dBodyEnable(asleep);
    }
}

/// As the coming part begins.
DUCTILE_INLINE void WorldParts::see_contacts() {
    if (!of_.maker && !closing_.any_stops()) return;
    if (!std::exchange(looked_, true)) look();
    wake_touched();
    seen_.clear();
    if (!closing_.any_plastic()) return;
    for (const NamedContact& named : of_.contacts) seen_.push_back(detail::seen_contact(named));
    sort_by_bodies(seen_);
    closing_.remember();
}

DUCTILE_INLINE const Stir& WorldParts::stir() const {
    if (!stir_) stir_ = Stir::of(of_.bodies, length_);
    return *stir_;
}
DUCTILE_INLINE double WorldParts::kinetic_energy() const {
    return local_ ? of_.meter.held().kinetic : stir().kinetic;
}
DUCTILE_INLINE bool WorldParts::is_still(double h, double least) const {
    if (local_ || !of_.members->empty() || !thrown_.bodies().empty()) return false;
    const Stir& bodies = stir();
    return bodies.spin * length_ <= ductile::detail::followed_turn && !(2 * bodies.most > least) &&
           !closing_.counts(0, 2 * bodies.speed * h, apart_);
}

DUCTILE_INLINE ClosingContacts WorldParts::closing(double h, double touching, double apart) {
    touching_ = touching;
    apart_ = apart;
    still_ = is_still(h, touching);
    if (still_) return {};
    if (local_) {
        if (std::vector<dBodyID> met = scope_.met(forces_, h); !met.empty()) join(std::move(met));
    }
    do see_contacts();
    while (join_touched());
    ClosingContacts found{.strikes = is_thrown()};
    const bool looks = of_.maker || closing_.any_stops();
    if (found.strikes || !looks || !closing_.any_plastic()) return found;
    found.strikes = closing_.strikes(touching);
    if (found.strikes) return found;
    found.time = closing_.next_gap(apart);
    if (!(found.time < h) && of_.maker) found.time = next_gap(h, apart);
    return found;
}

DUCTILE_INLINE bool WorldParts::is_thrown() {
    if (thrown_.bodies().empty()) return false;
    if (!std::exchange(looked_, true)) look();
    return std::any_of(thrown_.bodies().begin(), thrown_.bodies().end(),
                       [this](dBodyID body) { return closing_.is_plastic(body); });
}

DUCTILE_INLINE double WorldParts::next_gap(double h, double apart) {
    constexpr double most = 4096;
    double next = std::numeric_limits<double>::infinity();
    const double lengths = closing_.lengths(*of_.maker, bodies(), local_ ? &scope_ : nullptr, h);
    if (!(lengths > 1)) return next; // the part itself is looked at twice
    const int looks = int(std::min(std::ceil(lengths), most));
    looked_from_.take(bodies(), {});
    for (int i = 1; i <= looks && !(next < h); ++i) {
        const double time = std::min(i / lengths, 1.0) * h;
        half_ahead_.move(bodies(), time);
        look(&looked_from_);
        of_.members->see_ahead(of_.contacts);
        next = closing_.closed(time, 0, apart);
        looked_from_.put_poses_back();
    }
    looked_ = false;
    return lengths > most ? std::min(next, most / lengths * h) : next;
}

/// Members are as whole as they are without it.
DUCTILE_INLINE void WorldParts::begin_blow() {
    if (of_.members->empty()) return;
    if (of_.members->any_open()) close_held(Closing::before_blow);
    save();
    of_.members->begin_blow(touching_);
    see_coming();
}

/// As bodies go that hang on members, were these not there.
DUCTILE_INLINE void WorldParts::see_coming() {
    const struct Cut {
        const Divisibles& of;
        bool any;
        explicit Cut(const Divisibles& members) : of(members), any(of.switch_holds(false)) {}
        ~Cut() { (void)of.switch_holds(true); }
    } cut(*of_.members);
    if (cut.any) tick(blow_length, true);
    of_.members->see_coming();
    if (cut.any) put_back();
}

/// Members reckon with ODE's own rule.
DUCTILE_INLINE void WorldParts::keep_spins(double h) {
    if (!of_.members->empty()) return;
    for (dBodyID body : bodies()) {
        if (!can_move(body) || dBodyIsEnabled(body) == 0) continue;
        const Vector3<double> spin = angular_velocity(body);
        if (!turns_far(spin, h)) continue;
        const Matrix3<double> about = inertia(body);
        if (!wobbles(about, spin)) continue;
        const Vector3<double> rest =
            gyroscopic_rest(gyroscopic_impulse(body, about, spin, h), about, spin, h);
        if (is_zero(rest)) continue;
        add_force(body, Vector3<double>::Zero(), scaled(1 / h, rest));
        of_.meter.add_gyroscopic(body, rest);
    }
}

} // namespace ductile::ode
