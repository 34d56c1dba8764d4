// SPDX-License-Identifier: MIT
//
// Bodies of closing_contacts.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <stdexcept>

#include "ductile/ode/closing_contacts.hpp"
#include "ductile/ode/convert.hpp"
#include "ductile/ode/joint_stops.hpp"
#include "ductile/ode/moving_geom.hpp"

namespace ductile::ode {

namespace detail {

/// Velocity that a unit impulse along `normal` at `arm` gives there [1/kg].
[[nodiscard]] DUCTILE_INLINE double yield_at(dBodyID body, const Vector3<double>& arm,
                                             const Vector3<double>& normal) {
    if (!can_move(body)) return 0;
    const BodyState<double> state = body_state(body);
    const Vector3<double> turn = cross(arm, normal);
    return state.inverse_mass + dot(turn, times(state.inverse_inertia, turn));
}

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

/// Overlap at which what comes at `speed` [m/s] is closed [m].
[[nodiscard]] DUCTILE_INLINE double closing_depth(double speed) {
    constexpr double share = 0.01, g = 10, least = 1e-7; // [-] [m/s²] [m]
    return std::clamp(share * speed * speed / (2 * g), least, closed_depth);
}

} // namespace detail

DUCTILE_INLINE ContactClosing::ContactClosing(const NamedContact& named)
    : bodies(attached_bodies(named.joint)), seen(detail::seen_contact(named).second) {
    constexpr double followed = 0.02; // of what turns it
    const ContactBody a = contact_body(bodies.a), b = contact_body(bodies.b);
    const Vector3<double> velocity = difference(b.at(seen.arm_b), a.at(seen.arm_a));
    speed = dot(seen.normal, velocity);
    comes = norm(velocity);
    sinks = followed * (norm(difference(velocity, scaled(speed, seen.normal))) +
                        norm(a.spin) * norm(seen.arm_a) + norm(b.spin) * norm(seen.arm_b));
}
DUCTILE_INLINE double ContactClosing::yields() const {
    return detail::yield_at(bodies.a, seen.arm_a, seen.normal) +
           detail::yield_at(bodies.b, seen.arm_b, seen.normal);
}
DUCTILE_INLINE double ContactClosing::depth() const { return detail::closing_depth(speed); }

DUCTILE_INLINE bool ContactClosing::rebounds(const NamedContact& named) const {
    constexpr double noticed = 0.01, hardly_less = 0.99; // [m/s] [-]
    const dSurfaceParameters& surface = named.contact.surface;
    if ((surface.mode & dContactBounce) == 0 || !(surface.bounce > 0)) return false;
    if (surface.bounce_vel < 0) return false; // never
    const double slowest = double(surface.bounce) * std::max(double(surface.bounce_vel), noticed);
    return -speed > hardly_less * slowest;
}

DUCTILE_INLINE std::optional<SoftContact> ContactClosing::softness(const NamedContact& named,
                                                                   double frame) const {
    if (bodies.a == nullptr) return {}; // both stand
    const dSurfaceParameters& surface = named.contact.surface;
    const dWorldID world = dBodyGetWorld(bodies.a);
    const auto has = [&surface](int flag) { return (surface.mode & flag) != 0; };
    const auto erp = double(has(dContactSoftERP) ? surface.soft_erp : dWorldGetERP(world));
    const double cfm = named.cfm(world);
    if (!(cfm > 0) || (!can_move(bodies.a) && !can_move(bodies.b))) return {};
    // what is hard for bodies that do not turn, which yield less, is
    const auto yields = [](dBodyID body) { return can_move(body) ? 1 / mass(body) : 0; };
    const Softness usual{erp, cfm};
    if (SoftContact::of(usual, yields(bodies.a), yields(bodies.b), frame).is_hard(frame)) return {};
    SoftContact soft = SoftContact::of(usual, detail::yield_at(bodies.a, seen.arm_a, seen.normal),
                                       detail::yield_at(bodies.b, seen.arm_b, seen.normal), frame);
    if (soft.is_hard(frame)) return {};
    const double bounce =
        has(dContactBounce) && surface.bounce_vel >= 0 && speed > double(surface.bounce_vel)
            ? double(surface.bounce)
            : 0;
    const double pushes = soft.stiffness * double(named.contact.geom.depth);
    if (bounce * soft.damping * speed > pushes) {
        soft.stiffness = 0;
        soft.damping *= 1 + bounce;
    }
    return soft;
}

DUCTILE_INLINE void ClosingContactsFinder::find_islands(std::span<const NamedContact> contacts,
                                                        std::span<PlasticConstraint* const> joints,
                                                        std::span<const dBodyID> members) {
    std::ptrdiff_t found = 0; // contacts
    island_.clear();
    numbers_.clear();
    const auto add = [&](dBodyID body) {
        if (can_move(body) && numbers_.enter(body) == island_.size()) island_.push_back(body);
    };
    for (dBodyID body : members) {
        if (numbers_.enter(body) == island_.size()) island_.push_back(body);
    }
    for (const PlasticConstraint* joint : joints) {
        if (joint->queries().broken() || dJointIsEnabled(joint->id()) == 0) continue;
        for (const int side : {0, 1}) add(dJointGetBody(joint->id(), side));
    }
    for (std::size_t at = 0; at < island_.size(); ++at) {
        const dBodyID body = island_[at];
        for (int i = 0, count = dBodyGetNumJoints(body); i < count; ++i) {
            const dJointID joint = dBodyGetJoint(body, i);
            const bool touches = dJointGetType(joint) == dJointTypeContact;
            // what members hold hangs together with them while it is cut off, too
            const bool may_be_cut = at < members.size() && !touches;
            if (dJointIsEnabled(joint) == 0 && !may_be_cut) continue;
            const dBodyID first = dJointGetBody(joint, 0), second = dJointGetBody(joint, 1);
            // from one of its two bodies
            if (touches && (body == first || (!can_move(first) && !is_plastic(first)))) ++found;
            add(first);
            add(second);
        }
    }
    const auto of_them = [this](const NamedContact& contact) {
        return dJointIsEnabled(contact.joint) != 0 &&
               (is_plastic(dJointGetBody(contact.joint, 0)) ||
                is_plastic(dJointGetBody(contact.joint, 1)));
    };
    if (found != std::count_if(contacts.begin(), contacts.end(), of_them)) {
        throw std::logic_error(
            "World.step: a contact of a body with plastic joints was not named: in a world with a "
            "tolerance all are made and named (add_contact) by what on_contacts was given");
    }
}

DUCTILE_INLINE void ClosingContactsFinder::look(std::span<const NamedContact> contacts,
                                                std::span<PlasticConstraint* const> joints,
                                                std::span<const dBodyID> members, double frame,
                                                bool still) {
    find_islands(contacts, joints, members);
    touches_.clear();
    pairs_.clear();
    touching_.clear();
    for (const NamedContact& named : contacts) {
        const auto [a, b, reversed] = attached_bodies(named.joint);
        if (!is_plastic(a) && !is_plastic(b)) continue;
        touching_.push_back(mates(named));
        pairs_.push_back(touching_.back().first);
        if (still) continue;
        const bool is_new = !std::binary_search(before_.begin(), before_.end(), pairs_.back());
        const ContactClosing it(named);
        const bool closes = it.closes();
        const bool came_other_way =
            is_new && it.yields() > 0 && double(named.contact.geom.depth) > closed_depth;
        if (!closes && !came_other_way) continue;
        const double before = it.speed_of(motion_before(a), motion_before(b));
        const double struck_at = closes ? it.speed : it.comes; // past an edge
        const std::optional<SoftContact> soft = it.softness(named, frame);
        const double depth = soft ? soft->beginning(it.speed) : it.depth();
        const auto [one, other] = touching_.back().second;
        const double thin = std::min(detail::thickness(one), detail::thickness(other));
        touches_.push_back({depth - double(named.contact.geom.depth), depth, it.speed, before,
                            struck_at * struck_at / (2 * it.yields()), is_new, closes, !soft,
                            thin});
    }
    std::sort(pairs_.begin(), pairs_.end());
    std::sort(touching_.begin(), touching_.end());
    look_at_stops();
}

/// Their gaps are known from afar.
DUCTILE_INLINE void ClosingContactsFinder::look_at_stops() {
    any_stops_ = false;
    for (dBodyID body : island_) {
        for (int i = 0, count = dBodyGetNumJoints(body); i < count; ++i) {
            const dJointID joint = dBodyGetJoint(body, i);
            if (dJointGetType(joint) == dJointTypeContact || dJointIsEnabled(joint) == 0) continue;
            for (const StoppedAxis& axis : stopped_axes(joint)) {
                if (!axis.stops()) continue;
                any_stops_ = true;
                const double speed = std::abs(axis.rate), depth = detail::closing_depth(speed);
                if (!(speed > 0 && axis.yields > 0) || !std::isfinite(axis.gap())) continue;
                touches_.push_back({axis.gap() + depth, depth, speed, speed,
                                    speed * speed / (2 * axis.yields), false, true, true, 0});
            }
        }
    }
}

DUCTILE_INLINE void ClosingContactsFinder::see_motions(std::span<const dBodyID> bodies) {
    motions_.clear();
    for (dBodyID body : bodies) motions_[body] = contact_body(body);
}
DUCTILE_INLINE ContactBody ClosingContactsFinder::motion_before(dBodyID body) const {
    const ContactBody* found = motions_.find(body);
    return found != nullptr ? *found : contact_body(body);
}

DUCTILE_INLINE void ClosingContactsFinder::see_forces(std::span<const NamedContact> contacts) {
    double largest = 0;
    began_ = std::exchange(pushing_, {});
    for (const NamedContact& named : contacts) {
        const dJointFeedback* feedback = dJointGetFeedback(named.joint);
        const auto [a, b, reversed] = attached_bodies(named.joint);
        if (feedback == nullptr || (!is_plastic(a) && !is_plastic(b))) continue;
        const double force = dot(to_core(feedback->f1), to_core(named.contact.geom.normal));
        largest = std::max(largest, std::abs(force));
        pushing_.emplace_back(mates(named), std::abs(force));
    }
    if (largest > 0) force_ = largest;
}

DUCTILE_INLINE auto ClosingContactsFinder::mates(const NamedContact& named) -> Mates {
    const AttachedBodies bodies = attached_bodies(named.joint);
    const dContactGeom& geom = named.contact.geom;
    return {std::minmax(bodies.a, bodies.b, std::less<dBodyID>()),
            std::minmax(geom.g1, geom.g2, std::less<dGeomID>())};
}

DUCTILE_INLINE void ClosingContactsFinder::forget(dBodyID body) {
    const auto has = [body](const Pair& pair) { return pair.first == body || pair.second == body; };
    std::erase_if(before_, has);
    for (auto* const pushes : {&pushing_, &began_, &kept_pushing_}) {
        for (Push& push : *pushes) { // what pushed it is lost
            if (has(push.first.first)) push.first.first = {nullptr, nullptr};
        }
    }
}

DUCTILE_INLINE bool ClosingContactsFinder::lost() {
    const auto is_lost = [this](const Push& push) {
        constexpr double noticed = 0.01; // of the largest force
        return push.second > noticed * force_ &&
               !std::binary_search(touching_.begin(), touching_.end(), push.first);
    };
    const bool gone = std::any_of(began_.begin(), began_.end(), is_lost);
    return std::erase_if(pushing_, is_lost) > 0 || gone;
}

DUCTILE_INLINE double ClosingContactsFinder::turn(double h) const {
    double spin = 0;
    for (const auto& [mates, force] : pushing_) {
        if (!(force > 0)) continue;
        for (dBodyID body : {mates.first.first, mates.first.second}) {
            if (is_plastic(body)) spin = std::max(spin, norm(angular_velocity(body)));
        }
    }
    return spin * h;
}

DUCTILE_INLINE bool ClosingContactsFinder::strikes(double touching) const {
    return std::any_of(touches_.begin(), touches_.end(),
                       [touching](const Touch& touch) { return touch.strikes(touching); });
}

DUCTILE_INLINE double ClosingContactsFinder::next_gap(double apart) const {
    double next = std::numeric_limits<double>::infinity();
    for (const Touch& touch : touches_) {
        const bool closed = touch.gap < touch.depth / 2;
        if (!touch.closes || !(touch.energy > apart) || (closed && touch.is_hard)) continue;
        // no part is to carry what gives way past what it presses
        next = std::min(next, (closed ? touch.thin / 2 : touch.gap) / touch.speed);
    }
    return next;
}

DUCTILE_INLINE double ClosingContactsFinder::closed(double past, double hurried,
                                                    double apart) const {
    // of a first hit nobody knows yet how hard the contact will push
    const double unmissed = force_ > 0 ? 0.25 : 0.01; // of the overlap at which it is closed
    double first = std::numeric_limits<double>::infinity();
    for (const Touch& touch : touches_) {
        const double overlap = -touch.gap;
        if (!counts(touch.energy, overlap, apart)) continue;
        if (hurried > 0 && !(overlap > unmissed * touch.depth)) continue;
        const double a = hurried > 0 ? (touch.speed - touch.before) / hurried : 0;
        double ago = time_to_close(overlap, touch.speed, -a); // back to where it closed
        if (!touch.closes || !(ago < past)) {
            if (!touch.is_new) continue;
            ago = past / 2; // it went another way
        }
        first = std::min(first, past - ago);
    }
    return first;
}

DUCTILE_INLINE double ClosingContactsFinder::lengths(const ContactMaker& maker,
                                                     std::span<const dBodyID> bodies,
                                                     const LocalScope* scope, double h) const {
    double result = 1;
    const auto need = [&](double speed, double thickness) {
        result = std::max(result, speed * h / (thickness / 2));
    };
    std::vector<detail::MovingGeom> here;
    double fastest = 0, thinnest = maker.parameters().thickness;
    for (dGeomID geom : maker.geoms()) {
        const dBodyID body = dGeomGetBody(geom);
        if (scope != nullptr && body != nullptr && !scope->has(body)) continue;
        const detail::MovingGeom& moving = here.emplace_back(geom);
        fastest = std::max(fastest, moving.speed());
        thinnest = std::min(thinnest, moving.thickness);
    }
    for (dBodyID body : bodies) {
        if (dBodyIsEnabled(body) != 0) fastest = std::max(fastest, norm(linear_velocity(body)));
    }
    if (here.empty()) need(2 * fastest, thinnest);
    if (!(2 * fastest * h > thinnest / 2)) return 1;
    for (const detail::MovingGeom& one : here) {
        if (!is_plastic(one.body)) continue;
        for (const detail::MovingGeom& other : here) {
            const double speed =
                norm(difference(one.velocity, other.velocity)) + one.turning + other.turning;
            const double thin =
                std::min({one.thickness, other.thickness, maker.parameters().thickness});
            if (!(speed * h > thin / 2) || !one.may_reach(other, speed * h)) continue;
            if (one.may_touch(other)) need(speed, thin);
        }
    }
    return result;
}

} // namespace ductile::ode
