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
// PlasticHinge (joint_constraint.hpp). Where the bodies are when the motor is taken
// over is the rest position. The hinge must be in the world too; in which order does
// not matter. A hinge that is disabled, or asleep, is neither ruled nor booked.
//
// Not thread-safe beyond what Bullet guarantees for a constraint.
#pragma once

#include <BulletDynamics/ConstraintSolver/btHingeConstraint.h>

#include <utility>

#include "ductile/bullet/plastic_constraint.hpp"
#include "ductile/joint/one_axis_joint.hpp"
#include "ductile/law/perfect.hpp"
#include "ductile/vocabulary/linkage.hpp"
#include "ductile/world/axis_constraint.hpp"
#include "ductile/world/axis_queries.hpp"

namespace ductile::bullet {

/// What happens to Bullet's hinge when the row beside it breaks.
enum class AtBreak {
    disable_joint, ///< the whole hinge lets go, and its bodies collide from then on
    release_axis   ///< only the row does: the hinge turns freely
};

/// All but the joint's type.
class MotorConstraint : public PlasticConstraint, public AxisQueries {
  public:
    /// Angle of A relative to B about the axis, not wrapped [rad].
    [[nodiscard]] double rotation() const { return position(); }
    /// Accumulated plastic rotation p, work-conjugate [rad].
    [[nodiscard]] double plastic_rotation() const { return plastic_travel(); }
    /// Moment of the row in the last tick, positive where it turns A about +axis [N m].
    [[nodiscard]] double moment() const { return reaction(); }

    [[nodiscard]] const PairQueries& queries() const noexcept override { return *this; }
    [[nodiscard]] DUCTILE_INLINE JointView view() const override;

    DUCTILE_INLINE void open_rows(solve::Island& island, const IslandSeat& a, const IslandSeat& b,
                                  double tick, double erp) override;
    DUCTILE_INLINE void close_rows(const solve::Island& island) override;

    DUCTILE_INLINE void begin_part() override;
    DUCTILE_INLINE void keep_all() override;
    DUCTILE_INLINE void put_all_back() override;
    DUCTILE_INLINE void list_part_rows(std::size_t joint,
                                       std::vector<PartRow>& rows) const override;

    // ---- Bullet's side

    void buildJacobian() override { settle(); }
    DUCTILE_INLINE void getInfo1(btConstraintInfo1* info) override;
    DUCTILE_INLINE void getInfo2(btConstraintInfo2* info) override;
    /// The hinge's own parameters are set at the hinge.
    void setParam(int, btScalar, int = -1) override {}
    [[nodiscard]] btScalar getParam(int, int = -1) const override { return 0; }

  protected:
    MotorConstraint(AxisJoint& joint, btHingeConstraint& hinge, AtBreak at_break);
    /// Gives the motor back as it was; one that has broken stays off.
    DUCTILE_INLINE ~MotorConstraint() override;

    DUCTILE_INLINE void settle() const override;
    void restored(double position);

  private:
    DUCTILE_INLINE void end_tick() override;
    DUCTILE_INLINE void finish_tick() override;
    [[nodiscard]] const Step<double>* booked() const noexcept override {
        return booked_ ? &joint_.last() : nullptr;
    }
    void grant(double share) noexcept override { joint_.grant(share); }
    void book(bool late);
    [[nodiscard]] bool acts() const override { return is_awake() && hinge_.isEnabled(); }

    /// Columns, world; z about the hinge's axis.
    [[nodiscard]] Matrix3<double> axes() const;
    /// World [m].
    [[nodiscard]] Vector3<double> pivot() const;
    /// Of A minus B about the axis of this tick [rad/s].
    [[nodiscard]] double turning(const BodyState<double>& a, const BodyState<double>& b) const;
    [[nodiscard]] double measure(const BodyState<double>& a, const BodyState<double>& b,
                                 double predicted) const;
    /// K of the hinge, for rows along `axes`.
    [[nodiscard]] Matrix6<double> inverse_mass() const;
    /// Of A minus B at the pivot, world.
    [[nodiscard]] Vector6<double> twist(const BodyState<double>& a,
                                        const BodyState<double>& b) const;
    /// As its hinge has it.
    [[nodiscard]] bool collides_unasked() const noexcept override { return true; }
    void prepare();
    void take_in_hands(double now);
    void hand_back();
    /// What `keep_all` keeps beside the joint.
    struct Kept {
        BreakRelease<double> release;
        double position = 0, force = 0, unseen_turn = 0, island_unsolved = 0;
        bool restored = false, hinge_enabled = true;
    };

    static constexpr int no_row = -1;

    btHingeConstraint& hinge_;
    AtBreak at_break_;
    bool motor_was_on_;
    btScalar velocity_was_, impulse_was_;
    Vector3<double> axis_{0, 0, 1}; ///< of the open tick, world
    RowLimits<double> limits_;      ///< of it
    double dt_ = 0;                 ///< [s]
    bool pending_ = false;
    bool booked_ = false;             ///< and not finished
    bool restored_ = false;           ///< the next position is measured, not compared
    double moment_ = 0;               ///< that the island gave it [N m]
    int row_ = no_row;                ///< in the island that is being solved
    bool hinge_parts_bodies_ = false; ///< a break let the hinge's bodies collide
    Kept kept_;
};

template <class Joint = OneAxisJoint<Perfect<double>>>
class PlasticMotor final : public AxisConstraint<Joint, MotorConstraint> {
  public:
    /// The hinge has to outlive this object.
    PlasticMotor(btHingeConstraint& hinge, Joint joint, AtBreak at_break = AtBreak::disable_joint)
        : AxisConstraint<Joint, MotorConstraint>(std::move(joint), hinge, at_break) {}
};

#ifdef DUCTILE_COMPILED
extern template class PlasticMotor<UsualAxisJoint>;
#endif

} // namespace ductile::bullet

#ifndef DUCTILE_COMPILED
#include "ductile/bullet/plastic_motor.ipp"
#endif
