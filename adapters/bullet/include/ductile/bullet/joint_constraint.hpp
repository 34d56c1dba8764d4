// SPDX-License-Identifier: MIT
//
// A plastic joint as a Bullet constraint of six rows: what PlasticHinge, PlasticSlider and
// PlasticJoint share. It translates bodies, rows and reactions; geometry is the core's Link,
// plasticity its joint. Signs and frames are those of link.hpp.
//
// Committing. The constraint commits each internal tick by itself: at the tick's end where it was
// added by `add_to` (which registers its action), otherwise when Bullet opens the next tick or when
// somebody asks it for a result, whichever comes first. Nothing has to be called by hand. A tick in
// which the bodies slept, or the constraint was disabled, was not solved and is not committed.
//   Only with `add_to` may bodies be moved by hand (not only given velocities) between a tick and
//   what comes first.
//
// Rows. Rigid ones first, those of the joint last; link_rows.hpp says what becomes of compliance,
// and how rigid rows are combined. In sequential impulse and NNCG a constraint that was added by
// `add_to` solves them by itself (self_solved_rows.hpp).
//
// Traps of Bullet 3.24 that this header deals with
//   - The solver leaves the impulse of a constraint's last row in `m_appliedImpulse`: with one
//     plastic row, and that the last, the reaction is exact without joint feedback.
//   - Joint feedback is a force with its torque about the centre of mass, world axes, multiplied by
//     the body's linear and angular factor.
//   - Velocities changed while the solver asks for rows are lost: what a break found there must
//     give back is given as six forces in that tick.
//   - `setBreakingImpulseThreshold` also clamps row limits: leave it infinite.
//   - Bullet turns a body by at most π/4 a step; faster spins than that are cut by the engine.
//
// Not thread-safe beyond what Bullet guarantees for a constraint.
#pragma once

#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>
#include <BulletDynamics/Dynamics/btActionInterface.h>
#include <BulletDynamics/Dynamics/btDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <type_traits>
#include <utility>

#include "ductile/bullet/convert.hpp"
#include "ductile/bullet/draw.hpp"
#include "ductile/bullet/kept_mass.hpp"
#include "ductile/bullet/link_rows.hpp"
#include "ductile/bullet/plastic_constraint.hpp"
#include "ductile/bullet/reaction.hpp"
#include "ductile/bullet/self_solved_rows.hpp"
#include "ductile/joint/link.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile::bullet {

/// What a constraint reads of its reactions.
enum class Reads {
    plastic_row, ///< of the one plastic row; the user's joint feedback is left alone
    all_rows     ///< of all six, by joint feedback: the user's where there is one, else its own
};

template <class Joint>
class JointConstraint : public PlasticConstraint, public SelfSolvedRows {
  public:
    using Axes = typename Link<Joint>::Axes;
    using State = typename Link<Joint>::State;
    /// Number of rows that the joint rules.
    static constexpr int dimension = Link<Joint>::dimension;

    JointConstraint(const JointConstraint&) = delete;
    JointConstraint& operator=(const JointConstraint&) = delete;

    /// Adds the constraint and its end-of-tick commit to a world.
    void add_to(btDynamicsWorld& world, bool disable_collisions_between_bodies = true) {
        join(world);
        world.addConstraint(this, disable_collisions_between_bodies);
        world.addAction(&action_);
        world_ = &world;
    }
    void remove_from(btDynamicsWorld& world) {
        settle();
        world.removeAction(&action_);
        world.removeConstraint(this);
        world_ = nullptr;
        leave();
    }

    /// Accumulated plastic travel p, work-conjugate, never decreases [m | rad].
    [[nodiscard]] double plastic_travel() { return settled().joint().state().plastic_travel; }
    /// Energy dissipated by plastic flow [J].
    [[nodiscard]] double absorbed_energy() override {
        return settled().joint().state().plastic_work;
    }
    [[nodiscard]] double stored_energy() override { return settled().joint().state().stored; }
    /// Share of the strength that the last tick's forces used: 1 where it flows, 0 where broken
    /// [-].
    [[nodiscard]] double utilisation() {
        const Joint& joint = settled().joint();
        if (joint.state().broken) return 0;
        if constexpr (one_axis) {
            const double force = link_.force(link_.axes()[0]);
            const double strength = joint.strength(force > 0 ? -1 : 1);
            return strength > 0 ? std::abs(force) / strength : 0;
        } else {
            return joint.utilisation();
        }
    }
    [[nodiscard]] bool broken() { return settled().broken(); }
    /// Unreliable where the solver left a row unsolved.
    [[nodiscard]] Outcome outcome() { return settled().outcome(); }
    /// Certificate: violation of the plastic rows in the last tick, and the largest so far
    /// [m/s | rad/s].
    [[nodiscard]] double residual() { return settled().last().residual; }
    [[nodiscard]] double residual_max() { return settled().joint().state().residual_max; }
    /// Largest violation of the rigid rows in the last tick [m/s | rad/s].
    [[nodiscard]] double rigid_residual() { return settled().rigid_residual(); }
    [[nodiscard]] const Joint& joint() { return settled().joint(); }
    [[nodiscard]] const BreakRelease<double>& release() override {
        settle();
        return release_;
    }

    /// All that the joint remembers: with the bodies' transforms and velocities a run goes on from
    /// it bit for bit. state_bytes.hpp turns it into bytes.
    [[nodiscard]] State state() { return settled().state(); }
    /// To be called when the bodies are back where they were. Also mends a broken joint where
    /// `state` is from before the break, and breaks it where it is from after. Forces, outcome and
    /// residuals of the last tick are not restored.
    void restore(const State& state) {
        const bool was_broken = link_.broken();
        open_ = Open::nothing;
        release_ = {};
        link_.restore(state);
        link_.look(body_motion(m_rbA), body_motion(m_rbB));
        if (link_.broken() != was_broken) setEnabled(was_broken);
    }

    [[nodiscard]] JointView view() override {
        settle();
        JointView view{.frame_a = m_rbA.getCenterOfMassTransform() * to_bullet(link_.frame_in_a()),
                       .frame_b = m_rbB.getCenterOfMassTransform() * to_bullet(link_.frame_in_b()),
                       .outcome = link_.outcome(),
                       .utilisation = utilisation()};
        if (link_.broken()) view.outcome = Outcome::broken;
        for (const JointAxis axis : all_joint_axes) {
            view.plastic_offset[Eigen::Index(index(axis))] = link_.plastic_offset(axis);
        }
        return view;
    }

    [[nodiscard]] JointReport<double> report() override {
        settle();
        const auto now =
            link_report(link_, link_.velocities(body_motion(m_rbA), body_motion(m_rbB)));
        return acts() ? now : idle_report(now);
    }

    // ---- Bullet's side

    /// Bullet's own: called for every constraint when a tick opens.
    void buildJacobian() override {
        settle_late(true);
        if (reads_ == Reads::all_rows && m_jointFeedback == nullptr &&
            sweeps_of_solver(*this, world_) == nullptr) {
            m_jointFeedback = &reading().feedback;
        }
    }

    void getInfo1(btConstraintInfo1* info) override {
        *info = {.m_numConstraintRows = 0, .nub = 0};
        close();
        if (link_.broken() && open_ != Open::hand_back) return;
        SweepGroup* sweeps = open_ == Open::hand_back ? nullptr : sweeps_of_solver(*this, world_);
        if (sweeps == nullptr) {
            info->m_numConstraintRows = 6;
            return;
        }
        const btContactSolverInfo& solver_info = world_->getSolverInfo();
        prepare(double(solver_info.m_timeStep), double(solver_info.m_erp));
        decoupled_.look(link_, order_, m_rbA, m_rbB);
        add_rows(open(*sweeps, m_rbA, m_rbB, link_.pose().arm_a(), link_.pose().arm_b()), link_,
                 order_, decoupled_, dt_);
    }

    void getInfo2(btConstraintInfo2* info) override {
        if (open_ == Open::hand_back) {
            write_impulse(*info, m_rbA, m_rbB, link_.point(), handed_);
            return;
        }
        prepare(1 / double(info->fps), double(info->erp));
        if (reads_ == Reads::all_rows) {
            reading().arm = reaction_arm(m_rbA, m_rbB, link_.point());
        }
        if constexpr (dimension < 6) {
            if (all_hard(link_)) {
                decoupled_.look(link_, order_, m_rbA, m_rbB);
                write_hard_rows(*info, link_, order_, decoupled_.rows(), dt_);
                return;
            }
        }
        write_rows(*info, m_rbA, m_rbB, link_, order_, compliance_is_exact(), dt_);
    }

    /// Bullet's own: sequential impulse calls it in each sweep.
    void solveConstraintObsolete(btSolverBody& a, btSolverBody& b, btScalar) override {
        if (is_open()) sweep(a, b);
    }

    /// BT_CONSTRAINT_ERP and BT_CONSTRAINT_STOP_ERP: share of the rigid rows' error that is removed
    /// per tick, in [0, 1]; negative (as it is at first): that of the world.
    /// @throws std::invalid_argument for a CFM: compliance follows from the joint's stiffness.
    void setParam(int num, btScalar value, int /*axis*/ = -1) override {
        if (num == BT_CONSTRAINT_ERP || num == BT_CONSTRAINT_STOP_ERP) {
            rigid_erp_ = value < 0 ? btScalar(-1)
                                   : check::between("JointConstraint.erp", value, btScalar(0),
                                                    btScalar(1), "", true);
        } else if (num == BT_CONSTRAINT_CFM || num == BT_CONSTRAINT_STOP_CFM) {
            check::fail("JointConstraint.cfm", value, "",
                        "left alone: compliance follows from the joint's stiffness");
        }
    }
    [[nodiscard]] btScalar getParam(int num, int /*axis*/ = -1) const override {
        return num == BT_CONSTRAINT_ERP || num == BT_CONSTRAINT_STOP_ERP ? rigid_erp_ : btScalar(0);
    }

  protected:
    /// Frames are in the bodies' centre-of-mass frames, z along the member. Where the bodies are
    /// now the joint is at rest.
    JointConstraint(btRigidBody& a, btRigidBody& b, const btTransform& frame_in_a,
                    const btTransform& frame_in_b, Joint joint, const Axes& axes, Reads reads)
        // no built-in type: Bullet casts by type, e.g. when it draws
        : PlasticConstraint(MAX_CONSTRAINT_TYPE, a, b),
          reads_(reads),
          order_(rigid_rotations_first(axes)),
          link_(std::move(joint), axes, to_core(frame_in_a), to_core(frame_in_b)),
          decoupled_(order_) {
        link_.start(body_motion(m_rbA), body_motion(m_rbB));
    }
    ~JointConstraint() override = default;

    /// The link after the last tick.
    Link<Joint>& settled() {
        settle();
        return link_;
    }

    /// Reaction on A in the last tick, nothing once the joint is broken: the force of a break is
    /// that of its FractureEvent [N | N m].
    double reaction_along(JointAxis axis) { return settled().broken() ? 0 : link_.force(axis); }

  private:
    static constexpr bool one_axis = !requires { Joint::dimension; };

    /// What was begun and is not yet booked.
    enum class Open {
        nothing,
        tick,     ///< rows were handed out
        hand_back ///< a break was found by the solver: this tick gives its energy back
    };

    /// Opens a tick [s]; `erp`: the world's.
    void prepare(double tick, double erp) {
        dt_ = force_share_.value * tick;
        tick_share_ = force_share_.value;
        if constexpr (!one_axis) mass_at_rest_.tell(link_, m_rbA, m_rbB);
        const bool masses = link_.reads_mass();
        link_.prepare(masses ? body_state(m_rbA) : body_motion(m_rbA),
                      masses ? body_state(m_rbB) : body_motion(m_rbB), dt_,
                      (rigid_erp_ < 0 ? erp : double(rigid_erp_)) / tick, force_share_.midway);
        open_ = Open::tick;
    }

    /// Commits at the end of each internal tick.
    struct CommitAction final : btActionInterface {
        explicit CommitAction(JointConstraint& owner) : owner_(owner) {}
        void updateAction(btCollisionWorld*, btScalar) override { owner_.settle_now(); }
        void debugDraw(btIDebugDraw* drawer) override {
            if (drawer != nullptr) draw(owner_, *drawer);
        }
        JointConstraint& owner_;
    };

    /// Commits the open tick at its end, with the bodies as they are.
    void settle_now() {
        if (open_ != Open::nothing) settle(body_motion(m_rbA), body_motion(m_rbB), false);
    }
    /// Commits the open tick some time after it.
    void settle_late(bool in_solver) {
        if (open_ == Open::nothing) return;
        settle(body_motion_of_last_tick(m_rbA), body_motion_of_last_tick(m_rbB), in_solver);
    }
    void settle() { settle_late(false); }

    void settle(const BodyState<double>& a, const BodyState<double>& b, bool in_solver) {
        const Open was = std::exchange(open_, Open::nothing);
        if (was == Open::hand_back) setEnabled(false);
        if (was != Open::tick) return;
        if (link_.commit_rows(a, b, reaction(), dt_).outcome != Outcome::broken) return;
        const BodyState<double> now_a = body_state(m_rbA), now_b = body_state(m_rbB);
        release_ = link_.release(now_a, now_b);
        if (in_solver && release_.energy > 0) {
            handed_ = link_.release_impulse(now_a, now_b);
            open_ = Open::hand_back;
            return;
        }
        setEnabled(false);
        if (release_.energy > 0) {
            apply(m_rbA, release_.a);
            apply(m_rbB, release_.b);
        }
    }

    /// Forces of the six rows on A. With one plastic row its force is exact; the others are as
    /// exact as joint feedback, and zero where that is not read.
    [[nodiscard]] Vector6<double> reaction() {
        if (is_open()) return reaction_of_own_rows();
        Vector6<double> forces = Vector6<double>::Zero();
        if (reads_ == Reads::all_rows && m_jointFeedback != nullptr) {
            forces = forces_of_rows(*m_jointFeedback, reading().arm, link_, tick_share_);
        }
        if constexpr (one_axis) {
            forces[Eigen::Index(order_.back())] = double(internalGetAppliedImpulse()) / dt_;
        }
        return forces;
    }

    /// The same where the constraint solved them by itself: exact. Tells Bullet what it would know
    /// of rows of its own.
    [[nodiscard]] Vector6<double> reaction_of_own_rows() {
        const double last = impulses()[5];
        internalSetAppliedImpulse(btScalar(last));
        if (one_axis && reads_ == Reads::plastic_row && m_jointFeedback == nullptr) {
            return last / dt_ * Vector6<double>::Unit(Eigen::Index(order_.back()));
        }
        const Vector6<double> forces = forces_of_impulses(order_, decoupled_, impulses(), dt_);
        if (m_jointFeedback != nullptr) {
            const LinkPose<double>& pose = link_.pose();
            write_feedback(*m_jointFeedback, m_rbA, m_rbB, pose.arm_a(), pose.arm_b(),
                           pose.axes() * forces.head<3>() * tick_share_,
                           pose.axes() * forces.tail<3>() * tick_share_);
        }
        return forces;
    }

    /// What reading Bullet's own rows takes.
    struct Reading {
        btJointFeedback feedback; ///< for who has none of his own
        ReactionArm arm;
    };
    [[nodiscard]] Reading& reading() {
        if (reading_ == nullptr) reading_ = std::make_unique<Reading>();
        return *reading_;
    }
    struct Nothing {};

    // what every pass over the constraints asks for comes first
    Open open_ = Open::nothing;
    Reads reads_;
    btScalar rigid_erp_ = -1; ///< negative: the world's
    double dt_ = 0;           ///< for which the rows' forces act in the open tick
    double tick_share_ = 1;    ///< as a share of the tick
    std::array<std::size_t, 6> order_; ///< axis of each row
    Link<Joint> link_;
    [[no_unique_address]] DecoupledLink<Joint> decoupled_;
    [[no_unique_address]] std::conditional_t<one_axis, Nothing, MassAtRest> mass_at_rest_;
    CommitAction action_{*this};
    std::unique_ptr<Reading> reading_; ///< where Bullet ever solved the rows
    BreakRelease<double> release_;
    JointImpulse<double> handed_; ///< what Open::hand_back gives
};

} // namespace ductile::bullet
