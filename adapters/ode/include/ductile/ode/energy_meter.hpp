// SPDX-License-Identifier: MIT
//
// The core's energy ledger of an ODE world (world/energy_meter.hpp): which bodies, joints and
// contacts there are. Joints are booked by their feedback and by what a plastic constraint applies
// beside it. ODE's damping and its limit of angular speed are not booked: where a scene uses them
// they stay unexplained.
//
//   EnergyMeter meter(world_id);
//   meter.add(body);                                  // every dynamic body, once
//   ... collide: meter.add_contact(joint, geometry);  // every contact joint of this step
//   meter.before_step();
//   stepper.step(dt);
//   meter.after_step(dt);
//
// The meter turns on joint feedback for joints that have none (the user's own is only read).
//
// Not thread-safe.
#pragma once

#include <ode/ode.h>

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "ductile/ode/convert.hpp"
#include "ductile/ode/local_scope.hpp"
#include "ductile/ode/own_axes.hpp"
#include "ductile/ode/plastic_constraint.hpp"
#include "ductile/vocabulary/address_book.hpp"
#include "ductile/world/energy_meter.hpp"

namespace ductile::ode {

namespace detail {

/// A clamped member that is whole is kinematic too, and moves nothing.
[[nodiscard]] inline bool drives(dBodyID body) {
    if (!DrivenPair::is_driven(body)) return false;
    const Vector3<double> velocity = linear_velocity(body), spin = angular_velocity(body);
    return dot(velocity, velocity) + dot(spin, spin) > 0;
}

} // namespace detail

class EnergyMeter final : public ductile::EnergyMeter {
  public:
    explicit EnergyMeter(dWorldID world) : world_(world) {}

    /// Watches a dynamic body.
    void add(dBodyID body) { bodies_.push_back(body); }
    /// To be called before the body is destroyed: what it holds leaves the ledger as supplied
    /// (negative).
    void remove(dBodyID body) { std::erase(bodies_, body); }
    /// Watches a plastic constraint, so that its share of the joints' work is booked as plastic.
    void add(const PlasticConstraint& constraint) { plastic_.push_back(&constraint); }
    /// To be called before the constraint is destroyed; what it stores leaves as with a body.
    void remove(const PlasticConstraint& constraint) { std::erase(plastic_, &constraint); }
    /// Names a contact joint of the coming step, so that its work is booked as contact and
    /// friction. `gives`: it gives way.
    void add_contact(dJointID joint, const dContactGeom& geometry, bool gives = false) {
        contacts_[joint] = {geometry, gives};
    }
    /// Of the scope's bodies alone, or first of those that are out of it, which have no plastic
    /// joint; null: of all. What the others hold is taken to stay.
    void set_scope(const LocalScope* scope, bool out = false) {
        scope_ = scope;
        out_ = out;
        narrow(scope == nullptr, out);
    }
    /// Contacts of the step were named after `before_step`, or nobody books it: they have feedback
    /// until it is over.
    void look_at_contacts() { watch_step(); }
    /// It was not booked.
    void step_is_over() { end_watch(); }
    /// Energy that all rows of a joint took from the bodies since the meter was made [J].
    [[nodiscard]] double taken_by(dJointID joint) const { return taken_by_address(joint); }

  private:
    /// A joint's feedback in this step.
    struct WatchedJoint {
        dJointID id;
        AttachedBodies bodies; ///< that a break may take from it
        const dJointFeedback* feedback;
        bool lent;
        OwnAxes own; ///< as it is solved
    };

    struct ContactPlace {
        dContactGeom geometry;
        bool gives;
    };

    void list_bodies(std::vector<MeteredBody>& bodies) const override {
        const Vector3<double> gravity = gravity_of(world_);
        for (const dBodyID body : listed()) {
            MeteredBody& entry = bodies.emplace_back();
            entry.body = body;
            entry.position = to_core(dBodyGetPosition(body));
            entry.velocity = linear_velocity(body);
            entry.spin = angular_velocity(body);
            dMass m;
            dBodyGetMass(body, &m);
            entry.mass = double(m.mass);
            entry.inertia = sandwiched(matrix_to_core(dBodyGetRotation(body)), matrix_to_core(m.I));
            if (dBodyGetGravityMode(body) != 0) entry.weight = scaled(entry.mass, gravity);
            entry.force = to_core(dBodyGetForce(body));
            entry.torque = to_core(dBodyGetTorque(body));
            entry.asleep = dBodyIsEnabled(body) == 0;
        }
    }
    void list_plastic_joints(std::vector<MeteredPlasticJoint>& joints) const override {
        if (out_) return;
        for (const PlasticConstraint* constraint : plastic_) {
            const auto [a, b, reversed] = constraint->bodies();
            joints.push_back({&constraint->queries(), a, b});
        }
    }
    void watch_step() override {
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
                watched_.push_back(
                    {id, bodies, dJointGetFeedback(id), lend, OwnAxes::of(id, bodies)});
            }
        }
    }
    void list_joints(std::vector<MeteredJoint>& joints) const override {
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
    void list_contacts(double dt, std::vector<MeteredContact>& contacts) const override {
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
    void end_watch() override {
        take_feedback_back();
        contacts_.clear();
    }
    [[nodiscard]] Vector3<double> gyroscopic_impulse(const MeteredBody& body,
                                                     double dt) const override {
        const auto* id = static_cast<const dxBody*>(body.body);
        return ode::gyroscopic_impulse(const_cast<dBodyID>(id), body.inertia, body.spin, dt);
    }
    void take_feedback_back() {
        for (const auto& [id, bodies, feedback, lent, own] : watched_) {
            // a contact that was made since may have the place of one that is gone, and another's
            if (lent && dJointGetFeedback(id) == feedback) dJointSetFeedback(id, nullptr);
        }
        watched_.clear();
    }

    /// Those of the scope.
    [[nodiscard]] std::span<const dBodyID> listed() const {
        if (scope_ == nullptr) return bodies_;
        return out_ ? scope_->out() : scope_->in();
    }

    dWorldID world_;
    const LocalScope* scope_ = nullptr;
    bool out_ = false;
    std::vector<dBodyID> bodies_;
    std::vector<const PlasticConstraint*> plastic_;
    AddressMap<ContactPlace> contacts_;    ///< by joint
    std::vector<WatchedJoint> watched_;    ///< each joint of the watched bodies, once
    AddressBook seen_;                     ///< these
    std::vector<dJointFeedback> feedback_; ///< to be lent
};

} // namespace ductile::ode
