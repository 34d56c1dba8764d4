// SPDX-License-Identifier: MIT
//
// One motor of an ODE joint as a row of the core: which joint and which of its axes, where the row
// acts, how its position is measured, and which parameters rule it. Works on joints that somebody
// else made; it owns nothing and never attaches or detaches anything.
//
//   kind           row                           position           point of the force
//   hinge          turns about the axis          ODE's angle        -
//   slider         slides along the axis         ODE's position     midway between bodies
//   universal      turns about axis 1 or 2       ODE's angle        -
//   hinge-2        turns about axis 1 or 2       ODE's angle (*)    -
//   angular motor  turns about axis 0, 1 or 2    increments         -
//   linear motor   slides along axis 0, 1 or 2   increments         midway between bodies
//
//   (*) where the axes are at right angles, else increments
//
// "Midway" is between the two centres of mass; a joint to the static world acts at the centre of
// mass of its one body. "Increments": the bodies' turning or displacement along the axis over each
// step, summed up; the axis is taken as the mean of that before and after the step. Such a position
// is zero when the motor is taken over.
//
// Sense. The row's velocity is u = axis · (motion of A - motion of B), and the position grows with
// u, for every kind. A and B are the joint's first and second body; where the joint was attached to
// (null, body), A is the body. That is ODE's own sense of a motor; ODE's angle of a hinge attached
// to (null, body), and its second angle of a hinge-2, have the opposite sign.
//
// Traps of ODE 0.16 that this header deals with
//   - Universal attached to (null, body): ODE swaps the axes and not the motors. Refused.
//   - The axis of a linear motor is returned in the frame it was given relative to, and nobody can
//     ask which: `linear_motor_axis` wants to know.
//   - Angular motors in Euler mode have axes that are not of unit length: refused.
//
// Cost: O(1), no allocation. Not thread-safe.
#pragma once

#include <ode/ode.h>

#include <string>

#include "ductile/joint/inverse_mass.hpp"
#include "ductile/ode/convert.hpp"
#include "ductile/ode/joint_calls.hpp"
#include "ductile/vocabulary/linkage.hpp"
#include "ductile/vocabulary/vector.hpp"

namespace ductile::ode {

/// Where the bodies of a joint are.
struct Placement {
    Vector3<double> position_a{0, 0, 0}; ///< centre of mass [m]
    Vector3<double> position_b{0, 0, 0};
    Matrix3<double> rotation_a = Matrix3<double>::Identity();
    Matrix3<double> rotation_b = Matrix3<double>::Identity();
};

class MotorAxis {
  public:
    [[nodiscard]] dJointID joint() const noexcept { return joint_; }
    /// Which of the joint's motors, from 0.
    [[nodiscard]] int number() const noexcept { return number_; }
    [[nodiscard]] const AttachedBodies& bodies() const noexcept { return bodies_; }
    /// True while the joint is attached as it was when the motor was taken over.
    [[nodiscard]] bool attached() const noexcept {
        return attached_bodies(joint_) == bodies_ && bodies_.a != nullptr;
    }
    /// True where the row turns, false where it slides.
    [[nodiscard]] bool turns() const noexcept {
        return kind_ != dJointTypeSlider && kind_ != dJointTypeLMotor;
    }
    /// True where the position is a function of where the bodies are, false where it is summed up.
    [[nodiscard]] bool measured() const noexcept { return measured_; }

    /// A motor parameter: dParamVel, dParamFMax, dParamCFM, dParamLoStop, ...
    void set(int parameter, double value) const {
        calls_.set(joint_, parameter + dParamGroup * number_, dReal(value));
    }
    [[nodiscard]] double get(int parameter) const {
        return double(calls_.get(joint_, parameter + dParamGroup * number_));
    }

    /// Axis of the row, world, unit.
    [[nodiscard]] Vector3<double> axis() const { return axis_of(number_); }
    /// Axes of all motors of the joint as columns, world; zero where it has fewer than three.
    [[nodiscard]] Matrix3<double> axes() const;

    /// Where the row acts, world [m]; for a turning row where the joint's pin is.
    [[nodiscard]] Vector3<double> point() const;

    /// Position of a measured kind [m | rad]; an angle is unwrapped near `predicted`.
    [[nodiscard]] double measure(double predicted) const;

    [[nodiscard]] Placement placement() const;

    /// How far the row moved from `then`, when it acted at `where` along `axis_then`, until now.
    [[nodiscard]] double increment(const Placement& then, const Vector3<double>& axis_then,
                                   const Vector3<double>& where) const;

    /// Force of this motor in the joint's feedback [N | N m]; `axes` and `arm`, the row's point
    /// from A's centre of mass, as they were in that step. The other rows of a joint are at right
    /// angles to its motors, and the motors are told from each other by their axes.
    [[nodiscard]] double force(const dJointFeedback& feedback, const Matrix3<double>& axes,
                               const Vector3<double>& arm) const;

    /// h of axis_response, with what the joint holds beside the row: all five other axes of a hinge
    /// and a slider, pin and cross of a universal or hinge-2 (its suspension taken as rigid), the
    /// pin of a ball joint between the same bodies for an angular motor, nothing for a linear one.
    [[nodiscard]] Vector6<double> response(const BodyAtJoint<double>& a,
                                           const BodyAtJoint<double>& b) const;

    /// Distance of B's half of the pin from A's [m]: what ODE pulls together by its ERP; NaN for
    /// kinds without a pin of their own. `point`: as returned by point().
    [[nodiscard]] Vector3<double> pin_error(const Vector3<double>& point) const;

    friend MotorAxis hinge_axis(dJointID hinge);
    friend MotorAxis slider_axis(dJointID slider);
    friend MotorAxis universal_axis(dJointID universal, int number);
    friend MotorAxis hinge2_axis(dJointID hinge2, int number);
    friend MotorAxis angular_motor_axis(dJointID motor, int number);
    friend MotorAxis linear_motor_axis(dJointID motor, int number, int relative_to);

  private:
    static void require(bool right, const std::string& what);

    MotorAxis(dJointID joint, dJointType kind, const char* name, int number, int motors);

    /// Products of the axes among each other, with one for each that is not there.
    static Matrix3<double> gram(const Matrix3<double>& axes);
    void require_independent_axes() const;

    [[nodiscard]] Vector3<double> axis_of(int number) const;

    [[nodiscard]] Vector3<double> linear_axis(int number) const;

    /// A ball joint between the same two bodies, if there is one.
    [[nodiscard]] dJointID pin() const;

    dJointID joint_;
    dJointType kind_;
    JointCalls calls_;
    int number_;
    int motors_;
    int relative_to_ = 0; ///< of linear motors: 0 world, 1 first body, 2 second body
    bool measured_ = true;
    AttachedBodies bodies_;
};

} // namespace ductile::ode

#ifndef DUCTILE_COMPILED
#include "ductile/ode/motor_axis.ipp"
#endif
