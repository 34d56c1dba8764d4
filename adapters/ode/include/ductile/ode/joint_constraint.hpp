// SPDX-License-Identifier: MIT
//
// A plastic joint of six rows between two bodies of an ODE world: what PlasticHinge, PlasticSlider
// and PlasticJoint share. The rows, the finite rotation and the account are the core's Link.
//
// Who solves. Where all that hangs together with the joint is known, World solves it before ODE's
// step (island_solver.hpp), and the joint is a force on its bodies. Else its rows are handed to
// ODE.
//
// Rows. ODE has no joint with six bounded rows at a point, so two kinds of ODE's act together:
//   moments  an angular motor in user mode, its axes set anew in every step; it is id()
//   forces   rows at the joint's point, made for the step (point_rows.hpp), and so are the moments
//            where one of their rows is out of the direct solver's scale: the motor then rests
// A rigid row has infinite strength. Bounds that are not symmetric, as those of a coupled surface
// are, become a force from outside and a symmetric row (symmetric_row.hpp). All rows together act
// on both bodies at one point, so what one loses in momentum the other gains.
//
// Ties. Where rows repeat each other, as in a beam that is clamped at both ends, the direct solver
// would divide by zero. Every row therefore yields a little: by RowLimits::softness, far less than
// its section would, so that forces are shared out as in the elastic structure, and by `softness`
// of the velocity that its own force gives to the two bodies in the step where nobody named a
// section.
//
// Rigid axes are pulled together by the world's ERP a step, as ODE's own joints are.
//
// Life in a world. The joint does nothing in a step in which ODE does not solve it: while both
// bodies sleep, while id() is disabled by the user, while neither body can move, and for ever after
// one of the bodies is destroyed. What its bodies do meanwhile, and what somebody moves by hand
// between two steps, is no deformation: the plastic axes keep their strain, their rest position
// goes along. Rigid axes are pulled together again. A broken joint stays broken; its angular motor
// is disabled and attached to nothing, so that dAreConnected, by which programs decide whether two
// bodies collide, no longer finds it. ODE's world may be destroyed before the joint.
//
// Bodies turn by ODE's first-order rule unless dBodySetFiniteRotationMode(body, 1) is set, which
// loses (ω dt)³/12 rad a step: set it where plastic rotations per step are large.
//
// Not thread-safe.
#pragma once

#include <ode/ode.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "ductile/joint/any_link.hpp"
#include "ductile/ode/plastic_constraint.hpp"
#include "ductile/ode/point_rows.hpp"
#include "ductile/ode/world.hpp"
#include "ductile/ode/world_life.hpp"
#include "ductile/vocabulary/linkage.hpp"
#include "ductile/vocabulary/on_demand.hpp"
#include "ductile/world/joint_checks.hpp"
#include "ductile/world/link_joint.hpp"
#include "ductile/world/link_queries.hpp"

namespace ductile::ode {

/// All but the joint's type.
class JointConstraint : public PlasticConstraint, public LinkQueries, private IslandRows {
  public:
    void add_to(World& world, std::string name = {}) { world.add(*this, std::move(name)); }
    void remove_from(World& world) { world.remove(*this); }

    /// True where one of the bodies was destroyed: the joint does nothing any more.
    [[nodiscard]] bool detached() const;
    [[nodiscard]] const PairQueries& queries() const noexcept override { return *this; }
    /// All but what the angular motor did.
    [[nodiscard]] const OutsideForce& outside_force() const override { return outside_; }
    /// The angular motor; owned by this object, as is its feedback.
    [[nodiscard]] dJointID id() const override { return id_; }
    [[nodiscard]] AttachedBodies bodies() const override { return {a_, b_, false}; }

    [[nodiscard]] IslandRows* island_rows() noexcept override { return this; }

    [[nodiscard]] SwingState<double>* swing() noexcept override {
        return link_.broken() ? nullptr : &link_.swing();
    }
    [[nodiscard]] DUCTILE_INLINE bool is_awake_member() const override;
    [[nodiscard]] DUCTILE_INLINE std::array<const void*, 2> moving_bodies() const override;
    void damp(double time) noexcept override { link_.damp(time); }
    DUCTILE_INLINE void keep_awake() override;

    /// Rules the rows of a step of `dt` [s]. Called by World::step.
    DUCTILE_INLINE void prepare(double dt) override;
    /// Books the step. Called by World::step.
    DUCTILE_INLINE void commit(double dt) override;
    /// After a break gives its energy back. Called by World::step.
    DUCTILE_INLINE void finish() override;
    DUCTILE_INLINE void stand() override;

    DUCTILE_INLINE void left_world() override;
    DUCTILE_INLINE bool begin_frame() override;
    DUCTILE_INLINE void driven_begins(dBodyID body, const Vector3<double>& velocity,
                                      const Vector3<double>& spin) override;
    DUCTILE_INLINE void keep_all() override;
    DUCTILE_INLINE void put_all_back() override;
    DUCTILE_INLINE void list_part_rows(std::size_t joint,
                                       std::vector<PartRow>& rows) const override;
    [[nodiscard]] const Step<double>* booked() const noexcept override {
        return booked_ ? &link_.last() : nullptr;
    }
    void grant(double share) noexcept override { link_.grant(share); }

  protected:
    using Frame = JointFrame<double>;

    /// The plastic axes start unstrained where the bodies are now.
    JointConstraint(AnyLink<double>& link, dWorldID world, dBodyID a, dBodyID b,
                    Meeting meeting = Meeting::required);
    DUCTILE_INLINE ~JointConstraint() override;

    /// The link was given a saved state.
    void restored(bool was_broken);

    /// `a`, of a joint of this `kind`.
    static dBodyID require_bodies(const char* kind, dWorldID world, dBodyID a, dBodyID b);
    static const Frame& require_frame(const char* name, const Frame& frame);
    /// z along `axis` at `origin`, world; `kind`: whose.
    static Frame frame_along(const std::string& kind, const Vector3<double>& axis,
                             const Vector3<double>& origin);
    /// Between the centres of mass; that of `a` where `b` is null [m]. `a` may be null too.
    static Vector3<double> midway(dBodyID a, dBodyID b);
    /// A frame given in the world, in the axes of a body (null: the static world), from its centre.
    static Frame frame_in(dBodyID body, const Frame& world);

  private:
    [[nodiscard]] bool is_silent() const override { return silent_; }

    // ---- around ODE's step
    [[nodiscard]] bool acts() const override { return acting_; }
    [[nodiscard]] bool rests() const override { return link_.swing().rests(); }
    DUCTILE_INLINE void open_rows(solve::Island& island, const IslandSeat& a, const IslandSeat& b,
                                  double dt) override;
    [[nodiscard]] DUCTILE_INLINE bool turn_rows(solve::Island& island, const IslandSeat& a,
                                                const IslandSeat& b, double dt) override;
    DUCTILE_INLINE void close_rows(const solve::Island& island, double dt) override;
    DUCTILE_INLINE void make_rows(double dt) override;

    [[nodiscard]] bool may_act() const;
    /// True where ODE did solve the rows: it wakes whatever hangs on a body that is awake.
    [[nodiscard]] bool solved() const;
    void set_motor(int number, const PointRow& moment, bool on);
    void rest_motor();
    /// What no row of ODE's gives, as an outside force on both bodies.
    void add_centre(double sign);
    /// The bodies as the step finds them.
    [[nodiscard]] std::array<BodyState<double>, 2> at_start(double dt);
    void hand_back();
    void let_go();

    dBodyID a_;
    dBodyID b_;
    std::shared_ptr<const WorldLife> life_;
    PointRows forces_;
    dJointID id_ = nullptr;
    dJointFeedback moments_{};
    Vector3<double> arm_a_ = Vector3<double>::Zero(); ///< joint minus centre of mass, world [m]
    Vector3<double> arm_b_ = Vector3<double>::Zero();
    JointWrench<double> centre_; ///< c of all rows; of an island that is solved all there is
    int first_row_ = 0;          ///< in that island
    /// What that island's rows bore [N | N m]: told by forces and torques in the world, a weak row
    /// would be lost in the round-off of strong ones.
    std::optional<Vector6<double>> solved_rows_;
    bool motor_on_ = true;
    DrivenPair driven_;
    OutsideForce outside_;
    bool put_back_ = false; ///< a saved state, with which the bodies move back
    bool booked_ = false;   ///< and not finished
    bool acting_ = false;   ///< between prepare and commit: the joint takes part in this step
    bool silent_ = true;    ///< no force
    bool holds_on_ = false; ///< broken, in a step that does not stand yet
    /// What `keep_all` keeps beside the link.
    struct Kept {
        BreakRelease<double> release;
        OutsideForce outside;
        DrivenPair driven;
        bool silent = true;
    };
    OnDemand<Kept> kept_;
};

} // namespace ductile::ode

#ifndef DUCTILE_COMPILED
#include "ductile/ode/joint_constraint.ipp"
#endif
