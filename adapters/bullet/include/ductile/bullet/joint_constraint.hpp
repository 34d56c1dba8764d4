// SPDX-License-Identifier: MIT
//
// A plastic joint as a Bullet constraint of six rows: what PlasticHinge, PlasticSlider and
// PlasticJoint share. It translates bodies, rows and reactions; geometry is the core's link,
// plasticity its joint. Signs and frames are those of any_link.hpp, booking and life in a world
// those of plastic_constraint.hpp.
//
// Rows. In a World the island's (island_solver.hpp), with exact reactions. Elsewhere six plain rows
// for the user's solver, rigid ones first, those of the joint last; link_rows.hpp says what becomes
// of compliance. What that solver leaves unsolved the joint calls unreliable.
//
// Traps of Bullet 3.24 that this header deals with
//   - The solver leaves the impulse of a constraint's last row in `m_appliedImpulse`: with one
//     plastic row, and that the last, the reaction is exact without joint feedback.
//   - Joint feedback is a force with its torque about the centre of mass, world axes, multiplied by
//     the body's linear and angular factor.
//   - Velocities changed while the solver asks for rows are lost: what a break found there must
//     give back is given as six forces in that tick.
//   - `setBreakingImpulseThreshold` also clamps row limits: leave it infinite.
//   - Beyond π/4 a step Bullet turns a body less than it spins, by 11 % at 1.5 rad: the joint is
//     then unreliable.
//
// Not thread-safe beyond what Bullet guarantees for a constraint.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <utility>

#include "ductile/bullet/convert.hpp"
#include "ductile/bullet/plastic_constraint.hpp"
#include "ductile/joint/any_link.hpp"
#include "ductile/vocabulary/linkage.hpp"
#include "ductile/vocabulary/on_demand.hpp"
#include "ductile/world/joint_checks.hpp"
#include "ductile/world/link_joint.hpp"
#include "ductile/world/link_queries.hpp"

namespace ductile::bullet {

/// What a constraint reads of its reactions.
enum class Feedback {
    plastic_row, ///< of the one plastic row; the user's joint feedback is left alone
    all_rows     ///< of all six, by joint feedback: the user's where there is one, else its own
};

class JointConstraint : public PlasticConstraint, public LinkQueries {
  public:
    [[nodiscard]] const PairQueries& queries() const noexcept override { return *this; }
    [[nodiscard]] DUCTILE_INLINE JointView view() const override;

    DUCTILE_INLINE void open_rows(solve::Island& island, const IslandSeat& a, const IslandSeat& b,
                                  double tick, double erp) override;
    [[nodiscard]] DUCTILE_INLINE bool turn_rows(solve::Island& island, const IslandSeat& a,
                                                const IslandSeat& b) override;
    DUCTILE_INLINE void close_rows(const solve::Island& island) override;

    DUCTILE_INLINE void begin_part() override;
    DUCTILE_INLINE void keep_all() override;
    DUCTILE_INLINE void put_all_back() override;
    DUCTILE_INLINE void list_part_rows(std::size_t joint,
                                       std::vector<PartRow>& rows) const override;

    // ---- a structure's side

    [[nodiscard]] SwingState<double>* swing() noexcept override {
        return link_.broken() ? nullptr : &link_.swing();
    }
    void damp(double time) noexcept override { link_.damp(time); }

    // ---- Bullet's side

    /// Bullet's own: called for every constraint when a tick opens.
    DUCTILE_INLINE void buildJacobian() override;
    DUCTILE_INLINE void getInfo1(btConstraintInfo1* info) override;
    DUCTILE_INLINE void getInfo2(btConstraintInfo2* info) override;

    /// BT_CONSTRAINT_ERP and BT_CONSTRAINT_STOP_ERP: share of the rigid rows' error that is removed
    /// per tick, in [0, 1]; negative (as it is at first): that of the world.
    /// @throws std::invalid_argument for a CFM: compliance follows from the joint's stiffness.
    DUCTILE_INLINE void setParam(int num, btScalar value, int axis = -1) override;
    [[nodiscard]] DUCTILE_INLINE btScalar getParam(int num, int axis = -1) const override;

  protected:
    /// Where the bodies are now the joint is at rest.
    JointConstraint(AnyLink<double>& link, btRigidBody& a, btRigidBody& b, Feedback feedback,
                    Meeting meeting);
    DUCTILE_INLINE ~JointConstraint() override;

    DUCTILE_INLINE void settle() const override;
    /// The link was given a saved state.
    void restored(bool was_broken);

  private:
    /// What was begun and is not yet booked.
    enum class Open {
        nothing,
        tick,     ///< rows were handed out
        hand_back ///< a break was found by the solver: this tick gives its energy back
    };
    /// What `keep_all` keeps beside the link.
    struct Kept {
        BreakRelease<double> release;
        Vector6<double> forces = Vector6<double>::Zero();
        bool told = false;
    };
    static constexpr int no_rows = -1;
    struct Reading; ///< what reading Bullet's own rows takes

    [[nodiscard]] bool one_axis() const noexcept { return link_.axes().size() == 1; }
    /// Opens a tick [s]; `erp`: the world's.
    void prepare(double tick, double erp);
    DUCTILE_INLINE void end_tick() override;
    DUCTILE_INLINE void finish_tick() override;
    [[nodiscard]] const Step<double>* booked() const noexcept override {
        return booked_ ? &link_.last() : nullptr;
    }
    void grant(double share) noexcept override { link_.grant(share); }
    /// Commits the open tick, and lets go where that broke the joint, some time after it.
    void settle_late(bool in_solver);
    void book(bool late);
    void finish(bool in_solver);
    /// Forces of the six rows on A. With one plastic row its force is exact; the others are as
    /// exact as joint feedback, and zero where that is not read.
    [[nodiscard]] Vector6<double> reaction();
    [[nodiscard]] Reading& reading();

    [[nodiscard]] bool acts() const override { return is_awake(); }

    // what every pass over the constraints asks for comes first
    Open open_ = Open::nothing;
    bool booked_ = false; ///< and not finished
    Feedback feedback_;
    int first_row_ = no_rows;                          ///< in the island that is being solved
    bool told_ = false;                                ///< the island said its forces
    Vector6<double> forces_ = Vector6<double>::Zero(); ///< these, in the open tick [N | N m]
    btScalar rigid_erp_ = -1;                          ///< negative: the world's
    double dt_ = 0;                                    ///< of the open tick [s]
    std::array<std::size_t, 6> order_;                 ///< axis of each row
    std::unique_ptr<Reading> reading_;                 ///< where Bullet ever solved the rows
    JointImpulse<double> handed_;                      ///< what Open::hand_back gives
    OnDemand<Kept> kept_;
};

/// A constraint with a joint of a given type.
template <class Joint>
class JointConstraintOf : public LinkJoint<Joint, JointConstraint> {
    using Base = LinkJoint<Joint, JointConstraint>;

  protected:
    /// Frames are in the bodies' centre-of-mass frames, z along the member.
    /// @throws std::invalid_argument where a frame is not finite or not orthonormal, where rigid
    /// axes of the two bodies are apart (joint_checks.hpp), where both bodies are one, or both
    /// static.
    JointConstraintOf(btRigidBody& a, btRigidBody& b, const btTransform& frame_in_a,
                      const btTransform& frame_in_b, Joint joint, const typename Base::Axes& axes,
                      Feedback feedback, Meeting meeting = Meeting::required)
        : Base(
              Link<Joint>{std::move(joint), axes, checked("JointConstraint.frame_in_a", frame_in_a),
                          checked("JointConstraint.frame_in_b", frame_in_b)},
              a, b, feedback, meeting) {}

  private:
    static JointFrame<double> checked(const char* field, const btTransform& frame) {
        constexpr double round_off = 1e-5; // of axes made in float
        return require_frame(field, to_core(frame), round_off);
    }
};

} // namespace ductile::bullet

#ifndef DUCTILE_COMPILED
#include "ductile/bullet/joint_constraint.ipp"
#endif
