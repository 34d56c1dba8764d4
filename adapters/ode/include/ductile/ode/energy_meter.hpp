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

#include <span>
#include <vector>

#include "ductile/ode/local_scope.hpp"
#include "ductile/ode/own_axes.hpp"
#include "ductile/ode/plastic_constraint.hpp"
#include "ductile/vocabulary/address_book.hpp"
#include "ductile/vocabulary/linkage.hpp"
#include "ductile/world/energy_meter.hpp"

namespace ductile::ode {

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

    DUCTILE_INLINE void list_bodies(std::vector<MeteredBody>& bodies) const override;
    DUCTILE_INLINE void list_plastic_joints(
        std::vector<MeteredPlasticJoint>& joints) const override;
    DUCTILE_INLINE void watch_step() override;
    DUCTILE_INLINE void list_joints(std::vector<MeteredJoint>& joints) const override;
    DUCTILE_INLINE void list_contacts(double dt,
                                      std::vector<MeteredContact>& contacts) const override;
    DUCTILE_INLINE void end_watch() override;
    [[nodiscard]] DUCTILE_INLINE Vector3<double> gyroscopic_impulse(const MeteredBody& body,
                                                                    double dt) const override;
    void take_feedback_back();

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

#ifndef DUCTILE_COMPILED
#include "ductile/ode/energy_meter.ipp"
#endif
