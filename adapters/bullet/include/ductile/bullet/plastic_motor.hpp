// SPDX-License-Identifier: MIT
//
// Makes a btHingeConstraint that a world already has plastic, by its motor:
//
//   ductile::bullet::PlasticMotor elbow(hinge, ductile::OneAxisJoint(
//                                                  ductile::Perfect<double>({.strength = 64})));
//   elbow.add_to(world);
//
// The hinge stays the user's, in the world as it is. Each tick, as Bullet opens it, the motor is
// given the strength of the side to which the hinge turns (Bullet's motor takes one impulse for
// both, hence strength × dt) and the velocity that removes drift; at the tick's end the impulse of
// the motor's row, the hinge's last, is booked. Where the bodies are when the motor is taken over
// is the rest position. A hinge that is disabled, or asleep, is neither ruled nor booked.
//
// Bullet's motor has no compliance that all solvers share: rigid below yield only. A limit of the
// hinge shares the motor's row, so that its impulse would be booked as the motor's: refused.
//
// How it is done: this is itself a constraint between the same bodies, without rows, because Bullet
// tells constraints, and them alone, that a solve opens; the step is that of the world's solver
// info.
//
// `internalGetAppliedImpulse`, which this reads, is the last row's in every solver of Bullet's.
// Not thread-safe beyond what Bullet guarantees for a constraint.
#pragma once

#include <BulletDynamics/ConstraintSolver/btHingeConstraint.h>
#include <BulletDynamics/Dynamics/btActionInterface.h>
#include <BulletDynamics/Dynamics/btDynamicsWorld.h>

#include <cmath>
#include <stdexcept>
#include <utility>

#include "ductile/bullet/convert.hpp"
#include "ductile/bullet/draw.hpp"
#include "ductile/bullet/plastic_constraint.hpp"
#include "ductile/joint/joint_axis.hpp"
#include "ductile/joint/one_axis_joint.hpp"
#include "ductile/law/perfect.hpp"
#include "ductile/vocabulary/angle.hpp"

namespace ductile::bullet {

/// What happens to Bullet's hinge when its motor's row breaks.
enum class AtBreak {
    disable_joint, ///< the whole hinge lets go
    release_axis   ///< only the row does: the motor is switched off
};

template <class Joint = OneAxisJoint<Perfect<double>>>
class PlasticMotor final : public PlasticConstraint {
  public:
    /// The hinge has to outlive this object.
    /// @throws std::invalid_argument where the hinge has a limit or the joint is elastic.
    PlasticMotor(btHingeConstraint& hinge, Joint joint, AtBreak at_break = AtBreak::disable_joint)
        : PlasticConstraint(MAX_CONSTRAINT_TYPE, hinge.getRigidBodyA(), hinge.getRigidBodyB()),
          hinge_(hinge),
          joint_(std::move(joint)),
          at_break_(at_break),
          motor_was_on_(hinge.getEnableAngularMotor()),
          velocity_was_(hinge.getMotorTargetVelocity()),
          impulse_was_(hinge.getMaxMotorImpulse()) {
        require_rigid(joint_.parameters().stiffness);
        if (hinge_.hasLimit()) {
            throw std::invalid_argument(
                "PlasticMotor.hinge: must be without limits: they share the motor's row");
        }
        position_ = measure(0);
        auto state = joint_.state();
        state.plastic_offset = position_;
        joint_.restore(state);
    }
    /// Gives the motor back as it was; one that has broken stays off.
    ~PlasticMotor() override {
        hinge_.enableAngularMotor(motor_was_on_ && !joint_.state().broken, velocity_was_,
                                  impulse_was_);
    }
    PlasticMotor(const PlasticMotor&) = delete;
    PlasticMotor& operator=(const PlasticMotor&) = delete;

    /// The hinge itself must be in the world too; in which order does not matter.
    void add_to(btDynamicsWorld& world) {
        world_ = &world;
        world.addConstraint(this);
        world.addAction(&action_);
    }
    void remove_from(btDynamicsWorld& world) {
        settle();
        world.removeAction(&action_);
        world.removeConstraint(this);
        world_ = nullptr;
    }

    [[nodiscard]] const Joint& joint() {
        settle();
        return joint_;
    }
    /// Angle of A relative to B about the axis, not wrapped [rad].
    [[nodiscard]] double rotation() {
        settle();
        return position_;
    }
    /// Accumulated plastic rotation p, work-conjugate [rad].
    [[nodiscard]] double plastic_rotation() { return joint().state().plastic_travel; }
    /// Moment of the motor in the last tick, positive where it turns A about +axis [N m].
    [[nodiscard]] double moment() {
        settle();
        return moment_;
    }
    [[nodiscard]] double absorbed_energy() override { return joint().state().plastic_work; }
    [[nodiscard]] double stored_energy() override { return joint().state().stored; }
    [[nodiscard]] bool broken() { return joint().state().broken; }
    [[nodiscard]] Outcome outcome() {
        settle();
        return last_.outcome;
    }
    /// Certificate: violation of the motor's row in the last tick [rad/s].
    [[nodiscard]] double residual() {
        settle();
        return last_.residual;
    }
    [[nodiscard]] const BreakRelease<double>& release() override {
        settle();
        return release_;
    }
    [[nodiscard]] JointView view() override {
        settle();
        JointView view{.frame_a = m_rbA.getCenterOfMassTransform() * hinge_.getAFrame(),
                       .frame_b = m_rbB.getCenterOfMassTransform() * hinge_.getBFrame(),
                       .outcome = joint_.state().broken ? Outcome::broken : last_.outcome};
        const double strength = joint_.strength(moment_ > 0 ? -1 : 1);
        if (!joint_.state().broken && strength > 0) view.utilisation = std::abs(moment_) / strength;
        view.plastic_offset[Eigen::Index(index(JointAxis::torsion))] =
            joint_.state().plastic_offset;
        return view;
    }

    [[nodiscard]] JointReport<double> report() override {
        settle();
        const bool is_broken = joint_.state().broken;
        auto now = joint_report(joint_, last_, is_broken ? Outcome::broken : last_.outcome, 0.0);
        if (!is_broken) {
            now.rotation_rate = std::abs(axis().dot(to_core(m_rbA.getAngularVelocity()) -
                                                    to_core(m_rbB.getAngularVelocity())));
        }
        return acts() && hinge_.isEnabled() ? now : idle_report(now);
    }

    // ---- Bullet's side

    void buildJacobian() override {
        settle();
        if (world_ == nullptr || !hinge_.isEnabled() || joint_.state().broken) return;
        tick_ = double(world_->getSolverInfo().m_timeStep);
        dt_ = kick_.share * tick_;
        axis_ = axis();
        position_ = measure(position_);
        const RowLimits<double> limits =
            joint_.prepare({position_, velocity(), 0, kick_.midway}, dt_);
        const double strength = velocity() < 0 ? limits.upper : -limits.lower;
        // the hinge counts its motor's velocity the other way round with its frame A as reference
        const double sign = hinge_.getUseReferenceFrameA() ? -1 : 1;
        hinge_.enableAngularMotor(true, btScalar(sign * limits.bias), btScalar(strength * dt_));
        pending_ = true;
    }
    void getInfo1(btConstraintInfo1* info) override {
        *info = {.m_numConstraintRows = 0, .nub = 0};
    }
    void getInfo2(btConstraintInfo2*) override {}
    /// The hinge's own parameters are set at the hinge.
    void setParam(int, btScalar, int = -1) override {}
    [[nodiscard]] btScalar getParam(int, int = -1) const override { return 0; }

  private:
    struct CommitAction final : btActionInterface {
        explicit CommitAction(PlasticMotor& owner) : owner_(owner) {}
        void updateAction(btCollisionWorld*, btScalar) override { owner_.settle(); }
        void debugDraw(btIDebugDraw* drawer) override {
            if (drawer != nullptr) draw(owner_, *drawer);
        }
        PlasticMotor& owner_;
    };

    /// World.
    [[nodiscard]] Vector3<double> axis() const {
        return to_core(m_rbA.getCenterOfMassTransform().getBasis() *
                       hinge_.getAFrame().getBasis().getColumn(2));
    }
    /// Of A minus B about the axis of this tick [rad/s].
    [[nodiscard]] double velocity() const {
        return axis_.dot(to_core(m_rbA.getAngularVelocity()) - to_core(m_rbB.getAngularVelocity()));
    }
    [[nodiscard]] double measure(double predicted) const {
        const btMatrix3x3 a =
            m_rbA.getCenterOfMassTransform().getBasis() * hinge_.getAFrame().getBasis();
        const btMatrix3x3 b =
            m_rbB.getCenterOfMassTransform().getBasis() * hinge_.getBFrame().getBasis();
        const btMatrix3x3 relative = b.transposeTimes(a);
        return unwrap(std::atan2(double(relative[1][0]), double(relative[0][0])), predicted);
    }

    void settle() {
        if (!std::exchange(pending_, false)) return;
        const double speed = velocity();
        moment_ = double(hinge_.internalGetAppliedImpulse()) / dt_;
        position_ = measure(position_ + speed * tick_);
        last_ = joint_.commit({moment_, speed, position_}, dt_);
        if (last_.outcome != Outcome::broken) return;
        if (at_break_ == AtBreak::disable_joint) {
            hinge_.setEnabled(false);
        } else {
            hinge_.enableMotor(false);
        }
        if (last_.release > 0) hand_back();
    }

    void hand_back() {
        const BodyState<double> a = body_state(m_rbA), b = body_state(m_rbB);
        const Vector3<double> joint =
            to_core(m_rbA.getCenterOfMassTransform() * hinge_.getAFrame().getOrigin());
        const Vector3<double> arm_a = joint - a.position, arm_b = joint - b.position;
        Vector6<double> direction, twist;
        direction << Vector3<double>::Zero(), axis();
        twist << a.velocity + a.spin.cross(arm_a) - b.velocity - b.spin.cross(arm_b),
            a.spin - b.spin;
        release_ = break_release(BodyAtJoint<double>{a.inverse_mass, a.inverse_inertia, arm_a},
                                 BodyAtJoint<double>{b.inverse_mass, b.inverse_inertia, arm_b},
                                 direction, twist, last_.release);
        apply(m_rbA, release_.a);
        apply(m_rbB, release_.b);
    }

    btHingeConstraint& hinge_;
    Joint joint_;
    AtBreak at_break_;
    bool motor_was_on_;
    btScalar velocity_was_, impulse_was_;
    CommitAction action_{*this};
    Step<double> last_;
    BreakRelease<double> release_;
    Vector3<double> axis_ = Vector3<double>::UnitZ(); ///< of the open tick, world
    double tick_ = 0; ///< [s]
    double dt_ = 0;   ///< for which the motor's strength acts in it [s]
    double position_ = 0;
    double moment_ = 0;
    bool pending_ = false;
};

} // namespace ductile::bullet
