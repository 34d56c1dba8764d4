// SPDX-License-Identifier: MIT
//
// A Bullet constraint with one plastic row and five rigid ones: what PlasticHinge and PlasticSlider
// share. It translates frames, rows and reactions; the plasticity is the core's joint.
//
// The joint sits at the origin of frame A. Body A moves relative to body B:
//   u = axis · (ω_A - ω_B)                    turning about the z axis of frame B      [rad/s]
//   u = axis · (v_A(joint) - v_B(joint))      sliding along the z axis of frame B      [m/s]
// Every force acts on both bodies at the same point, so that the pair's momentum is conserved.
//
// Committing. The constraint commits each internal tick by itself: at the tick's end where it was
// added by `add_to` (which registers its action), otherwise when Bullet opens the next tick or when
// somebody asks it for a result, whichever comes first. Nothing has to be called by hand.
//
// Traps of Bullet 3.24 that this header deals with
//   - The plastic row is the last row, because the solver leaves the impulse of a constraint's last
//     row in `m_appliedImpulse`: the reaction is exact and the user's joint feedback stays untouched.
//   - `setBreakingImpulseThreshold` also clamps row limits: leave it infinite.
//   - Bullet turns a body by at most π/4 a step; faster spins than that are cut by the engine.
//
// Not thread-safe beyond what Bullet guarantees for a constraint.
#pragma once

#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>
#include <BulletDynamics/Dynamics/btActionInterface.h>
#include <BulletDynamics/Dynamics/btDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "ductile/bullet/convert.hpp"
#include "ductile/joint/one_axis_joint.hpp"
#include "ductile/joint/pair.hpp"

namespace ductile::bullet {

/// What an energy account needs to know of a plastic constraint of any kind.
class PlasticConstraint : public btTypedConstraint {
  public:
    using btTypedConstraint::btTypedConstraint;

    [[nodiscard]] virtual double absorbed_energy() = 0;      ///< D [J]
    [[nodiscard]] virtual const BreakRelease<double>& release() = 0; ///< of the break, if there was one
};

template <class Joint>
class OneAxisConstraint : public PlasticConstraint {
  public:
    OneAxisConstraint(const OneAxisConstraint&) = delete;
    OneAxisConstraint& operator=(const OneAxisConstraint&) = delete;

    /// Adds the constraint and its end-of-tick commit to a world.
    void add_to(btDynamicsWorld& world, bool disable_collisions_between_bodies = true) {
        world.addConstraint(this, disable_collisions_between_bodies);
        world.addAction(&action_);
    }
    void remove_from(btDynamicsWorld& world) {
        settle();
        world.removeAction(&action_);
        world.removeConstraint(this);
    }

    /// Accumulated plastic travel p, work-conjugate, never decreases [m | rad].
    [[nodiscard]] double plastic_travel() { return settled().state().plastic_travel; }
    /// Geometric rest position q_p [m | rad].
    [[nodiscard]] double plastic_offset() { return settled().state().plastic_offset; }
    /// Position of body A relative to body B, not wrapped [m | rad].
    [[nodiscard]] double position() {
        settle();
        return position_;
    }
    /// Velocity of body A relative to body B after the last tick's solve [m/s | rad/s].
    [[nodiscard]] double velocity() { return settled().state().velocity; }
    /// Force of the plastic row in the last tick, positive where it pushes A along +axis [N | N m].
    [[nodiscard]] double reaction() {
        settle();
        return force_;
    }
    /// Energy dissipated by plastic flow [J].
    [[nodiscard]] double absorbed_energy() override { return settled().state().plastic_work; }
    [[nodiscard]] bool broken() { return settled().state().broken; }
    /// Unreliable where the solver left the plastic row or one of the five rigid ones unsolved.
    [[nodiscard]] Outcome outcome() {
        settle();
        return rigid_unsolved_ && last_.outcome != Outcome::broken ? Outcome::unreliable
                                                                   : last_.outcome;
    }
    /// Certificate: violation of the plastic row in the last tick, and the largest so far
    /// [m/s | rad/s].
    [[nodiscard]] double residual() {
        settle();
        return last_.residual;
    }
    [[nodiscard]] double residual_max() { return settled().state().residual_max; }
    /// Largest violation of the rigid rows in the last tick [m/s | rad/s].
    [[nodiscard]] double rigid_residual() {
        settle();
        return rigid_residual_;
    }

    [[nodiscard]] const Joint& joint() { return settled(); }
    [[nodiscard]] const BreakRelease<double>& release() override {
        settle();
        return release_;
    }

    // ---- Bullet's side ---------------------------------------------------------------------------
    void buildJacobian() override { settle(); }

    void getInfo1(btConstraintInfo1* info) override {
        info->m_numConstraintRows = joint_.state().broken ? 0 : 6;
        info->nub = 0;
    }

    void getInfo2(btConstraintInfo2* info) override {
        dt_ = 1.0 / double(info->fps);
        locate();
        write_rigid_rows(*info);
        write_plastic_row(*info);
        pending_ = true;
    }

    /// BT_CONSTRAINT_ERP and BT_CONSTRAINT_STOP_ERP: error reduction of the five rigid rows, in
    /// [0, 1]; other parameters do not apply and are ignored.
    void setParam(int num, btScalar value, int /*axis*/ = -1) override {
        if (num == BT_CONSTRAINT_ERP || num == BT_CONSTRAINT_STOP_ERP) {
            rigid_erp_ = check::between("OneAxisConstraint.erp", value, btScalar(0), btScalar(1), "",
                                        true);
        }
    }
    btScalar getParam(int num, int /*axis*/ = -1) const override {
        return num == BT_CONSTRAINT_ERP || num == BT_CONSTRAINT_STOP_ERP ? rigid_erp_ : btScalar(0);
    }

  protected:
    OneAxisConstraint(btRigidBody& a, btRigidBody& b, const btTransform& frame_in_a,
                      const btTransform& frame_in_b, Joint joint)
        // no built-in type: Bullet casts by type, e.g. when it draws
        : PlasticConstraint(MAX_CONSTRAINT_TYPE, a, b),
          frame_in_a_(frame_in_a),
          frame_in_b_(frame_in_b),
          joint_(std::move(joint)) {
        require_rigid(joint_.parameters().stiffness);
    }
    ~OneAxisConstraint() override = default;

    /// Where frames, joint and axis are now, from the bodies' present transforms.
    struct Geometry {
        btTransform frame_a; ///< world
        btTransform frame_b; ///< world
        btVector3 arm_a;     ///< joint minus centre of mass of A, world [m]
        btVector3 arm_b;
        btVector3 axis; ///< z of frame B, world
    };
    [[nodiscard]] const Geometry& geometry() const noexcept { return geometry_; }

    /// Position of A relative to B [m | rad]; a kind that wraps unwraps it near `predicted`.
    [[nodiscard]] virtual double measure(const Geometry& geometry, double predicted) const = 0;
    /// Fills the five rigid rows; `rate` turns an error [m | rad] into a velocity.
    virtual void write_rigid(btConstraintInfo2& info, const Geometry& geometry, btScalar rate) = 0;
    /// True where the plastic row turns, false where it slides.
    [[nodiscard]] virtual bool turns() const noexcept = 0;

    /// Writes row `row`: a force along, or a moment about, `direction`, with target velocity `bias`.
    void write_force_row(btConstraintInfo2& info, int row, const Geometry& geometry,
                         const btVector3& direction, btScalar bias) noexcept {
        rows_[std::size_t(row)] = {direction, bias, true};
        write(info.m_J1linearAxis, info, row, direction);
        write(info.m_J2linearAxis, info, row, -direction);
        write(info.m_J1angularAxis, info, row, geometry.arm_a.cross(direction));
        write(info.m_J2angularAxis, info, row, -geometry.arm_b.cross(direction));
        info.m_constraintError[row * info.rowskip] = bias;
    }
    void write_moment_row(btConstraintInfo2& info, int row, const btVector3& direction,
                          btScalar bias) noexcept {
        rows_[std::size_t(row)] = {direction, bias, false};
        write(info.m_J1angularAxis, info, row, direction);
        write(info.m_J2angularAxis, info, row, -direction);
        info.m_constraintError[row * info.rowskip] = bias;
    }

    /// To be called by the constructor of the kind, when `measure` is there: the joint starts where
    /// the bodies are now.
    void start() {
        locate();
        position_ = measure(geometry_, 0);
        auto state = joint_.state();
        state.plastic_offset = position_;
        joint_.restore(state);
    }

  private:
    static constexpr std::size_t rigid_rows = 5;

    /// What a row of this tick asked for.
    struct Row {
        btVector3 direction{0, 0, 0};
        btScalar bias = 0;
        bool pushes = false; ///< a force row, not a moment row
    };

    /// Commits at the end of each internal tick.
    struct CommitAction final : btActionInterface {
        explicit CommitAction(OneAxisConstraint& owner) : owner_(owner) {}
        void updateAction(btCollisionWorld*, btScalar) override { owner_.settle(); }
        void debugDraw(btIDebugDraw*) override {}
        OneAxisConstraint& owner_;
    };

    static void write(btScalar* rows, const btConstraintInfo2& info, int row,
                      const btVector3& v) noexcept {
        btScalar* entry = rows + row * info.rowskip;
        for (int i = 0; i < 3; ++i) entry[i] = v[i];
    }

    void locate() noexcept {
        const btTransform& body_a = m_rbA.getCenterOfMassTransform();
        const btTransform& body_b = m_rbB.getCenterOfMassTransform();
        geometry_.frame_a = body_a * frame_in_a_;
        geometry_.frame_b = body_b * frame_in_b_;
        geometry_.arm_a = geometry_.frame_a.getOrigin() - body_a.getOrigin();
        geometry_.arm_b = geometry_.frame_a.getOrigin() - body_b.getOrigin();
        geometry_.axis = geometry_.frame_b.getBasis().getColumn(2);
    }

    /// Linear and angular velocity of A minus B at the joint, world axes [m/s, rad/s].
    [[nodiscard]] Vector6<double> twist() const noexcept {
        Vector6<double> result;
        result << velocity_at(m_rbA, to_core(geometry_.arm_a)) -
                      velocity_at(m_rbB, to_core(geometry_.arm_b)),
            to_core(m_rbA.getAngularVelocity()) - to_core(m_rbB.getAngularVelocity());
        return result;
    }

    [[nodiscard]] double row_velocity() const noexcept {
        const Vector6<double> t = twist();
        return to_core(geometry_.axis).dot(turns() ? t.tail<3>() : t.head<3>());
    }

    void write_rigid_rows(btConstraintInfo2& info) {
        const btScalar erp = rigid_erp_ < 0 ? info.erp : rigid_erp_;
        write_rigid(info, geometry_, erp * info.fps);
    }

    void write_plastic_row(btConstraintInfo2& info) {
        constexpr int row = int(rigid_rows);
        position_ = measure(geometry_, position_);
        const RowLimits<double> limits = joint_.prepare({position_, row_velocity()}, dt_);
        const auto bias = btScalar(limits.bias);
        if (turns()) {
            write_moment_row(info, row, geometry_.axis, bias);
        } else {
            write_force_row(info, row, geometry_, geometry_.axis, bias);
        }
        info.m_lowerLimit[row * info.rowskip] = btScalar(limits.lower * dt_);
        info.m_upperLimit[row * info.rowskip] = btScalar(limits.upper * dt_);
    }

    Joint& settled() {
        settle();
        return joint_;
    }

    /// Commits the open tick, if there is one.
    void settle() {
        if (!pending_) return;
        pending_ = false;
        certify_rigid_rows();
        // the velocity belongs to the row that was solved, the position to where the bodies are now
        const double velocity = row_velocity();
        force_ = double(internalGetAppliedImpulse()) / dt_;
        locate();
        position_ = measure(geometry_, position_ + velocity * dt_);
        last_ = joint_.commit({force_, velocity, position_}, dt_);
        if (last_.outcome == Outcome::broken) {
            setEnabled(false);
            if (last_.release > 0) hand_back(last_.release);
        }
    }

    /// A solved rigid row moves at its target velocity, whatever else happens.
    void certify_rigid_rows() noexcept {
        const Vector6<double> t = twist();
        const double moving = velocity_at(m_rbA, to_core(geometry_.arm_a)).norm();
        const double turning = to_core(m_rbA.getAngularVelocity()).norm();
        rigid_residual_ = 0;
        rigid_unsolved_ = false;
        for (std::size_t i = 0; i < rigid_rows; ++i) {
            const Vector3<double> relative = rows_[i].pushes ? t.head<3>() : t.tail<3>();
            const double residual =
                std::abs(to_core(rows_[i].direction).dot(relative) - double(rows_[i].bias));
            const double allowed =
                joint_.parameters().absolute_residual +
                joint_.parameters().relative_residual * (rows_[i].pushes ? moving : turning);
            rigid_residual_ = std::max(rigid_residual_, residual);
            rigid_unsolved_ = rigid_unsolved_ || residual > allowed;
        }
    }

    /// Gives the energy that the breaking step took in excess back to the motion along the axis.
    void hand_back(double energy) {
        const btVector3& joint = geometry_.frame_a.getOrigin();
        Vector6<double> axis = Vector6<double>::Zero();
        axis.segment<3>(turns() ? 3 : 0) = to_core(geometry_.axis);
        const auto a = at_joint(m_rbA, joint);
        const auto b = at_joint(m_rbB, joint);
        release_ = break_release(a, b, axis, twist(), energy);
        if (a.inverse_mass > 0) apply(m_rbA, release_.a);
        if (b.inverse_mass > 0) apply(m_rbB, release_.b);
    }

    btTransform frame_in_a_;
    btTransform frame_in_b_;
    Joint joint_;
    CommitAction action_{*this};
    Geometry geometry_;
    Step<double> last_;
    BreakRelease<double> release_;
    double dt_ = 0;
    double position_ = 0;
    double force_ = 0;
    std::array<Row, rigid_rows + 1> rows_;
    double rigid_residual_ = 0;
    bool rigid_unsolved_ = false;
    btScalar rigid_erp_ = -1; ///< negative: the world's
    bool pending_ = false;
};

} // namespace ductile::bullet
