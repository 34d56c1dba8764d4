// SPDX-License-Identifier: MIT
//
// An ODE joint whose motor is a plastic row: what PlasticHinge and PlasticSlider share. The joint's
// five rigid rows are ODE's; FMax is the strength, Vel the target velocity, and the joint feedback
// the reaction. The plasticity is the core's joint.
//
// Body A moves relative to body B (null: the static world):
//   u = axis · (ω_A - ω_B)              turning                                       [rad/s]
//   u = axis · (v_A - v_B)              sliding, taken midway between the two bodies  [m/s]
//
// Traps of ODE 0.16 that this header deals with
//   - A motor together with an active stop becomes an outside torque: no stops are set here, and
//     none must be set on `id()`.
//   - Feedback sums all six rows in world axes about the centre of mass: projected on the row here.
//   - A body turns by the first-order rule unless dBodySetFiniteRotationMode(body, 1) is set, which
//     loses (ω dt)³/12 rad a step: set it where plastic rotations per step are large.
//
// Not thread-safe.
#pragma once

#include <ode/ode.h>

#include <array>
#include <limits>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "ductile/joint/one_axis_joint.hpp"
#include "ductile/joint/pair.hpp"
#include "ductile/law/back_force.hpp"
#include "ductile/ode/convert.hpp"
#include "ductile/ode/world.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile::ode {

/// What an energy account needs to know of a plastic constraint of any kind.
class PlasticConstraint : public SteppedConstraint {
  public:
    [[nodiscard]] virtual double absorbed_energy() const = 0;      ///< D [J]
    /// Of the break, if there was one.
    [[nodiscard]] virtual const BreakRelease<double>& release() const = 0;
    [[nodiscard]] virtual dJointID id() const = 0;
};

template <class Joint>
class OneAxisConstraint : public PlasticConstraint {
    using BackForce = std::remove_cvref_t<decltype(std::declval<const Joint&>().law().back())>;
    static_assert(std::is_same_v<BackForce, NoBackForce<typename Joint::Scalar>>,
                  "ODE's motors are equally strong both ways: no law with a back force");

  public:
    OneAxisConstraint(const OneAxisConstraint&) = delete;
    OneAxisConstraint& operator=(const OneAxisConstraint&) = delete;
    ~OneAxisConstraint() override { dJointDestroy(id_); }

    void add_to(World& world) { world.add(*this); }
    void remove_from(World& world) { world.remove(*this); }

    /// Accumulated plastic travel p, work-conjugate, never decreases [m | rad].
    [[nodiscard]] double plastic_travel() const { return joint_.state().plastic_travel; }
    /// Geometric rest position q_p [m | rad].
    [[nodiscard]] double plastic_offset() const { return joint_.state().plastic_offset; }
    /// Position of body A relative to body B, not wrapped [m | rad].
    [[nodiscard]] double position() const { return position_; }
    /// Velocity of body A relative to body B after the last step's solve [m/s | rad/s].
    [[nodiscard]] double velocity() const { return joint_.state().velocity; }
    /// Force of the plastic row in the last step, positive where it pushes A along +axis [N | N m].
    [[nodiscard]] double reaction() const { return force_; }
    /// Energy dissipated by plastic flow [J].
    [[nodiscard]] double absorbed_energy() const override { return joint_.state().plastic_work; }
    [[nodiscard]] bool broken() const { return joint_.state().broken; }
    /// Unreliable where the solver left the plastic row or one of the rigid ones unsolved.
    [[nodiscard]] Outcome outcome() const {
        const auto& p = joint_.parameters();
        const bool unsolved = rigid_residual_.head<3>().norm() >
                                  p.absolute_residual + p.relative_residual * speed_[0] ||
                              rigid_residual_.tail<3>().norm() >
                                  p.absolute_residual + p.relative_residual * speed_[1];
        return unsolved && last_.outcome != Outcome::broken ? Outcome::unreliable : last_.outcome;
    }
    /// Certificate: violation of the plastic row in the last step, and the largest so far
    /// [m/s | rad/s].
    [[nodiscard]] double residual() const { return last_.residual; }
    [[nodiscard]] double residual_max() const { return joint_.state().residual_max; }
    /// Violation of the rigid rows in the last step [m/s | rad/s]; known for hinges only.
    [[nodiscard]] double rigid_residual() const { return rigid_residual_.cwiseAbs().maxCoeff(); }

    [[nodiscard]] const Joint& joint() const { return joint_; }
    [[nodiscard]] const BreakRelease<double>& release() const override { return release_; }
    /// ODE's joint; owned by this object.
    [[nodiscard]] dJointID id() const override { return id_; }

    /// Sets the motor for a step of `dt` [s]. Called by World::step.
    void prepare(double dt) override {
        if (joint_.state().broken) return;
        locate();
        position_ = measure(position_);
        rigid_target_ = rigid_target(dt);
        const double velocity = row_velocity();
        const RowLimits<double> limits = joint_.prepare({position_, velocity}, dt);
        // FMax is one number: that of the side to which the row moves
        set_motor(dReal(limits.bias), dReal(velocity < 0 ? limits.upper : -limits.lower));
    }

    /// Books the step; after a break disables the joint. Called by World::step.
    void commit(double dt) override {
        if (joint_.state().broken) return;
        const double velocity = row_velocity();
        certify_rigid_rows();
        force_ = row_force();
        position_ = measure(position_ + velocity * dt);
        last_ = joint_.commit({force_, velocity, position_}, dt);
        if (last_.outcome == Outcome::broken) {
            dJointDisable(id_);
            if (last_.release > 0) hand_back(last_.release);
        }
    }

  protected:
    /// Takes over `id`, freshly made in its world; `a` must not be null.
    /// @throws std::invalid_argument where `a` is null.
    OneAxisConstraint(dJointID id, dBodyID a, dBodyID b, Joint joint)
        : id_(id), a_(a), b_(b), joint_(std::move(joint)) {
        try {
            require_rigid(joint_.parameters().stiffness);
            if (a == nullptr) {
                throw std::invalid_argument(
                    "OneAxisConstraint.a = null: must be a body (only b may be the static world)");
            }
        } catch (...) {
            dJointDestroy(id);
            throw;
        }
        dJointAttach(id_, a_, b_);
        dJointSetFeedback(id_, &feedback_);
    }

    /// To be called by the constructor of the kind, when anchor and axis are set: the joint starts
    /// where the bodies are now.
    void start() {
        auto state = joint_.state();
        position_ = state.plastic_offset = measure(0);
        joint_.restore(state);
    }

    [[nodiscard]] dBodyID a() const noexcept { return a_; }
    [[nodiscard]] dBodyID b() const noexcept { return b_; }

    /// Position of A relative to B [m | rad]; a kind that wraps unwraps it near `predicted`.
    [[nodiscard]] virtual double measure(double predicted) const = 0;
    /// Axis of the row, world, unit.
    [[nodiscard]] virtual Vector3<double> axis() const = 0;
    /// Where the row acts, world [m].
    [[nodiscard]] virtual Vector3<double> point() const = 0;
    /// True where the plastic row turns, false where it slides.
    [[nodiscard]] virtual bool turns() const noexcept = 0;
    /// Velocities that the rigid rows ask for in a step of `dt` [s], linear and angular, world axes; NaN
    /// where they are not known.
    [[nodiscard]] virtual Vector6<double> rigid_target(double /*dt*/) const {
        return Vector6<double>::Constant(std::numeric_limits<double>::quiet_NaN());
    }
    /// Sets motor velocity [m/s | rad/s] and strength [N | N m].
    virtual void set_motor(dReal velocity, dReal strength) = 0;

  private:
    /// Axis and arms of the row at the bodies' present positions.
    void locate() {
        const Vector3<double> where = point();
        axis_ = axis();
        arm_a_ = where - to_core(dBodyGetPosition(a_));
        arm_b_.setZero();
        if (b_ != nullptr) arm_b_ = where - to_core(dBodyGetPosition(b_));
    }

    /// Linear and angular velocity of A minus B where the row acts, world axes [m/s, rad/s].
    [[nodiscard]] Vector6<double> twist() const {
        const Vector3<double> wa = angular_velocity(a_);
        const Vector3<double> wb = angular_velocity(b_);
        Vector6<double> result;
        result << linear_velocity(a_) + wa.cross(arm_a_) - linear_velocity(b_) - wb.cross(arm_b_),
            wa - wb;
        return result;
    }

    [[nodiscard]] double row_velocity() const {
        const Vector6<double> t = twist();
        return axis_.dot(turns() ? t.tail<3>() : t.head<3>());
    }

    /// A solved rigid row moves at its target velocity, whatever else happens.
    void certify_rigid_rows() {
        speed_ = {(linear_velocity(a_) + angular_velocity(a_).cross(arm_a_)).norm(),
                  angular_velocity(a_).norm()};
        rigid_residual_.setZero();
        if (rigid_target_.hasNaN()) return;
        rigid_residual_ = twist() - rigid_target_;
        const int plastic = turns() ? 3 : 0;
        const Vector3<double> part = rigid_residual_.segment<3>(plastic);
        rigid_residual_.segment<3>(plastic) = part - axis_ * axis_.dot(part);
    }

    /// λ/dt of the plastic row: the feedback less what the five rigid rows put into it.
    [[nodiscard]] double row_force() const {
        const Vector3<double> force = to_core(feedback_.f1);
        if (!turns()) return axis_.dot(force);
        return axis_.dot(to_core(feedback_.t1) - arm_a_.cross(force));
    }

    /// Gives the energy that the breaking step took in excess back to the motion along the axis.
    void hand_back(double energy) {
        locate();
        Vector6<double> direction = Vector6<double>::Zero();
        direction.segment<3>(turns() ? 3 : 0) = axis_;
        const Vector3<double> where = point();
        const auto a = at_joint(a_, where);
        const auto b = at_joint(b_, where);
        release_ = break_release(a, b, direction, twist(), energy);
        if (a.inverse_mass > 0) apply(a_, release_.a);
        if (b.inverse_mass > 0) apply(b_, release_.b);
    }

    dJointID id_;
    dBodyID a_;
    dBodyID b_;
    Joint joint_;
    dJointFeedback feedback_{};
    Vector3<double> axis_ = Vector3<double>::Zero();
    Vector3<double> arm_a_ = Vector3<double>::Zero();
    Vector3<double> arm_b_ = Vector3<double>::Zero();
    Vector6<double> rigid_target_ = Vector6<double>::Zero();
    Vector6<double> rigid_residual_ = Vector6<double>::Zero();
    std::array<double, 2> speed_{}; ///< of A at the joint [m/s], and its turning [rad/s]
    Step<double> last_;
    BreakRelease<double> release_;
    double position_ = 0;
    double force_ = 0;
};

} // namespace ductile::ode
