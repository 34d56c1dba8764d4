// SPDX-License-Identifier: MIT
//
// A motor of an ODE joint as a plastic row: what PlasticHinge, PlasticSlider and PlasticMotor
// share. The joint's other rows are ODE's. The plasticity is the core's joint.
//
// Body A moves relative to body B (null: the static world):
//   u = axis · (ω_A - ω_B)              turning                                       [rad/s]
//   u = axis · (v_A - v_B)              sliding, taken midway between the two bodies  [m/s]
//
// The core's row is  u' + C λ = b,  lower dt <= λ <= upper dt;  ODE's motor, with f = λ_m/dt, is
//   u' + CFM f = Vel,   |f| <= FMax.
// With the centre c and half width h of the bounds, c is applied to both bodies as an outside force
// or couple for the step, and the motor does the rest:
//   f = λ/dt - c,   FMax = h,   CFM = C dt,   Vel = b - C dt c.
// A row with a given force, lower = upper, needs no motor. The row's force is the motor's share of
// the joint's feedback plus c.
//
// Life in a world. The row does nothing in a step in which ODE does not solve its joint: while both
// bodies sleep, while the joint is disabled by the user, while neither body can move (kinematic),
// and for ever after one of the bodies is destroyed or the joint is attached anew. What the bodies
// do meanwhile, and what somebody moves by hand between two steps, is no deformation: the rest
// position goes along, and what is stored stays stored. A broken joint stays broken.
//
// Traps of ODE 0.16 that this header deals with
//   - A motor together with an active stop becomes an outside force: a stop on the axis is refused.
//   - Feedback sums all rows of a joint in world axes about the centre of mass, and keeps its old
//     values where the joint was not solved.
//   - A body that falls asleep and is woken by a neighbour in the same step loses its velocity
//     inside ODE, unseen; an energy account calls that unexplained. Known only, not mended.
//   - Bodies fall asleep within the step and keep the forces that were applied for it.
//   - A body turns by the first-order rule unless dBodySetFiniteRotationMode(body, 1) is set, which
//     loses (ω dt)³/12 rad a step: set it where plastic rotations per step are large.
// Not thread-safe.
#pragma once

#include <ode/ode.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "ductile/joint/one_axis_joint.hpp"
#include "ductile/joint/pair.hpp"
#include "ductile/ode/convert.hpp"
#include "ductile/ode/motor_axis.hpp"
#include "ductile/ode/motor_pose.hpp"
#include "ductile/ode/plastic_constraint.hpp"
#include "ductile/ode/symmetric_row.hpp"
#include "ductile/ode/world.hpp"

namespace ductile::ode {

template <class Joint>
class OneAxisConstraint : public PlasticConstraint {
  public:
    using State = typename Joint::State;

    OneAxisConstraint(const OneAxisConstraint&) = delete;
    OneAxisConstraint& operator=(const OneAxisConstraint&) = delete;

    void add_to(World& world, std::string name = {}) { world.add(*this, std::move(name)); }
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
    /// While the bodies sleep that of the step before; zero while the joint does not act.
    [[nodiscard]] double reaction() const { return force_; }
    /// Energy dissipated by plastic flow [J].
    [[nodiscard]] double absorbed_energy() const override { return joint_.state().plastic_work; }
    [[nodiscard]] double stored_energy() const override { return joint_.state().stored; }
    [[nodiscard]] bool broken() const { return joint_.state().broken; }
    /// Unreliable where the solver left the plastic row or one of the rigid ones unsolved.
    [[nodiscard]] Outcome outcome() const {
        return rigid_unsolved_ && last_.outcome != Outcome::broken ? Outcome::unreliable
                                                                   : last_.outcome;
    }
    /// Certificate: violation of the plastic row in the last step, and the largest so far
    /// [m/s | rad/s].
    [[nodiscard]] double residual() const { return last_.residual; }
    [[nodiscard]] double residual_max() const { return joint_.state().residual_max; }
    /// Violation of the rigid rows in the last step [m/s | rad/s]: of the pin for hinges and
    /// universals, of the axis for a PlasticHinge; other rigid rows are not known.
    [[nodiscard]] double rigid_residual() const { return rigid_residual_.cwiseAbs().maxCoeff(); }
    [[nodiscard]] JointReport<double> report() const override {
        auto now =
            joint_report(joint_, last_, broken() ? Outcome::broken : outcome(), rigid_residual());
        if (broken() || !row_.attached() || dJointIsEnabled(id()) == 0) return now;
        const double velocity = is_where_left() ? pose_.velocity(row_) : row_.velocity();
        (row_.turns() ? now.rotation_rate : now.elongation_rate) = std::abs(velocity);
        return now;
    }
    /// True where one of the bodies was destroyed or the joint was attached anew: the row does
    /// nothing any more.
    [[nodiscard]] bool detached() const { return detached_; }

    [[nodiscard]] const Joint& joint() const { return joint_; }
    [[nodiscard]] const BreakRelease<double>& release() const override { return release_; }
    [[nodiscard]] const OutsideForce& outside_force() const override { return outside_; }
    /// ODE's joint.
    [[nodiscard]] dJointID id() const override { return row_.joint(); }

    /// Goes on from `state` at `position` [m | rad], both as saved; the bodies have to be put back
    /// too, before or after.
    void restore(const State& state, double position) {
        joint_.restore(state);
        position_ = position;
        restored_ = true;
        if (!state.broken) return;
        part(); // broken is broken, also when it was saved
    }

    /// @throws std::logic_error where somebody set a stop on the axis since it was taken over.
    void check() const override {
        if (joint_.state().broken || !row_.attached() || !has_stop(row_)) return;
        throw std::logic_error(stop_refused());
    }

    /// Sets the motor for a step of `dt` [s]. Called by World::step.
    void prepare(double dt) override {
        acting_ = false;
        outside_ = {};
        detached_ = !row_.attached();
        if (joint_.state().broken) {
            force_ = 0;
            if (!detached_) part();
            return;
        }
        if (!may_act()) {
            suspend();
            force_ = 0;
            return;
        }
        acting_ = true;
        if (restored_ || !is_where_left()) {
            pose_.look(row_);
            follow_teleport();
        }
        Motion<double> motion{position_, pose_.velocity(row_), 0, force_share_.midway};
        if (std::isfinite(joint_.parameters().stiffness)) motion.mass = mass();
        set_motor(joint_.prepare(motion, force_share_.value * dt), dt);
        rigid_target_ = rigid_target(dt);
    }

    /// Books the step; after a break lets go of the joint. Called by World::step.
    void commit(double dt) override {
        if (!acting_) return;
        if (!solved()) {
            take_back();
            suspend();
            return;
        }
        const Vector6<double> twist = pose_.twist(row_);
        const double velocity = pose_.along(row_, twist);
        certify_rigid_rows(twist);
        force_ = row_force();
        position_ = row_.measured() ? row_.measure(position_ + velocity * dt)
                                    : position_ + row_.increment(pose_.placement(), pose_.axis(),
                                                                 pose_.point());
        last_ = joint_.commit({force_, velocity, position_}, force_share_.value * dt);
        pose_.look(row_);
        joint_.carry(pose_.velocity(row_)); // seen from where the bodies are now
        if (last_.outcome == Outcome::broken) {
            part();
            if (last_.release > 0) hand_back(last_.release);
        }
    }

  protected:
    /// Takes over the motor `row`; where it is `owned`, its joint is destroyed with this object,
    /// else it has to outlive this object.
    /// @throws std::invalid_argument where the axis has a stop.
    OneAxisConstraint(const MotorAxis& row, Joint joint, AtBreak at_break, bool owned)
        : row_(row), at_break_(at_break), owned_(owned), joint_(std::move(joint)) {
        if (has_stop(row_)) throw std::invalid_argument(stop_refused());
        auto state = joint_.state();
        position_ = state.plastic_offset = row_.measure(0);
        joint_.restore(state);
    }

    ~OneAxisConstraint() override {
        if (dJointGetFeedback(row_.joint()) == &feedback_) dJointSetFeedback(row_.joint(), nullptr);
        if (owned_) dJointDestroy(row_.joint());
    }

    [[nodiscard]] const MotorAxis& row() const noexcept { return row_; }
    [[nodiscard]] const MotorPose& pose() const noexcept { return pose_; }

    /// Velocities that the rigid rows ask for in a step of `dt` [s], linear and angular, world
    /// axes; NaN where they are not known. ODE pulls the halves of a pin together by the world's
    /// ERP a step.
    [[nodiscard]] virtual Vector6<double> rigid_target(double dt) const {
        Vector6<double> target =
            Vector6<double>::Constant(std::numeric_limits<double>::quiet_NaN());
        target.head<3>() = erp() / dt * row_.pin_error(pose_.point());
        return target;
    }
    [[nodiscard]] double erp() const {
        return double(dWorldGetERP(dBodyGetWorld(row_.bodies().a)));
    }

  private:
    static bool has_stop(const MotorAxis& row) {
        return std::isfinite(row.get(dParamLoStop)) || std::isfinite(row.get(dParamHiStop));
    }
    static const char* stop_refused() {
        return "OneAxisConstraint.row: the axis has a stop (dParamLoStop or dParamHiStop is "
               "finite): ODE applies a motor at its stop as an outside force, so no row can be "
               "plastic there; set both to infinity";
    }

    // ---- life

    [[nodiscard]] bool can_move(dBodyID body) const {
        return body != nullptr && !dBodyIsKinematic(body);
    }
    [[nodiscard]] bool may_act() const {
        const auto& [a, b, reversed] = row_.bodies();
        return !detached_ && dJointIsEnabled(id()) != 0 && (can_move(a) || can_move(b));
    }
    /// True where ODE did solve the joint: it wakes whatever hangs on a body that is awake.
    [[nodiscard]] bool solved() const {
        const auto& [a, b, reversed] = row_.bodies();
        return dBodyIsEnabled(a) != 0 || (b != nullptr && dBodyIsEnabled(b) != 0);
    }

    /// Holds the account where it is while the row does nothing.
    void suspend() {
        auto state = joint_.state();
        state.start_velocity = state.velocity = 0;
        state.flowing = false;
        joint_.restore(state);
        last_ = {};
        rigid_residual_.setZero();
        rigid_unsolved_ = false;
    }

    /// True where the bodies are as the last step left them, and nobody else can turn the axis.
    [[nodiscard]] bool is_where_left() const { return owned_ && pose_.is_now(row_); }

    /// Somebody moved the bodies since the last step: the rest position goes along.
    void follow_teleport() {
        const double now = row_.measure(position_);
        if (now != position_ && !restored_) {
            auto state = joint_.state();
            state.plastic_offset += now - position_;
            joint_.restore(state);
        }
        position_ = now;
        restored_ = false;
    }

    void part() {
        row_.set(dParamFMax, 0);
        if (at_break_ == AtBreak::disable_joint) dJointDisable(id());
    }

    // ---- the row

    [[nodiscard]] Vector6<double> response() const {
        return row_.response(at_joint(row_.bodies().a, pose_.point()),
                             at_joint(row_.bodies().b, pose_.point()));
    }
    [[nodiscard]] Vector6<double> direction() const {
        Vector6<double> result = Vector6<double>::Zero();
        result.segment<3>(row_.turns() ? 3 : 0) = pose_.axis();
        return result;
    }
    /// What the row moves while the joint's other rows hold [kg | kg m²]; 0: not known.
    [[nodiscard]] double mass() const {
        const double result = direction().dot(response());
        return std::isfinite(result) ? result : 0;
    }

    void set_motor(const RowLimits<double>& limits, double dt) {
        const SymmetricRow row = symmetric_row(limits, dt, force_share_.value);
        centre_ = row.centre;
        strength_ = row.strength;
        row_.set(dParamCFM, row.cfm);
        row_.set(dParamVel, row.velocity);
        row_.set(dParamFMax, strength_);
        if (dJointGetFeedback(id()) == nullptr) dJointSetFeedback(id(), &feedback_);
        feedback_ = {}; // ODE leaves it alone where the joint has no row in this step
        if (centre_ != 0) apply_centre();
    }

    void apply_centre() {
        if (row_.turns()) {
            outside_.torque_a = centre_ * pose_.axis();
            outside_.torque_b = -outside_.torque_a;
        } else {
            outside_.force = centre_ * pose_.axis();
            outside_.torque_a = pose_.arm_a().cross(outside_.force);
            outside_.torque_b = -pose_.arm_b().cross(outside_.force);
        }
        add_outside(1);
    }

    /// The step was not one for these bodies; ODE keeps what was applied for it.
    void take_back() {
        if (centre_ != 0) add_outside(-1);
        outside_ = {};
    }

    void add_outside(double sign) {
        const auto& [a, b, reversed] = row_.bodies();
        add(a, sign * outside_.force, sign * outside_.torque_a);
        if (b != nullptr) add(b, -sign * outside_.force, sign * outside_.torque_b);
    }
    static void add(dBodyID body, const Vector3<double>& force, const Vector3<double>& torque) {
        dBodyAddForce(body, dReal(force.x()), dReal(force.y()), dReal(force.z()));
        dBodyAddTorque(body, dReal(torque.x()), dReal(torque.y()), dReal(torque.z()));
    }

    /// A solved rigid row moves at its target velocity, whatever else happens. `twist`: after the
    /// solve.
    void certify_rigid_rows(const Vector6<double>& twist) {
        rigid_residual_ = twist - rigid_target_;
        const int plastic = row_.turns() ? 3 : 0;
        const Vector3<double> part = rigid_residual_.segment<3>(plastic);
        rigid_residual_.segment<3>(plastic) = part - pose_.axis() * pose_.axis().dot(part);
        if (rigid_target_.head<3>().hasNaN()) rigid_residual_.head<3>().setZero();
        if (rigid_target_.tail<3>().hasNaN()) rigid_residual_.tail<3>().setZero();

        const auto& allowed = joint_.parameters();
        const double linear = rigid_residual_.head<3>().norm();
        const double angular = rigid_residual_.tail<3>().norm();
        rigid_unsolved_ = false;
        if (std::max(linear, angular) <= allowed.absolute_residual) return;
        const dBodyID a = row_.bodies().a;
        const Vector3<double> w = angular_velocity(a);
        const double speed = (linear_velocity(a) + w.cross(pose_.arm_a())).norm();
        rigid_unsolved_ =
            linear > allowed.absolute_residual + allowed.relative_residual * speed ||
            angular > allowed.absolute_residual + allowed.relative_residual * w.norm();
    }

    /// Of the plastic row: its impulse over the time for which it acted.
    [[nodiscard]] double row_force() const {
        const dJointFeedback* feedback = dJointGetFeedback(id());
        if (!(strength_ > 0) || feedback == nullptr) return centre_ / force_share_.value;
        return (centre_ + row_.force(*feedback, pose_.axes(), pose_.arm_a())) / force_share_.value;
    }

    /// Gives the energy that the breaking step took in excess back to the motion along the axis.
    void hand_back(double energy) {
        const auto a = at_joint(row_.bodies().a, pose_.point());
        const auto b = at_joint(row_.bodies().b, pose_.point());
        release_ = break_release(
            a, b, release_impulse(row_.response(a, b), direction(), pose_.twist(row_), energy),
            energy);
        if (a.inverse_mass > 0) apply(row_.bodies().a, release_.a);
        if (b.inverse_mass > 0) apply(row_.bodies().b, release_.b);
    }

    MotorAxis row_;
    AtBreak at_break_;
    bool owned_;
    Joint joint_;
    dJointFeedback feedback_{};
    MotorPose pose_; ///< at the start of the step, from commit on at its end
    Vector6<double> rigid_target_ = Vector6<double>::Zero();
    Vector6<double> rigid_residual_ = Vector6<double>::Zero();
    bool rigid_unsolved_ = false;
    OutsideForce outside_;
    double centre_ = 0;   ///< c [N | N m]
    double strength_ = 0; ///< h [N | N m]
    Step<double> last_;
    BreakRelease<double> release_;
    double position_ = 0;
    double force_ = 0;
    bool acting_ = false; ///< between prepare and commit: the row takes part in this step
    bool detached_ = false;
    bool restored_ = false; ///< the next position is measured, not compared
};

} // namespace ductile::ode
