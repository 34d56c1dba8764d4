// SPDX-License-Identifier: MIT
//
// Makes one axis of a joint that a world already has plastic, without touching the joint otherwise:
//
//   ductile::ode::PlasticMotor elbow(ductile::ode::universal_axis(joint, 0),
//                                    ductile::OneAxisJoint(ductile::Perfect<double>({.strength =
//                                    64})));
//   elbow.add_to(stepper);
//
// The axes are those of joint_axes.hpp: hinge, slider, either axis of a universal or hinge-2, any
// axis of an angular or linear motor. Several motors of one joint may be plastic at once, each by
// its own law. Where the bodies are when the motor is taken over is the rest position.
//
// What is the user's stays the user's: the joint is neither made, attached nor destroyed here;
// velocity, strength and CFM of the motor are put back when this object ends (the strength of a
// broken axis stays zero); a joint feedback that the user set, before or after, is only read, and
// where there is none one is set while this object lives. The joint has to outlive this object, but
// for one that goes with its world. At a break it lets go of its bodies, unless told to release the
// axis alone.
#pragma once

#include <ode/ode.h>

#include <utility>

#include "ductile/joint/one_axis_joint.hpp"
#include "ductile/law/perfect.hpp"
#include "ductile/ode/joint_axes.hpp"
#include "ductile/ode/one_axis_constraint.hpp"

namespace ductile::ode {

template <class Joint = OneAxisJoint<Perfect<double>>>
class PlasticMotor final : public AxisConstraint<Joint, OneAxisConstraint> {
    using Base = AxisConstraint<Joint, OneAxisConstraint>;

  public:
    /// @throws std::invalid_argument where a stop is set on the axis.
    PlasticMotor(const MotorAxis& axis, Joint joint, AtBreak at_break = AtBreak::disable_joint)
        : Base(std::move(joint), axis, at_break, false),
          velocity_(axis.get(dParamVel)),
          strength_(axis.get(dParamFMax)),
          cfm_(axis.get(dParamCFM)) {}

    ~PlasticMotor() override {
        if (!this->world_goes_on()) return;
        this->row().set(dParamVel, velocity_);
        this->row().set(dParamFMax, this->broken() ? 0 : strength_);
        this->row().set(dParamCFM, cfm_);
    }

  private:
    double velocity_; ///< the user's own
    double strength_;
    double cfm_;
};

#ifdef DUCTILE_COMPILED
extern template class PlasticMotor<UsualAxisJoint>;
#endif

} // namespace ductile::ode
