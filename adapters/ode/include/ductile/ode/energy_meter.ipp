// SPDX-License-Identifier: MIT
//
// Bodies of energy_meter.hpp.
#pragma once

#include <cstddef>
#include <utility>

#include "ductile/ode/convert.hpp"
#include "ductile/ode/energy_meter.hpp"

namespace ductile::ode {

namespace detail {

/// A clamped member that is whole is kinematic too, and moves nothing.
[[nodiscard]] DUCTILE_INLINE bool drives(dBodyID body) {
    if (!DrivenPair::is_driven(body)) return false;
    const Vector3<double> velocity = linear_velocity(body), spin = angular_velocity(body);
    return dot(velocity, velocity) + dot(spin, spin) > 0;
}

} // namespace detail

DUCTILE_INLINE void EnergyMeter::list_bodies(std::vector<MeteredBody>& bodies) const {
    const Vector3<double> gravity = gravity_of(world_);
    for (const dBodyID body : listed()) {
        MeteredBody& entry = bodies.emplace_back();
        entry.body = body;
        entry.position = to_core(dBodyGetPosition(body));
        entry.velocity = linear_velocity(body);
        entry.spin = angular_velocity(body);
        entry.mass = mass(body);
        entry.inertia = inertia(body);
        if (dBodyGetGravityMode(body) != 0) entry.weight = scaled(entry.mass, gravity);
        entry.force = to_core(dBodyGetForce(body));
        entry.torque = to_core(dBodyGetTorque(body));
        entry.asleep = dBodyIsEnabled(body) == 0;
    }
}

DUCTILE_INLINE void EnergyMeter::list_plastic_joints(
    std::vector<MeteredPlasticJoint>& joints) const {
    if (out_) return;
    for (const PlasticConstraint* constraint : plastic_) {
        const auto [a, b, reversed] = constraint->bodies();
        joints.push_back({&constraint->queries(), a, b});
    }
}

DUCTILE_INLINE void EnergyMeter::watch_step() {
    take_feedback_back(); // of a step that was never made
    seen_.clear();
    std::size_t most = 0;
    for (const dBodyID body : listed()) most += std::size_t(dBodyGetNumJoints(body));
    feedback_.assign(most, dJointFeedback{}); // its places stay where they are
    std::size_t lent = 0;
    for (const dBodyID body : listed()) {
        for (int i = 0; i < dBodyGetNumJoints(body); ++i) {
            const dJointID id = dBodyGetJoint(body, i);
            if (dJointIsEnabled(id) == 0 || seen_.enter(id) < watched_.size()) continue;
            const bool lend = dJointGetFeedback(id) == nullptr;
            if (lend) dJointSetFeedback(id, &feedback_[lent++]);
            const AttachedBodies bodies = attached_bodies(id);
            watched_.push_back({id, bodies, dJointGetFeedback(id), lend, OwnAxes::of(id, bodies)});
        }
    }
}

DUCTILE_INLINE void EnergyMeter::list_joints(std::vector<MeteredJoint>& joints) const {
    AddressMap<const dJointFeedback*> of_plastic;
    for (const PlasticConstraint* constraint : plastic_) {
        if (seen_.has(constraint->id())) of_plastic[constraint->id()] = nullptr;
    }
    for (const auto& [id, bodies, feedback, lent, own] : watched_) {
        if (contacts_.find(id) != nullptr) continue;
        if (const dJointFeedback** of = of_plastic.find(id)) {
            *of = feedback;
            continue;
        }
        MeteredJoint& joint = joints.emplace_back();
        joint = {id,
                 nullptr,
                 bodies.a,
                 bodies.b,
                 to_core(feedback->f1),
                 to_core(feedback->t1),
                 to_core(feedback->f2),
                 to_core(feedback->t2),
                 nullptr,
                 detail::drives(bodies.a) || detail::drives(bodies.b),
                 own.powered};
        joint.own_force = own.force(joint.force_a);
        const Vector3<double> moment = own.moment(joint.force_a, joint.torque_a);
        joint.own_torque_a = sum(cross(own.arm_a, joint.own_force), moment);
        joint.own_torque_b = sum(cross(own.arm_b, joint.own_force), moment);
    }
    for (const PlasticConstraint* constraint : plastic_) {
        const dJointFeedback** found = of_plastic.find(constraint->id());
        if (found == nullptr) continue;
        const auto [a, b, reversed] = constraint->bodies();
        const OutsideForce& outside = constraint->outside_force();
        MeteredJoint& joint = joints.emplace_back();
        joint = {constraint->id(),
                 nullptr,
                 a,
                 b,
                 outside.force,
                 outside.torque_a,
                 scaled(-1, outside.force),
                 outside.torque_b,
                 &constraint->queries(),
                 DrivenPair::is_driven(a) || DrivenPair::is_driven(b)};
        // all motors of one of ODE's joints share its feedback: the first has it
        const dJointFeedback* feedback = std::exchange(*found, nullptr);
        if (feedback == nullptr) continue;
        joint.force_a = sum(joint.force_a, to_core(feedback->f1));
        joint.torque_a = sum(joint.torque_a, to_core(feedback->t1));
        joint.force_b = sum(joint.force_b, to_core(feedback->f2));
        joint.torque_b = sum(joint.torque_b, to_core(feedback->t2));
    }
}

DUCTILE_INLINE void EnergyMeter::list_contacts(double dt,
                                               std::vector<MeteredContact>& contacts) const {
    for (const auto& [id, bodies, feedback, lent, own] : watched_) {
        const ContactPlace* contact = contacts_.find(id);
        if (contact == nullptr) continue;
        const auto& [a, b, reversed] = bodies;
        const Vector3<double> point = to_core(contact->geometry.pos);
        const Vector3<double> normal = to_core(contact->geometry.normal);
        const Vector3<double> impulse = scaled(dt, to_core(feedback->f1));
        const Vector3<double> pressed = scaled(dot(normal, impulse), normal);
        contacts.push_back({a, b, point, point, pressed, difference(impulse, pressed),
                            detail::drives(a) || detail::drives(b)});
        contacts.back().gives = contact->gives;
    }
}

DUCTILE_INLINE void EnergyMeter::end_watch() {
    take_feedback_back();
    contacts_.clear();
}

DUCTILE_INLINE void EnergyMeter::take_feedback_back() {
    for (const auto& [id, bodies, feedback, lent, own] : watched_) {
        // a contact that was made since may have the place of one that is gone, and another's
        if (lent && dJointGetFeedback(id) == feedback) dJointSetFeedback(id, nullptr);
    }
    watched_.clear();
}

DUCTILE_INLINE Vector3<double> EnergyMeter::gyroscopic_impulse(const MeteredBody& body,
                                                               double dt) const {
    const auto* id = static_cast<const dxBody*>(body.body);
    return ode::gyroscopic_impulse(const_cast<dBodyID>(id), body.inertia, body.spin, dt);
}

} // namespace ductile::ode
