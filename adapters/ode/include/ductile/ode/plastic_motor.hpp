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
//
// Body A moves relative to body B (null: the static world):
//   u = axis · (ω_A - ω_B)              turning                                       [rad/s]
//   u = axis · (v_A - v_B)              sliding, taken midway between the two bodies  [m/s]
//
// The core's row becomes the motor and an outside force (vocabulary/symmetric_row.hpp): the row's
// force is the motor's share of the joint's feedback plus that centre. A row with a given force
// needs no motor.
//
// Life in a world. The row does nothing in a step in which ODE does not solve its joint: while both
// bodies sleep, while the joint is disabled by the user, while neither body can move (kinematic),
// and for ever after one of the bodies is destroyed or the joint is attached anew. What the bodies
// do meanwhile, and what somebody moves by hand between two steps, is no deformation: the rest
// position goes along, and what is stored stays stored. A broken joint stays broken.
//
// A joint that lets go at its break is attached to nothing, so that dAreConnected, by which
// programs decide whether two bodies collide, no longer finds it. ODE's world may be destroyed
// before this. The joint's other rows are ODE's; where all of the island is known the World
// solves them with it (island_solver.hpp).
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

#include <memory>
#include <string>
#include <utility>

#include "ductile/joint/one_axis_joint.hpp"
#include "ductile/law/perfect.hpp"
#include "ductile/ode/joint_axes.hpp"
#include "ductile/ode/motor_axis.hpp"
#include "ductile/ode/motor_pose.hpp"
#include "ductile/ode/plastic_constraint.hpp"
#include "ductile/ode/world.hpp"
#include "ductile/ode/world_life.hpp"
#include "ductile/vocabulary/linkage.hpp"
#include "ductile/world/axis_constraint.hpp"
#include "ductile/world/axis_queries.hpp"

namespace ductile::ode {

/// What happens to ODE's joint when its plastic row breaks.
enum class AtBreak {
    disable_joint, ///< the whole joint lets go: it is disabled, and attached to nothing
    release_axis   ///< only the row does: its motor is switched off
};

/// All but the joint's type.
class MotorConstraint : public PlasticConstraint, public AxisQueries {
  public:
    void add_to(World& world, std::string name = {}) { world.add(*this, std::move(name)); }
    void remove_from(World& world) { world.remove(*this); }

    /// True where one of the bodies was destroyed or the joint was attached anew: the row does
    /// nothing any more.
    [[nodiscard]] bool detached() const { return detached_; }
    [[nodiscard]] const PairQueries& queries() const noexcept override { return *this; }
    [[nodiscard]] const OutsideForce& outside_force() const override { return outside_; }
    /// ODE's joint.
    [[nodiscard]] dJointID id() const override { return row_.joint(); }
    [[nodiscard]] AttachedBodies bodies() const override { return row_.bodies(); }
    [[nodiscard]] int motor() const noexcept override { return row_.number(); }

    /// @throws std::logic_error where somebody set a stop on the axis since it was taken over.
    DUCTILE_INLINE void check() const override;
    /// Sets the motor for a step of `dt` [s]. Called by World::step.
    DUCTILE_INLINE void prepare(double dt) override;
    /// Books the step. Called by World::step.
    DUCTILE_INLINE void commit(double dt) override;
    /// After a break gives its energy back. Called by World::step.
    DUCTILE_INLINE void finish() override;
    /// Then lets go of the joint.
    DUCTILE_INLINE void stand() override;

    DUCTILE_INLINE void left_world() override { give_motor_back(); }
    DUCTILE_INLINE void driven_begins(dBodyID body, const Vector3<double>& velocity,
                                      const Vector3<double>& spin) override;
    DUCTILE_INLINE bool begin_frame() override;
    DUCTILE_INLINE void keep_all() override;
    DUCTILE_INLINE void put_all_back() override;
    DUCTILE_INLINE void list_part_rows(std::size_t joint,
                                       std::vector<PartRow>& rows) const override;
    [[nodiscard]] const Step<double>* booked() const noexcept override {
        return booked_ ? &joint_.last() : nullptr;
    }
    void grant(double share) noexcept override { joint_.grant(share); }

  protected:
    /// @throws std::invalid_argument where the axis has a stop.
    MotorConstraint(AxisJoint& joint, const MotorAxis& row, AtBreak at_break);
    /// Gives the motor back.
    DUCTILE_INLINE ~MotorConstraint() override;

    /// The joint was given a saved state.
    void restored(double position);

  private:
    struct UsersMotor {
        double velocity, strength, cfm;
    };

    [[nodiscard]] Outcome last_outcome() const override {
        return rigid_unsolved_ && joint_.last().outcome != Outcome::broken
                   ? Outcome::unreliable
                   : AxisQueries::last_outcome();
    }
    /// Of the pin for hinges and universals; other rigid rows are not known.
    [[nodiscard]] double last_rigid_residual() const override { return rigid_residual_; }

    static bool has_stop(const MotorAxis& row);
    [[nodiscard]] bool may_act() const;
    /// True where ODE did solve the joint: it wakes whatever hangs on a body that is awake.
    [[nodiscard]] bool solved() const;
    /// Holds the account where it is while the row does nothing.
    void suspend();
    /// The bodies were put elsewhere since the last step: the rest position goes along.
    [[nodiscard]] double follow_teleport();
    /// Where the row is now, some `way` from where it was when it was `last` looked at.
    [[nodiscard]] double moved_from(const MotorPose& last, double way) const;
    void part();
    void give_motor_back();

    [[nodiscard]] Vector6<double> direction() const;
    /// What the row moves while the joint's other rows hold [kg | kg m²]; 0: not known.
    [[nodiscard]] double mass() const;
    /// u of a step of `dt` [s]: of the bodies as they start it [m/s | rad/s].
    [[nodiscard]] double start_velocity(double dt) const;
    void set_motor(const RowLimits<double>& limits, double dt);
    void apply_centre();
    /// The step was not one for these bodies; ODE keeps what was applied for it.
    void take_back();
    void add_outside(double sign);
    /// A solved rigid row moves at its target velocity, whatever else happens. `apart`: velocity of
    /// A at the pin less that of B, after the solve [m/s].
    void certify_pin(const Vector3<double>& apart, double dt);
    [[nodiscard]] Vector3<double> pin_turning(double dt) const;
    /// Of the plastic row: its impulse over the time for which it acted.
    [[nodiscard]] double row_force() const;
    /// Gives the energy that the breaking step took in excess back to the motion along the axis.
    void hand_back(double energy);

    MotorAxis row_;
    std::shared_ptr<const WorldLife> life_;
    AtBreak at_break_;
    UsersMotor users_;
    dJointFeedback feedback_{};
    MotorPose pose_;                      ///< at the start of the step, from commit on at its end
    Vector3<double> pin_target_{0, 0, 0}; ///< NaN where it is not known [m/s]
    Vector3<double> turned_pin_{0, 0, 0}; ///< the same at the end of a part, less its turning
    double rigid_residual_ = 0;           ///< largest component [m/s]
    bool rigid_unsolved_ = false;
    OutsideForce outside_;
    DrivenPair driven_;
    double length_ = 0;   ///< of the step [s]
    double centre_ = 0;   ///< c [N | N m]
    double strength_ = 0; ///< h [N | N m]
    bool booked_ = false; ///< and not finished
    bool acting_ = false; ///< between prepare and commit: the row takes part in this step
    bool detached_ = false;
    bool restored_ = false; ///< the next position is measured, not compared
    bool holds_on_ = false; ///< broken, in a step that does not stand yet
    /// What `keep_all` keeps beside the joint.
    struct Kept {
        BreakRelease<double> release;
        double position = 0, force = 0, unseen_turn = 0, rigid_residual = 0;
        bool rigid_unsolved = false, restored = false;
        MotorPose pose;
        OutsideForce outside;
        DrivenPair driven;
    };
    Kept kept_;
};

template <class Joint = OneAxisJoint<Perfect<double>>>
class PlasticMotor final : public AxisConstraint<Joint, MotorConstraint> {
  public:
    /// @throws std::invalid_argument where a stop is set on the axis.
    PlasticMotor(const MotorAxis& axis, Joint joint, AtBreak at_break = AtBreak::disable_joint)
        : AxisConstraint<Joint, MotorConstraint>(std::move(joint), axis, at_break) {}
};

#ifdef DUCTILE_COMPILED
extern template class PlasticMotor<UsualAxisJoint>;
#endif

} // namespace ductile::ode

#ifndef DUCTILE_COMPILED
#include "ductile/ode/plastic_motor.ipp"
#endif
