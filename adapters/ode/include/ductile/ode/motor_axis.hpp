// SPDX-License-Identifier: MIT
//
// One motor of an ODE joint as a row of the core: which joint and which of its axes, where the row
// acts, how its position is measured, and which parameters rule it. Works on joints that somebody
// else made; it owns nothing and never attaches or detaches anything.
//
//   kind            row                          position                           point of the
//   force hinge           turns about the axis         ODE's angle                        - slider
//   slides along the axis        ODE's position                     midway between bodies universal
//   turns about axis 1 or 2      ODE's angle                        - hinge-2         turns about
//   axis 1 or 2      ODE's angle where the axes are at  -
//                                                right angles, else increments
//   angular motor   turns about axis 0, 1 or 2   increments                         -
//   linear motor    slides along axis 0, 1 or 2  increments                         midway between
//   bodies
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
//   ask
//     which: `linear_motor_axis` wants to know.
//   - Angular motors in Euler mode have axes that are not of unit length: refused.
//
// Cost: O(1), no allocation. Not thread-safe.
#pragma once

#include <ode/ode.h>

#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "ductile/joint/inverse_mass.hpp"
#include "ductile/joint/rotation.hpp"
#include "ductile/numeric/ldlt.hpp"
#include "ductile/numeric/lu.hpp"
#include "ductile/ode/convert.hpp"
#include "ductile/vocabulary/angle.hpp"
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
    [[nodiscard]] dJointType kind() const noexcept { return kind_; }
    /// True where the position is a function of where the bodies are, false where it is summed up.
    [[nodiscard]] bool measured() const noexcept { return measured_; }

    /// A motor parameter: dParamVel, dParamFMax, dParamCFM, dParamLoStop, ...
    void set(int parameter, double value) const { set_motor(number_, parameter, value); }
    [[nodiscard]] double get(int parameter) const { return get_motor(number_, parameter); }

    /// Axis of the row, world, unit.
    [[nodiscard]] Vector3<double> axis() const { return axis_of(number_); }
    /// Axes of all motors of the joint as columns, world; zero where it has fewer than three.
    [[nodiscard]] Matrix3<double> axes() const {
        Matrix3<double> result = Matrix3<double>::Zero();
        for (int i = 0; i < motors_; ++i) result.col(i) = axis_of(i);
        return result;
    }

    /// Where the row acts, world [m]; for a turning row where the joint's pin is.
    [[nodiscard]] Vector3<double> point() const {
        dVector3 at;
        switch (kind_) {
            case dJointTypeHinge:
                if (bodies_.reversed) {
                    dJointGetHingeAnchor2(joint_, at);
                } else {
                    dJointGetHingeAnchor(joint_, at);
                }
                return to_core(at);
            case dJointTypeUniversal:
                dJointGetUniversalAnchor(joint_, at);
                return to_core(at);
            case dJointTypeHinge2:
                dJointGetHinge2Anchor(joint_, at);
                return to_core(at);
            case dJointTypeAMotor:
                if (const dJointID ball = pin()) {
                    dJointGetBallAnchor(ball, at);
                    return to_core(at);
                }
                return to_core(dBodyGetPosition(bodies_.a));
            default:
                break;
        }
        const Vector3<double> a = to_core(dBodyGetPosition(bodies_.a));
        return bodies_.b == nullptr ? a : (a + to_core(dBodyGetPosition(bodies_.b))) / 2;
    }

    /// Position of a measured kind [m | rad]; an angle is unwrapped near `predicted`.
    [[nodiscard]] double measure(double predicted) const {
        switch (kind_) {
            case dJointTypeSlider:
                return double(dJointGetSliderPosition(joint_));
            case dJointTypeHinge: {
                const double angle = double(dJointGetHingeAngle(joint_));
                return unwrap(bodies_.reversed ? -angle : angle, predicted);
            }
            case dJointTypeUniversal:
                return unwrap(double(number_ == 0 ? dJointGetUniversalAngle1(joint_)
                                                  : dJointGetUniversalAngle2(joint_)),
                              predicted);
            case dJointTypeHinge2:
                return unwrap(double(number_ == 0 ? dJointGetHinge2Angle1(joint_)
                                                  : -dJointGetHinge2Angle2(joint_)),
                              predicted);
            default:
                return predicted;
        }
    }

    [[nodiscard]] Placement placement() const {
        Placement now;
        now.position_a = to_core(dBodyGetPosition(bodies_.a));
        now.rotation_a = matrix_to_core(dBodyGetRotation(bodies_.a));
        if (bodies_.b == nullptr) return now;
        now.position_b = to_core(dBodyGetPosition(bodies_.b));
        now.rotation_b = matrix_to_core(dBodyGetRotation(bodies_.b));
        return now;
    }

    /// How far the row moved from `then`, when it acted at `where` along `axis_then`, until now.
    [[nodiscard]] double increment(const Placement& then, const Vector3<double>& axis_then,
                                   const Vector3<double>& where) const {
        const Placement now = placement();
        const Matrix3<double> turn_a = now.rotation_a * then.rotation_a.transpose();
        const Matrix3<double> turn_b = now.rotation_b * then.rotation_b.transpose();
        const Vector3<double> mean = (axis_then + axis()) / 2;
        if (turns()) return mean.dot(rotation_vector(turn_a) - rotation_vector(turn_b));
        const Vector3<double> a = now.position_a + turn_a * (where - then.position_a);
        const Vector3<double> b = now.position_b + turn_b * (where - then.position_b);
        return mean.dot(a - b);
    }

    /// Force of this motor in the joint's feedback [N | N m]; `axes` and `arm`, the row's point
    /// from A's centre of mass, as they were in that step. The other rows of a joint are at right
    /// angles to its motors, and the motors are told from each other by their axes.
    [[nodiscard]] double force(const dJointFeedback& feedback, const Matrix3<double>& axes,
                               const Vector3<double>& arm) const {
        const Vector3<double> linear = to_core(feedback.f1);
        const Vector3<double> whole =
            turns() ? Vector3<double>(to_core(feedback.t1) - arm.cross(linear)) : linear;
        if (motors_ == 1) return axes.col(0).dot(whole);
        return numeric::Lu<double, 3>(gram(axes)).solve(axes.transpose() * whole)[number_];
    }

    /// Of A minus B along the axis, as the bodies are now [m/s | rad/s].
    [[nodiscard]] double velocity() const {
        const auto& [a, b, reversed] = bodies_;
        const Vector3<double> wa = angular_velocity(a), wb = angular_velocity(b);
        if (turns()) return axis().dot(wa - wb);
        const Placement now = placement();
        const Vector3<double> at = point();
        return axis().dot(linear_velocity(a) + wa.cross(at - now.position_a) - linear_velocity(b) -
                          wb.cross(at - now.position_b));
    }

    /// h of axis_response, with what the joint holds beside the row: all five other axes of a hinge
    /// and a slider, pin and cross of a universal or hinge-2 (its suspension taken as rigid), the
    /// pin of a ball joint between the same bodies for an angular motor, nothing for a linear one.
    [[nodiscard]] Vector6<double> response(const BodyAtJoint<double>& a,
                                           const BodyAtJoint<double>& b) const {
        const Matrix6<double> k = inverse_mass_at_joint(a, b);
        Vector6<double> row = Vector6<double>::Zero();
        row.segment<3>(turns() ? 3 : 0) = axis();
        Eigen::Matrix<double, 6, 4> held = Eigen::Matrix<double, 6, 4>::Zero();
        held.topLeftCorner<3, 3>().setIdentity();
        switch (kind_) {
            case dJointTypeUniversal:
            case dJointTypeHinge2:
                held.col(3).tail<3>() = axis_of(0).cross(axis_of(1)).normalized();
                return axis_response(k, row, held);
            case dJointTypeAMotor:
                return axis_response(k, row, held.leftCols(pin() ? 3 : 0));
            case dJointTypeLMotor:
                return axis_response(k, row, held.leftCols(0));
            default:
                return numeric::solve_semidefinite(k, row);
        }
    }

    /// Distance of B's half of the pin from A's [m]: what ODE pulls together by its ERP; NaN for
    /// kinds without a pin of their own. `point`: as returned by point().
    [[nodiscard]] Vector3<double> pin_error(const Vector3<double>& point) const {
        dVector3 other;
        switch (kind_) {
            case dJointTypeHinge:
                if (bodies_.reversed) {
                    dJointGetHingeAnchor(joint_, other);
                } else {
                    dJointGetHingeAnchor2(joint_, other);
                }
                return to_core(other) - point;
            case dJointTypeUniversal:
                dJointGetUniversalAnchor2(joint_, other);
                return bodies_.reversed ? Vector3<double>(point - to_core(other))
                                        : Vector3<double>(to_core(other) - point);
            default:
                return Vector3<double>::Constant(std::nan(""));
        }
    }

    friend MotorAxis hinge_axis(dJointID hinge);
    friend MotorAxis slider_axis(dJointID slider);
    friend MotorAxis universal_axis(dJointID universal, int number);
    friend MotorAxis hinge2_axis(dJointID hinge2, int number);
    friend MotorAxis angular_motor_axis(dJointID motor, int number);
    friend MotorAxis linear_motor_axis(dJointID motor, int number, int relative_to);

  private:
    static void require(bool right, const std::string& what) {
        if (!right) throw std::invalid_argument("MotorAxis." + what);
    }

    MotorAxis(dJointID joint, dJointType kind, const char* name, int number, int motors)
        : joint_(joint), kind_(kind), number_(number), motors_(motors) {
        require(joint != nullptr, "joint = null: must be a joint");
        require(dJointGetType(joint) == kind, std::string("joint: must be ODE's ") + name);
        require(number >= 0 && number < motors, "number = " + std::to_string(number) +
                                                    ": must be one of the joint's " +
                                                    std::to_string(motors) + " axes");
        bodies_ = attached_bodies(joint);
        require(bodies_.a != nullptr, "joint: must be attached to a body");
    }

    /// Products of the axes among each other, with one for each that is not there.
    static Matrix3<double> gram(const Matrix3<double>& axes) {
        Matrix3<double> result = axes.transpose() * axes;
        for (int i = 0; i < 3; ++i) {
            if (result(i, i) == 0) result(i, i) = 1;
        }
        return result;
    }
    void require_independent_axes() const {
        constexpr double flat = 1e-6;
        require(numeric::determinant(gram(axes())) > flat,
                "joint: its axes must be independent, else the force of one cannot be told from "
                "another");
    }

    void set_motor(int number, int parameter, double value) const {
        const int p = parameter + dParamGroup * number;
        switch (kind_) {
            case dJointTypeHinge:
                dJointSetHingeParam(joint_, p, dReal(value));
                break;
            case dJointTypeSlider:
                dJointSetSliderParam(joint_, p, dReal(value));
                break;
            case dJointTypeUniversal:
                dJointSetUniversalParam(joint_, p, dReal(value));
                break;
            case dJointTypeHinge2:
                dJointSetHinge2Param(joint_, p, dReal(value));
                break;
            case dJointTypeAMotor:
                dJointSetAMotorParam(joint_, p, dReal(value));
                break;
            default:
                dJointSetLMotorParam(joint_, p, dReal(value));
                break;
        }
    }
    [[nodiscard]] double get_motor(int number, int parameter) const {
        const int p = parameter + dParamGroup * number;
        switch (kind_) {
            case dJointTypeHinge:
                return double(dJointGetHingeParam(joint_, p));
            case dJointTypeSlider:
                return double(dJointGetSliderParam(joint_, p));
            case dJointTypeUniversal:
                return double(dJointGetUniversalParam(joint_, p));
            case dJointTypeHinge2:
                return double(dJointGetHinge2Param(joint_, p));
            case dJointTypeAMotor:
                return double(dJointGetAMotorParam(joint_, p));
            default:
                return double(dJointGetLMotorParam(joint_, p));
        }
    }

    [[nodiscard]] Vector3<double> axis_of(int number) const {
        dVector3 result;
        switch (kind_) {
            case dJointTypeHinge:
                dJointGetHingeAxis(joint_, result);
                break;
            case dJointTypeSlider:
                dJointGetSliderAxis(joint_, result);
                // the motor of a slider attached to (null, body), unlike that of a hinge, is turned
                // round
                if (bodies_.reversed) return -to_core(result);
                break;
            case dJointTypeUniversal:
                number == 0 ? dJointGetUniversalAxis1(joint_, result)
                            : dJointGetUniversalAxis2(joint_, result);
                break;
            case dJointTypeHinge2:
                number == 0 ? dJointGetHinge2Axis1(joint_, result)
                            : dJointGetHinge2Axis2(joint_, result);
                break;
            case dJointTypeAMotor:
                dJointGetAMotorAxis(joint_, number, result);
                break;
            default:
                return linear_axis(number);
        }
        return to_core(result);
    }

    [[nodiscard]] Vector3<double> linear_axis(int number) const {
        dVector3 stored;
        dJointGetLMotorAxis(joint_, number, stored);
        const dBodyID frame = relative_to_ == 0   ? nullptr
                              : relative_to_ == 1 ? bodies_.a
                                                  : bodies_.b;
        if (frame == nullptr) return to_core(stored);
        return matrix_to_core(dBodyGetRotation(frame)) * to_core(stored);
    }

    /// A ball joint between the same two bodies, if there is one.
    [[nodiscard]] dJointID pin() const {
        for (int i = 0; i < dBodyGetNumJoints(bodies_.a); ++i) {
            const dJointID other = dBodyGetJoint(bodies_.a, i);
            if (dJointGetType(other) != dJointTypeBall || dJointIsEnabled(other) == 0) continue;
            const AttachedBodies pair = attached_bodies(other);
            const bool same = pair.a == bodies_.a && pair.b == bodies_.b;
            const bool swapped = pair.a == bodies_.b && pair.b == bodies_.a;
            if (same || swapped) return other;
        }
        return nullptr;
    }

    dJointID joint_;
    dJointType kind_;
    int number_;
    int motors_;
    int relative_to_ = 0; ///< of linear motors: 0 world, 1 first body, 2 second body
    bool measured_ = true;
    AttachedBodies bodies_;
};

} // namespace ductile::ode
