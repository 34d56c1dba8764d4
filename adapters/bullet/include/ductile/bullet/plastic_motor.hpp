// SPDX-License-Identifier: MIT
//
// Makes a btHingeConstraint that a world already has plastic, by its motor:
//
//   ductile::bullet::PlasticMotor elbow(hinge, ductile::OneAxisJoint(
//                                                  ductile::Perfect<double>({.strength = 64})));
//   elbow.add_to(world);
//
// The hinge stays the user's, in the world as it is, with its limits and its feedback. This is a
// constraint of one row beside it, about the hinge's axis, in place of the hinge's own motor, which
// is off meanwhile: Bullet's motor takes one impulse for both directions, has no compliance, and
// shares its row with the limits. Compliance, and where the row is solved, are as for a
// PlasticHinge (link_rows.hpp, self_solved_rows.hpp). Where the bodies are when the motor is taken
// over is the rest position. A hinge that is disabled, or asleep, is neither ruled nor booked.
//
// Not thread-safe beyond what Bullet guarantees for a constraint.
#pragma once

#include <BulletDynamics/ConstraintSolver/btHingeConstraint.h>
#include <BulletDynamics/Dynamics/btActionInterface.h>
#include <BulletDynamics/Dynamics/btDynamicsWorld.h>

#include <array>
#include <cmath>
#include <utility>

#include "ductile/bullet/convert.hpp"
#include "ductile/bullet/draw.hpp"
#include "ductile/bullet/link_rows.hpp"
#include "ductile/bullet/plastic_constraint.hpp"
#include "ductile/bullet/self_solved_rows.hpp"
#include "ductile/joint/isolated_pair.hpp"
#include "ductile/joint/joint_axis.hpp"
#include "ductile/joint/one_axis_joint.hpp"
#include "ductile/law/perfect.hpp"
#include "ductile/vocabulary/angle.hpp"

namespace ductile::bullet {

/// What happens to Bullet's hinge when the row beside it breaks.
enum class AtBreak {
    disable_joint, ///< the whole hinge lets go
    release_axis   ///< only the row does: the hinge turns freely
};

template <class Joint = OneAxisJoint<Perfect<double>>>
class PlasticMotor final : public PlasticConstraint, public SelfSolvedRows {
  public:
    /// The hinge has to outlive this object.
    PlasticMotor(btHingeConstraint& hinge, Joint joint, AtBreak at_break = AtBreak::disable_joint)
        : PlasticConstraint(MAX_CONSTRAINT_TYPE, hinge.getRigidBodyA(), hinge.getRigidBodyB()),
          hinge_(hinge),
          joint_(std::move(joint)),
          at_break_(at_break),
          motor_was_on_(hinge.getEnableAngularMotor()),
          velocity_was_(hinge.getMotorTargetVelocity()),
          impulse_was_(hinge.getMaxMotorImpulse()) {
        hinge_.enableMotor(false);
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
        join(world);
        world_ = &world;
        world.addConstraint(this);
        world.addAction(&action_);
    }
    void remove_from(btDynamicsWorld& world) {
        settle();
        world.removeAction(&action_);
        world.removeConstraint(this);
        world_ = nullptr;
        leave();
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
    /// Moment of the row in the last tick, positive where it turns A about +axis [N m].
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
    /// Certificate: violation of the row in the last tick [rad/s].
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

    void buildJacobian() override { settle(); }
    void getInfo1(btConstraintInfo1* info) override {
        *info = {.m_numConstraintRows = 0, .nub = 0};
        close();
        if (world_ == nullptr || !hinge_.isEnabled() || joint_.state().broken) return;
        prepare();
        SweepGroup* sweeps = sweeps_of_solver(*this, world_);
        if (sweeps == nullptr) {
            info->m_numConstraintRows = 1;
            return;
        }
        RowLimits<double> limits = limits_;
        limits.lower *= dt_;
        limits.upper *= dt_;
        const Vector3<double> none = Vector3<double>::Zero();
        open(*sweeps, m_rbA, m_rbB, none, none).add(none, axis_, limits);
    }
    void getInfo2(btConstraintInfo2* info) override {
        write_moment(*info, 0, axis_);
        write_limits(*info, 0, {axis_, true, limits_}, m_rbA, m_rbB, pivot(), compliance_is_exact(),
                     dt_, [this] { return moment_alone(); });
    }
    /// Bullet's own: sequential impulse calls it in each sweep.
    void solveConstraintObsolete(btSolverBody& a, btSolverBody& b, btScalar) override {
        if (is_open()) sweep(a, b);
    }
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

    /// World [m].
    [[nodiscard]] Vector3<double> pivot() const {
        return to_core(m_rbA.getCenterOfMassTransform() * hinge_.getAFrame().getOrigin());
    }
    /// World, z about the axis.
    [[nodiscard]] Matrix3<double> axes() const {
        return to_core(m_rbA.getCenterOfMassTransform().getBasis() * hinge_.getAFrame().getBasis());
    }
    /// K of the hinge, for rows along `axes`.
    [[nodiscard]] Matrix6<double> inverse_mass() const {
        return inverse_mass_of_rows(body_state(m_rbA), body_state(m_rbB), pivot(), axes());
    }
    /// Of A minus B at the pivot, world.
    [[nodiscard]] Vector6<double> twist(const BodyState<double>& a,
                                        const BodyState<double>& b) const {
        Vector6<double> result;
        result << a.velocity + a.spin.cross(pivot() - a.position) - b.velocity -
                      b.spin.cross(pivot() - b.position),
            a.spin - b.spin;
        return result;
    }
    /// Of the pair as if nothing else acted on it in the tick [N m].
    [[nodiscard]] double moment_alone() const {
        const Vector6<double> free = twist(free_state(m_rbA, tick_), free_state(m_rbB, tick_));
        Vector6<double> along_axes;
        along_axes << axes().transpose() * free.head<3>(), axes().transpose() * free.tail<3>();
        std::array<RowLimits<double>, 6> rows{};
        rows[index(JointAxis::torsion)] = limits_;
        return forces_of_isolated_pair(rows, inverse_mass(), along_axes,
                                       dt_)[Eigen::Index(index(JointAxis::torsion))];
    }

    void prepare() {
        tick_ = double(world_->getSolverInfo().m_timeStep);
        dt_ = force_share_.value * tick_;
        axis_ = axis();
        position_ = measure(position_);
        const bool elastic = std::isfinite(joint_.parameters().stiffness);
        const double mass =
            elastic ? mass_of_rows(inverse_mass(), std::array{JointAxis::torsion})(0, 0) : 0.0;
        limits_ = joint_.prepare({position_, velocity(), mass, force_share_.midway}, dt_);
        pending_ = true;
    }

    void settle() {
        if (!std::exchange(pending_, false)) return;
        const double speed = velocity();
        moment_ = double(internalGetAppliedImpulse()) / dt_;
        if (is_open()) read_own_row();
        position_ = measure(position_ + speed * tick_);
        last_ = joint_.commit({moment_, speed, position_}, dt_);
        if (last_.outcome != Outcome::broken) return;
        if (at_break_ == AtBreak::disable_joint) hinge_.setEnabled(false);
        if (last_.release > 0) hand_back();
    }

    /// Tells Bullet what it would know of a row of its own.
    void read_own_row() {
        moment_ = impulses()[0] / dt_;
        internalSetAppliedImpulse(btScalar(impulses()[0]));
        if (m_jointFeedback == nullptr) return;
        const Vector3<double> none = Vector3<double>::Zero();
        write_feedback(*m_jointFeedback, m_rbA, m_rbB, none, none, none,
                       axis_ * (impulses()[0] / tick_));
    }

    void hand_back() {
        const BodyState<double> a = body_state(m_rbA), b = body_state(m_rbB);
        Vector6<double> direction;
        direction << Vector3<double>::Zero(), axis();
        release_ = break_release(
            BodyAtJoint<double>{a.inverse_mass, a.inverse_inertia, pivot() - a.position},
            BodyAtJoint<double>{b.inverse_mass, b.inverse_inertia, pivot() - b.position}, direction,
            twist(a, b), last_.release);
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
    RowLimits<double> limits_;                        ///< of it
    double tick_ = 0;                                 ///< [s]
    double dt_ = 0;                                   ///< for which the row's moment acts in it [s]
    double position_ = 0;
    double moment_ = 0;
    bool pending_ = false;
};

} // namespace ductile::bullet
