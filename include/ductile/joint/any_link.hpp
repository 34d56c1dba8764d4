// SPDX-License-Identifier: MIT
//
// A plastic joint between two bodies of an engine, as six rows: the part of an adapter that knows
// no engine. Some rows are ruled by a plastic joint of the core (OneAxisJoint, CoupledJoint), the
// others hold rigidly. Here is all that does not depend on the joint's type, so that an adapter is
// compiled once whatever its laws; link.hpp adds the joint.
//
//   before the solve   prepare(a, b, dt, rate)  -> limits of the six rows
//   after the solve    commit(a, b, wrench, dt) -> the joint's step
//
// Frames. Each body carries a frame, z along the member. The joint is the origin of frame A; the
// rows run along the axes of frame B. With x_A, x_B the origins and A, B the axes of the frames,
//
//   d = Bᵀ(x_A - x_B),       ḋ = Bᵀ(v_A - v_B), both velocities at the joint
//   R = BᵀA,                 Ṙ = [Bᵀ(ω_A - ω_B)]ₓ R
//
// so that a force row at the joint acts on both bodies in one point and its velocity is exactly the
// rate of d; the rate of rotation is that of the left increments of R.
//
// Finite rotation. The rest orientation R_p is a rotation, not three angles: the elastic part is
// e = log(R R_pᵀ). The joint is shown the position q_p + e; what flowed of it, Δ, leaves e - Δ:
//
//   R_p <- exp(-(e - Δ)) R;   about one axis R_p <- exp(Δ) R_p, which keeps that axis
//
// A hinge may turn many times, as long as it turns less than π in one step; a step in which it
// turned further, or its engine turned the bodies otherwise than they spin, is unreliable.
//
// Elastic rotation about several axes. A spring stores ½ e·k e, so its moment is the one conjugate
// to e, not k e itself: the rows of rotation are those of ė = G(e) ω (rotation.hpp), and k e acts
// as the moment Gᵀ k e. Then no closed path of rotations makes energy.
//
// Turning rows. In a part of a frame a body that spins goes straight on, so that what it holds
// would end it too far out, by half the turn squared. A row of it is asked to be where it should at
// the end of the part: it comes to the solve at w, across its arm, and leaves it at -w; o, along
// its way, is of third order in the turn. Joints see
// u - w - o and u' + w + o: the same sum, and so the same account. Of rigid rows w may be that of
// the spins with which the bodies leave the part, as a first solve finds them (turn_at_end): with
// those of its begin they leave it at another speed than the next one begins with, which gives h² ω
// Δω r F/2 in each part in which a body becomes faster by Δω. (Not in a step as it is, which begins
// where rows are solved: whoever stops in it had nothing that could be turned round.)
//
// Certificate. A solved rigid row moves at its target velocity, whatever else happens; where one
// does not, `outcome` is unreliable although the plastic rows may look solved. So it is where
// something else of its island is left unsolved, as the forces of contacts on its bodies are.
//
// Symbols
//   d, R   displacement and orientation of frame A in frame B   [m], [-]
//   e      elastic part of the rotation, axes of frame B        [rad]
//   w, o   velocities of a row that come of its turning         [m/s | rad/s]
//   K      inverse mass at the joint, 6×6, axes of frame B      [1/kg ... 1/(kg m²)]
//   M      mass of the plastic rows while the rigid ones hold, (K⁻¹)_pp
//
// Source: left-trivialised increments as in Solà et al. (2018), arXiv:1812.01537, eq. (25)-(28);
// the account is that of the joints.
#pragma once

#include <Eigen/Core>
#include <array>
#include <concepts>
#include <limits>
#include <optional>
#include <span>

#include "ductile/fracture/event.hpp"
#include "ductile/joint/borne_blow.hpp"
#include "ductile/joint/break_release.hpp"
#include "ductile/joint/joint_axis.hpp"
#include "ductile/joint/joint_totals.hpp"
#include "ductile/joint/link_pose.hpp"
#include "ductile/joint/link_types.hpp"
#include "ductile/joint/swing.hpp"
#include "ductile/surface/any_surface.hpp"
#include "ductile/vocabulary/on_demand.hpp"
#include "ductile/vocabulary/row.hpp"

namespace ductile {

/// Not thread-safe. After construction nothing but the first `keep` allocates or throws; O(1).
template <std::floating_point S>
class AnyLink {
  public:
    using Limits = std::array<RowLimits<S>, 6>; ///< in the order of JointAxis

    /// The plastic axes start unstrained where the bodies are now.
    void start(const BodyState<S>& a, const BodyState<S>& b) noexcept;

    /// The bodies were put elsewhere by the user since the last look, which is no deformation: the
    /// plastic axes keep their strain, and their rest position moves with the bodies; it stays
    /// where one of them is or was nowhere.
    void teleport(const BodyState<S>& a, const BodyState<S>& b) noexcept;
    /// Only looks where the bodies are now.
    void look(const BodyState<S>& a, const BodyState<S>& b) noexcept { pose_.look(a, b); }

    // ---- around the solve

    /// True where `prepare` reads the bodies' inverse masses and inertias; else they may be left
    /// out of what it is shown.
    [[nodiscard]] bool reads_mass() const noexcept {
        return !one_axis_ || !all_rigid_ || blow_.may_have();
    }

    /// The rows for a step of `dt` > 0 [s]; `rate`: share of the rigid rows' error to be removed
    /// per second, >= 0 [1/s]; `ahead` as Motion's. A broken joint asks for no force at
    /// all, nor does one of a body that is not at a finite place.
    const Limits& prepare(const BodyState<S>& a, const BodyState<S>& b, S dt, S rate,
                          bool ahead = false) noexcept;

    /// The rows were solved, and the bodies leave the part of `dt` [s] as they are shown: by how
    /// much more the rigid force rows ask for from now on, in the order of JointAxis, so that they
    /// are right for these velocities [m/s]; zero: the answer stands. Once a step.
    Vector3<S> turn_at_end(const BodyState<S>& a, const BodyState<S>& b, S dt) noexcept;
    /// False where that is zero for bodies that leave with these spins [rad/s].
    [[nodiscard]] bool may_turn_at_end(const Vector3<S>& spin_a, const Vector3<S>& spin_b,
                                       S dt) const noexcept;

    /// Books the step that `prepare` opened, with the bodies as they are after it; same `dt` [s].
    /// `wrench` is what all six rows put on body A, about the joint as `prepare` saw it. Input
    /// that is not finite changes no state: Step::residual.
    const Step<S>& commit(const BodyState<S>& a, const BodyState<S>& b,
                          const JointWrench<S>& wrench, S dt) noexcept;
    /// Of the step that `prepare` opened: by how much a row of the joint's island was missed, where
    /// it is not solved, else 0 [m/s | rad/s].
    void see_island(S unsolved) noexcept { island_unsolved_ = unsolved; }
    /// The same with the forces of the rows, in the order of JointAxis [N | N m].
    const Step<S>& commit_rows(const BodyState<S>& a, const BodyState<S>& b,
                               const Vector6<S>& forces, S dt) noexcept;

    /// Books the step again, for a share of its flow (work_share.hpp).
    virtual void grant(S share) noexcept = 0;

    /// What the bodies must be given back after a break, as they are now; see break_release. Zero
    /// energy: nothing.
    [[nodiscard]] BreakRelease<S> release(const BodyState<S>& a,
                                          const BodyState<S>& b) const noexcept;
    /// The same as an impulse on A at the joint, for engines that take it as six given forces.
    [[nodiscard]] JointImpulse<S> release_impulse(const BodyState<S>& a,
                                                  const BodyState<S>& b) const noexcept;

    /// Keeps all that a step changes, for one put_back or more.
    void keep() {
        kept_.set({pose_, force_, start_, end_, before_blow_, swing_, blow_, rigid_residual_,
                   unseen_turn_, island_unsolved_, rigid_unsolved_});
        keep_joint();
    }
    /// Everything is as it was at the last `keep`, bit for bit; the bodies have to be, too.
    void put_back() noexcept {
        pose_ = kept_->pose;
        force_ = kept_->force;
        start_ = kept_->start;
        end_ = kept_->end;
        before_blow_ = kept_->before_blow;
        swing_ = kept_->swing;
        blow_ = kept_->blow;
        rigid_residual_ = kept_->rigid_residual;
        unseen_turn_ = kept_->unseen_turn;
        island_unsolved_ = kept_->island_unsolved;
        rigid_unsolved_ = kept_->rigid_unsolved;
        put_joint_back();
    }

    /// The engine left the link out of a step; what the bodies did meanwhile is not to be taken for
    /// what the last booked step did.
    void pause() noexcept {
        pause_joint();
        blow_.forget();
        rigid_residual_ = unseen_turn_ = island_unsolved_ = 0;
        rigid_unsolved_ = false;
    }

    /// Least τ of the elastic axes in the steps to come [s].
    void damp(S time) noexcept { damping_ = time; }
    /// Whether it swings, flows or rests.
    [[nodiscard]] SwingState<S>& swing() noexcept { return swing_; }
    [[nodiscard]] const SwingState<S>& swing() const noexcept { return swing_; }

    // ---- what it says

    /// Which axis of the link each row of the joint is.
    [[nodiscard]] virtual std::span<const JointAxis> axes() const noexcept = 0;
    [[nodiscard]] virtual const JointTotals<S>& totals() const noexcept = 0;
    [[nodiscard]] virtual const Step<S>& last() const noexcept = 0; ///< the step last booked
    /// How the joint broke; nothing while it is intact.
    [[nodiscard]] virtual std::optional<FractureEvent<S>> fracture() const noexcept = 0;
    /// Share of the strength that the last step's forces use: 1 where it flows, 0 where broken [-].
    [[nodiscard]] virtual S utilisation() const noexcept = 0;
    /// Elastic stiffness of the member that the joint stands for, by axis, whether its rows are
    /// elastic or rigid; infinite where nobody said [N/m | N m/rad].
    [[nodiscard]] virtual Vector6<S> section_stiffness() const noexcept = 0;
    /// Strengths along the axes of the surface that the plastic rows share in the step that
    /// `prepare` opened; zero: they have their bounds alone [N | N m].
    [[nodiscard]] virtual Vector6<S> shared_strength() const noexcept = 0;
    /// That surface in shares of them, its axes in the order of `axes`; nothing where it is an
    /// ellipsoid and they its semi-axes.
    [[nodiscard]] virtual const AnySurface* surface() const noexcept = 0;
    /// Rules the rows of that step anew for a solver that meets the surface itself, and does not
    /// look at the bounds; same `dt` [s]. False where it cannot, as the step gives a row's force.
    /// `passes`: as CoupledJoint's.
    [[nodiscard]] virtual bool meet_surface(S dt, bool passes) noexcept = 0;

    [[nodiscard]] const JointFrame<S>& frame_in_a() const noexcept { return pose_.frame_in_a(); }
    [[nodiscard]] const JointFrame<S>& frame_in_b() const noexcept { return pose_.frame_in_b(); }
    /// Of the last prepare.
    [[nodiscard]] const Limits& limits() const noexcept { return limits_; }
    [[nodiscard]] LinkRow<S> row(JointAxis axis) const noexcept {
        const Matrix3<S>& directions = turns(axis) ? pose_.moment_axes() : pose_.axes();
        return {column(directions, int(index(axis) % 3)), turns(axis), limits_[index(axis)]};
    }
    [[nodiscard]] bool broken() const noexcept { return totals().broken; }
    [[nodiscard]] bool is_plastic(JointAxis axis) const noexcept { return plastic_[index(axis)]; }

    /// Where the joint was when last looked at.
    [[nodiscard]] const LinkPose<S>& pose() const noexcept { return pose_; }
    [[nodiscard]] const Vector3<S>& point() const noexcept { return pose_.point(); }
    [[nodiscard]] const Matrix3<S>& axes_in_world() const noexcept { return pose_.axes(); }

    /// Velocities of the six rows as last looked at, if the bodies moved as these do
    /// [m/s | rad/s].
    [[nodiscard]] Vector6<S> velocities(const BodyState<S>& a,
                                        const BodyState<S>& b) const noexcept {
        return pose_.twist(a, b);
    }
    /// Position of A in frame B: d, and rotation angles that go on over many turns; of a rigid axis
    /// what it is off by [m | rad].
    [[nodiscard]] S position(JointAxis axis) const noexcept {
        const auto i = Eigen::Index(index(axis));
        return strain()[i] + offset()[i];
    }
    /// q_p; zero for a rigid axis [m | rad].
    [[nodiscard]] S plastic_offset(JointAxis axis) const noexcept {
        return offset()[Eigen::Index(index(axis))];
    }
    /// Reaction on A along +axis of frame B in the last step, whether rigid or plastic; the moments
    /// of a joint that is elastic about several axes are those conjugate to e [N | N m].
    [[nodiscard]] S force(JointAxis axis) const noexcept {
        return force_[Eigen::Index(index(axis))];
    }
    /// Forces and moments of the last step in the order of JointAxis [N | N m].
    [[nodiscard]] const Vector6<S>& forces() const noexcept { return force_; }
    /// Velocities of the rows at the start and the end of the last step, both along them as they
    /// were solved, their turning taken out, in the order of JointAxis [m/s | rad/s].
    [[nodiscard]] const Vector6<S>& start_velocities() const noexcept { return start_; }
    [[nodiscard]] const Vector6<S>& end_velocities() const noexcept { return end_; }
    /// The same velocities at the end of it, of the rows as they are where the bodies are now; told
    /// of joints of several axes alone.
    [[nodiscard]] const Vector6<S>& turned_velocities() const noexcept { return turned_; }
    [[nodiscard]] S last_length() const noexcept { return length_; } ///< [s]
    /// What may be left of them where the joint holds, as parts of other lengths turn otherwise.
    [[nodiscard]] S turning_speed() const noexcept { return norm(linear(turning_.drift())); }
    /// Turn of a body in the last part that was too far for its rows, else 0 [rad].
    [[nodiscard]] S turned_too_far() const noexcept {
        return turning_.swept > allowed_.absolute_residual ? turning_.turn : S(0);
    }
    /// Turn in it of a body that is driven [rad].
    [[nodiscard]] S driven_turn() const noexcept { return turning_.driven; }
    /// Force at which an axis flowed or would have, in the last step [N | N m].
    [[nodiscard]] virtual S strength(JointAxis axis) const noexcept = 0;
    /// Plastic travel that nobody misses [m | rad].
    [[nodiscard]] virtual S least_travel() const noexcept = 0;
    [[nodiscard]] virtual bool snaps() const noexcept = 0;               ///< before it flows
    [[nodiscard]] bool all_rigid() const noexcept { return all_rigid_; } ///< below its strength
    /// What a row may be off by at rest [m/s | rad/s].
    [[nodiscard]] S absolute_residual() const noexcept { return allowed_.absolute_residual; }
    /// Largest violation of the rigid rows in the last step [m/s | rad/s].
    [[nodiscard]] S rigid_residual() const noexcept { return rigid_residual_; }
    /// The most of a blow that the step before the last bore, and should not have; 0: none [J].
    [[nodiscard]] S borne_blow() const noexcept { return blow_.most(); }
    /// What that is of the work so far, where it is more than the joint's parameters allow, else 0
    /// [-].
    [[nodiscard]] S borne_error() const noexcept;
    /// What the rigid rows took in the last part of a frame of velocities that were given to the
    /// bodies from elsewhere, and that they do not allow: of each |Δf Δu| h/2, by what force and
    /// velocity changed [J].
    [[nodiscard]] S unfit() const noexcept { return unfit_; }
    /// LinkPose's of the last step [rad].
    [[nodiscard]] S unseen_turn() const noexcept { return unseen_turn_; }
    /// As `see_island` was told.
    [[nodiscard]] S island_unsolved() const noexcept { return island_unsolved_; }
    /// That of the joint, and unreliable where a rigid row or the island was left unsolved, or a
    /// turn unseen.
    [[nodiscard]] Outcome outcome() const noexcept {
        const bool believed = !rigid_unsolved_ && !(unseen_turn_ > 0) && !(island_unsolved_ > 0);
        return believed || last().outcome == Outcome::broken ? last().outcome : Outcome::unreliable;
    }

  protected:
    /// The rows as a step begins, in the order of JointAxis, their turning taken out.
    struct RowsAtStart {
        Vector6<S> strain;   ///< where they are solved [m | rad]
        Vector6<S> before;   ///< at the start of a part, else the same [m | rad]
        Vector6<S> velocity; ///< u [m/s | rad/s]
        RowTurning<S> turning;
    };
    /// What the joint's parameters allow a row to be off by.
    struct Allowed {
        S absolute_residual, relative_residual, step_error;
    };
    /// `all_rigid`: no plastic row is elastic below yield.
    AnyLink(const JointFrame<S>& in_a, const JointFrame<S>& in_b, bool one_axis, bool all_rigid,
            const Allowed& allowed)
        : pose_(in_a, in_b), one_axis_(one_axis), all_rigid_(all_rigid), allowed_(allowed) {}
    AnyLink(const AnyLink&) = default;
    AnyLink(AnyLink&&) = default;
    AnyLink& operator=(const AnyLink&) = default;
    AnyLink& operator=(AnyLink&&) = default;
    ~AnyLink() = default;

    /// Of the last step nothing is known: what follows is no kick.
    void forget_velocities() noexcept {
        before_blow_.setConstant(std::numeric_limits<S>::quiet_NaN());
        blow_.forget();
    }
    /// How far each axis is from rest: of a translation from q_p, of a rotation from R_p [m | rad].
    [[nodiscard]] Vector6<S> strain() const noexcept;
    /// Turns the rest orientation by what flowed about the plastic axes [rad].
    void turn_rest(const Vector3<S>& flow) noexcept;
    /// plastic_ is known.
    void choose_rows() noexcept {
        several_turn_ = plastic_[3] + plastic_[4] + plastic_[5] > 1;
        if (several_turn_ && !all_rigid_) pose_.make_conjugate();
    }

    LinkPose<S> pose_;
    std::array<bool, 6> plastic_{};
    Limits limits_{};                       ///< between prepare and commit
    Vector6<S> force_ = Vector6<S>::Zero(); ///< of the last step, axes of frame B [N | N m]
    bool on_surface_ = false;               ///< between prepare and commit: see meet_surface
    S damping_ = 0;                         ///< see damp
    SwingState<S> swing_;

  private:
    // ---- what the joint does; six-vectors in the order of JointAxis, zero for what is not its own

    [[nodiscard]] virtual Vector6<S> offset() const noexcept = 0; ///< q_p
    virtual void set_offset(const Vector6<S>& offset) noexcept = 0;
    [[nodiscard]] virtual Vector6<S> flow() const noexcept = 0; ///< direction of the last flow
    /// M of the joint's rows from K of all.
    virtual void take_mass(const Matrix6<S>& k) noexcept = 0;
    /// Writes the limits of the joint's own rows.
    virtual void prepare_joint(const RowsAtStart& rows, S dt, bool ahead) noexcept = 0;
    /// Books force_ and `velocity` with the bodies where they are now.
    virtual void commit_joint(const Vector6<S>& velocity, const BodyState<S>& a,
                              const BodyState<S>& b, S dt) noexcept = 0;
    virtual void pause_joint() noexcept = 0;
    virtual void leave_unbooked() noexcept = 0; ///< the step was of input that is not finite
    virtual void keep_joint() = 0;
    virtual void put_joint_back() noexcept = 0;

    /// Of force and of moment rows that are so far from rest: removal_rate.
    [[nodiscard]] std::array<S, 2> removal_rates(const Vector6<S>& strain, const BodyState<S>& a,
                                                 const BodyState<S>& b, S rate) const noexcept;
    /// The velocities with which a step of `dt` [s] starts would strain a row noticeably, and
    /// neither the joint nor its last step gave them to its bodies.
    [[nodiscard]] bool is_kicked(S dt) const noexcept;
    /// `unfit` of a part of `dt` [s] that changed the rows' forces by these.
    [[nodiscard]] S struck(const BodyState<S>& a, const Vector6<S>& forces, S dt) const noexcept;
    void certify_rigid_rows(const BodyState<S>& a, const Vector6<S>& velocity) noexcept;
    /// Whether a row is off by no more than its joint's parameters allow.
    [[nodiscard]] bool within(S residual, S speed) const noexcept {
        return residual <= allowed_.absolute_residual + allowed_.relative_residual * speed;
    }

    /// What `keep` keeps.
    struct Kept {
        LinkPose<S> pose;
        Vector6<S> force, start, end, before_blow;
        SwingState<S> swing;
        BorneBlow<S> blow;
        S rigid_residual, unseen_turn, island_unsolved;
        bool rigid_unsolved;
    };

    static constexpr S noticed_turn = S(0.1); ///< of the residual that is allowed

    OnDemand<Kept> kept_;
    Vector6<S> start_ = Vector6<S>::Zero(), end_ = Vector6<S>::Zero(); ///< u, u'
    Vector6<S> turned_ = Vector6<S>::Zero();      ///< u' of the rows as they are now
    S length_ = 0;                                ///< of the last step [s]
    S unfit_ = 0;                                 ///< [J]
    Vector6<S> before_blow_ = Vector6<S>::Zero(); ///< u' of the last step in which time passed
    RowTurning<S> turning_;                       ///< between prepare and commit
    Vector3<S> asked_ = Vector3<S>::Zero();       ///< of force rows, by it alone
    bool ahead_ = false;                          ///< they were half a step ahead in it
    bool sound_ = true;                           ///< the bodies of the last prepare were somewhere
    BorneBlow<S> blow_;
    S rigid_residual_ = 0;
    S unseen_turn_ = 0;
    S island_unsolved_ = 0;
    bool rigid_unsolved_ = false;
    bool one_axis_;
    bool all_rigid_;
    bool several_turn_ = false; ///< more than one plastic axis of rotation
    Allowed allowed_;
};

} // namespace ductile

#include "ductile/joint/any_link.ipp" // IWYU pragma: export
