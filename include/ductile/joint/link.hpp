// SPDX-License-Identifier: MIT
//
// A plastic joint between two bodies of an engine, as six rows: the part of an adapter that knows
// no engine. Some rows are ruled by a plastic joint of the core (OneAxisJoint, CoupledJoint), the
// others hold rigidly.
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
// e = log(R R_pᵀ), and plastic flow Δ turns it on, R_p <- exp(Δ) R_p. The joint is shown the
// position q_p + e. A hinge may turn many times, as long as it turns less than π in one step.
//
// Certificate. A solved rigid row moves at its target velocity, whatever else happens; where one
// does not, `outcome` is unreliable although the plastic rows may look solved.
//
// Symbols
//   d, R   displacement and orientation of frame A in frame B   [m], [-]
//   e      elastic part of the rotation, axes of frame B        [rad]
//   K      inverse mass at the joint, 6×6, axes of frame B      [1/kg ... 1/(kg m²)]
//   M      mass of the plastic rows while the rigid ones hold, (K⁻¹)_pp
//
// Source: left-trivialised increments as in Solà et al. (2018), arXiv:1812.01537, eq. (25)-(28);
// the account is that of the joints.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "ductile/joint/joint_axis.hpp"
#include "ductile/joint/link_pose.hpp"
#include "ductile/joint/link_types.hpp"
#include "ductile/joint/pair.hpp"
#include "ductile/joint/rotation.hpp"
#include "ductile/vocabulary/row.hpp"

namespace ductile {

/// Not thread-safe. After construction nothing allocates or throws; O(1).
template <class Joint>
class Link {
  public:
    using S = typename Joint::Scalar;
    /// Number of rows that the joint rules.
    static constexpr int dimension = [] {
        if constexpr (requires { Joint::dimension; }) {
            return Joint::dimension;
        } else {
            return 1;
        }
    }();
    using Axes = std::array<JointAxis, std::size_t(dimension)>;
    using Limits = std::array<RowLimits<S>, 6>; ///< in the order of JointAxis
    using Step = decltype(std::declval<Joint&>().commit({}, S(0)));

    /// Plain value: copy, compare, save and restore it.
    struct State {
        typename Joint::State joint;
        Matrix3<S> rest = Matrix3<S>::Identity(); ///< R_p

        bool operator==(const State&) const = default;
    };

    /// `axes`: which axis of the link each row of the joint is, none twice; the others are rigid.
    /// @throws std::invalid_argument where an axis is given twice.
    Link(Joint joint, const Axes& axes, const JointFrame<S>& in_a, const JointFrame<S>& in_b)
        : joint_(std::move(joint)), axes_(axes), pose_(in_a, in_b) {
        for (std::size_t i = 0; i < axes_.size(); ++i) {
            if (plastic_[index(axes_[i])]) {
                throw std::invalid_argument("Link.axes[" + std::to_string(i) +
                                            "] = " + std::string(to_string(axes_[i])) +
                                            ": must differ from the axes before it");
            }
            plastic_[index(axes_[i])] = true;
        }
    }

    /// The plastic axes start unstrained where the bodies are now.
    void start(const BodyState<S>& a, const BodyState<S>& b) noexcept {
        pose_.look(a, b);
        pose_.set_rest(Matrix3<S>::Identity());
        const Vector6<S> q = strain();
        set_offset(q);
        turn_rest(q.template tail<3>());
    }

    /// The bodies were put elsewhere by the user since the last look, which is no deformation: the plastic
    /// axes keep their strain, and their rest position moves with the bodies.
    void teleport(const BodyState<S>& a, const BodyState<S>& b) noexcept {
        if (pose_.is_now(a, b)) return;
        const Vector6<S> before = strain();
        pose_.look(a, b);
        const Vector6<S> moved = from_joint(to_joint(strain() - before));
        const Vector3<S> kept = pose_.elastic_rotation() - moved.template tail<3>();
        set_offset(from_joint(offset()) + moved);
        if (!moved.template tail<3>().isZero(0)) {
            pose_.set_rest(turned_by<S>(-kept, pose_.orientation()));
        }
    }
    /// Only looks where the bodies are now.
    void look(const BodyState<S>& a, const BodyState<S>& b) noexcept { pose_.look(a, b); }

    // ---- around the solve

    /// True where `prepare` reads the bodies' inverse masses and inertias; else they may be left
    /// out of what it is shown.
    [[nodiscard]] bool reads_mass() const noexcept {
        return one_axis ? !all_rigid() : mass_at_ != pose_.rest_changes();
    }
    /// True where M only serves to predict forces: that of the rest position will do there for as
    /// long as the joint does not flow.
    [[nodiscard]] bool takes_mass_at_rest() const noexcept {
        return !one_axis && all_rigid() && !joint_.state().flowing;
    }
    /// K at the rest position (inverse_mass_along_b): used until that changes.
    void set_inverse_mass_at_rest(const Matrix6<S>& k) noexcept {
        mass_ = mass_of_rows(k, axes_);
        mass_at_ = pose_.rest_changes();
    }

    /// The rows for a step of `dt` > 0 [s]; `rate`: share of the rigid rows' error to be removed
    /// per second, >= 0 [1/s]; `midway` as Motion's. A broken joint asks for no force at all.
    const Limits& prepare(const BodyState<S>& a, const BodyState<S>& b, S dt, S rate,
                          bool midway = false) noexcept {
        pose_.look(a, b);
        const Vector6<S> error = strain();
        const bool whole = !broken();
        for (std::size_t i = 0; i < limits_.size(); ++i) {
            limits_[i] = {.bias = -rate * error[Eigen::Index(i)]};
            if (!whole) limits_[i] = {.lower = 0, .upper = 0};
        }
        offset_ = offset();
        if (reads_mass()) {
            mass_ = mass_of_rows(inverse_mass_of_rows(a, b, pose_.point(), pose_.axes()), axes_);
        }
        if constexpr (one_axis) {
            const std::size_t i = index(axes_[0]);
            limits_[i] = joint_.prepare(
                {error[Eigen::Index(i)] + offset_[0], pose_.twist_along(i, a, b), mass_(0, 0),
                 midway},
                dt);
        } else {
            const auto limits = joint_.prepare(
                {to_joint(error) + offset_, to_joint(pose_.twist(a, b)), mass_, midway}, dt);
            for (std::size_t k = 0; k < limits.size(); ++k) limits_[index(axes_[k])] = limits[k];
        }
        return limits_;
    }

    /// Books the step that `prepare` opened, with the bodies as they are after it; same `dt` [s].
    /// `wrench` is what all six rows put on body A, about the joint as `prepare` saw it.
    const Step& commit(const BodyState<S>& a, const BodyState<S>& b, const JointWrench<S>& wrench,
                       S dt) noexcept {
        Vector6<S> forces;
        forces.template head<3>() = pose_.axes().transpose() * wrench.force;
        forces.template tail<3>() = pose_.axes().transpose() * wrench.moment;
        return commit_rows(a, b, forces, dt);
    }
    /// The same with the forces of the rows, in the order of JointAxis [N | N m].
    const Step& commit_rows(const BodyState<S>& a, const BodyState<S>& b, const Vector6<S>& forces,
                            S dt) noexcept {
        // velocities belong to the rows that were solved, positions to where the bodies are now
        const Vector6<S> velocity = pose_.twist(a, b);
        force_ = forces;
        certify_rigid_rows(a, velocity);
        pose_.look(a, b);
        if constexpr (one_axis) {
            const std::size_t axis = index(axes_[0]);
            const auto i = Eigen::Index(axis);
            last_ = joint_.commit({force_[i], velocity[i], strain_along(axis) + offset_[0]}, dt);
            // the same velocity, as the next step sees it
            joint_.carry(pose_.twist_along(axis, a, b));
        } else {
            last_ = joint_.commit(
                {to_joint(force_), to_joint(velocity), to_joint(strain()) + offset_}, dt);
            joint_.carry(to_joint(pose_.twist(a, b)));
        }
        const JointVector flowed = offset() - offset_;
        if (!flowed.isZero(0)) {
            turn_rest(Vector6<S>(from_joint(flowed)).template tail<3>());
        }
        return last_;
    }

    /// What the bodies must be given back after a break, as they are now; see break_release. Zero
    /// energy: nothing.
    [[nodiscard]] BreakRelease<S> release(const BodyState<S>& a,
                                          const BodyState<S>& b) const noexcept {
        if (!(last_.release > 0)) return {};
        return break_release(pose_.at_joint(a), pose_.at_joint(b), pose_.in_world(flow()),
                             pose_.in_world(pose_.twist(a, b)), last_.release);
    }

    /// The same as an impulse on A at the joint, for engines that take it as six given forces.
    [[nodiscard]] JointImpulse<S> release_impulse(const BodyState<S>& a,
                                                  const BodyState<S>& b) const noexcept {
        if (!(last_.release > 0)) return {};
        return ductile::release_impulse(pose_.at_joint(a), pose_.at_joint(b),
                                        pose_.in_world(flow()), pose_.in_world(pose_.twist(a, b)),
                                        last_.release);
    }

    /// The engine left the link out of a step; what the bodies did meanwhile is not to be taken for
    /// what the last booked step did.
    void pause() noexcept {
        auto state = joint_.state();
        state.velocity *= S(0);
        state.start_velocity *= S(0);
        state.flowing = false;
        joint_.restore(state);
        last_ = {};
        rigid_residual_ = 0;
        rigid_unsolved_ = false;
    }

    // ---- what it says
    [[nodiscard]] const Joint& joint() const noexcept { return joint_; }
    [[nodiscard]] const Axes& axes() const noexcept { return axes_; }
    [[nodiscard]] const JointFrame<S>& frame_in_a() const noexcept { return pose_.frame_in_a(); }
    [[nodiscard]] const JointFrame<S>& frame_in_b() const noexcept { return pose_.frame_in_b(); }
    /// Of the last prepare.
    [[nodiscard]] const Limits& limits() const noexcept { return limits_; }
    [[nodiscard]] LinkRow<S> row(JointAxis axis) const noexcept {
        return {pose_.axes().col(Eigen::Index(index(axis) % 3)), turns(axis), limits_[index(axis)]};
    }
    [[nodiscard]] const Step& last() const noexcept { return last_; }
    [[nodiscard]] bool broken() const noexcept { return joint_.state().broken; }
    [[nodiscard]] bool is_plastic(JointAxis axis) const noexcept { return plastic_[index(axis)]; }

    /// Where the joint was when last looked at.
    [[nodiscard]] const LinkPose<S>& pose() const noexcept { return pose_; }
    [[nodiscard]] const Vector3<S>& point() const noexcept { return pose_.point(); }
    [[nodiscard]] const Matrix3<S>& axes_in_world() const noexcept { return pose_.axes(); }

    /// Velocities of the six rows if the bodies moved as these do, at the joint and along the axes
    /// of the last look [m/s | rad/s].
    [[nodiscard]] Vector6<S> velocities(const BodyState<S>& a,
                                        const BodyState<S>& b) const noexcept {
        return pose_.twist(a, b);
    }
    /// Position of A in frame B: d, and rotation angles that go on over many turns; of a rigid axis
    /// what it is off by [m | rad].
    [[nodiscard]] S position(JointAxis axis) const noexcept {
        return (strain() + from_joint(offset()))[Eigen::Index(index(axis))];
    }
    /// q_p; zero for a rigid axis [m | rad].
    [[nodiscard]] S plastic_offset(JointAxis axis) const noexcept {
        return from_joint(offset())[Eigen::Index(index(axis))];
    }
    /// Reaction on A along +axis of frame B in the last step, whether rigid or plastic [N | N m].
    [[nodiscard]] S force(JointAxis axis) const noexcept {
        return force_[Eigen::Index(index(axis))];
    }
    /// Forces and moments of the last step in the order of JointAxis [N | N m].
    [[nodiscard]] const Vector6<S>& forces() const noexcept { return force_; }
    /// Largest violation of the rigid rows in the last step [m/s | rad/s].
    [[nodiscard]] S rigid_residual() const noexcept { return rigid_residual_; }
    /// That of the joint, and unreliable where a rigid row was left unsolved.
    [[nodiscard]] Outcome outcome() const noexcept {
        return rigid_unsolved_ && last_.outcome != Outcome::broken ? Outcome::unreliable
                                                                   : last_.outcome;
    }

    [[nodiscard]] State state() const noexcept { return {joint_.state(), pose_.rest()}; }
    void restore(const State& state) noexcept {
        joint_.restore(state.joint);
        pose_.set_rest(state.rest);
    }

  private:
    static constexpr bool one_axis = !requires { Joint::dimension; };
    using JointVector = Eigen::Matrix<S, dimension, 1>;
    using JointMatrix = Eigen::Matrix<S, dimension, dimension>;

    /// No plastic row is elastic below yield.
    [[nodiscard]] bool all_rigid() const noexcept {
        const Eigen::Array<S, dimension, 1> stiffness(joint_.parameters().stiffness);
        return (stiffness == std::numeric_limits<S>::infinity()).all();
    }

    /// How far each axis is from rest: of a translation from q_p, of a rotation from R_p [m | rad].
    [[nodiscard]] Vector6<S> strain() const noexcept {
        Vector6<S> result;
        result.template head<3>() = pose_.displacement();
        result.template tail<3>() = pose_.elastic_rotation();
        for (std::size_t k = 0; k < axes_.size(); ++k) {
            const auto i = Eigen::Index(index(axes_[k]));
            if (i < 3) result[i] -= offset()[Eigen::Index(k)];
        }
        return result;
    }
    /// One entry of it, of a joint with one axis.
    [[nodiscard]] S strain_along(std::size_t axis) const noexcept {
        if (axis >= 3) return pose_.elastic_rotation()[Eigen::Index(axis - 3)];
        return pose_.displacement()[Eigen::Index(axis)] - offset()[0];
    }

    /// Direction of the last flow, axes of frame B.
    [[nodiscard]] Vector6<S> flow() const noexcept {
        if constexpr (one_axis) {
            return Vector6<S>::Unit(Eigen::Index(index(axes_[0])));
        } else {
            return from_joint(last_.direction);
        }
    }

    void certify_rigid_rows(const BodyState<S>& a, const Vector6<S>& velocity) noexcept {
        std::array<S, 2> worst{}; // of translations and rotations
        for (std::size_t i = 0; i < limits_.size(); ++i) {
            if (plastic_[i]) continue;
            const S residual = std::abs(velocity[Eigen::Index(i)] - limits_[i].bias);
            worst[i / 3] = std::max(worst[i / 3], residual);
        }
        rigid_residual_ = std::max(worst[0], worst[1]);
        const auto& allowed = joint_.parameters();
        rigid_unsolved_ =
            rigid_residual_ > allowed.absolute_residual &&
            (worst[0] >
                 allowed.absolute_residual + allowed.relative_residual * pose_.speed_of_a(a) ||
             worst[1] > allowed.absolute_residual + allowed.relative_residual * a.spin.norm());
    }

    /// Turns the rest orientation by what flowed about the plastic axes [rad].
    void turn_rest(const Vector3<S>& flow) noexcept {
        Vector3<S> turn = Vector3<S>::Zero();
        for (int i = 0; i < 3; ++i) {
            if (plastic_[std::size_t(3 + i)]) turn[i] = flow[i];
        }
        pose_.set_rest(turn.isZero(0) ? pose_.rest() : turned_by<S>(turn, pose_.rest()));
    }

    // ---- between the joint's rows and the six axes

    [[nodiscard]] JointVector to_joint(const Vector6<S>& six) const noexcept {
        JointVector result;
        for (int k = 0; k < dimension; ++k) {
            result[k] = six[Eigen::Index(index(axes_[std::size_t(k)]))];
        }
        return result;
    }
    [[nodiscard]] Vector6<S> from_joint(const JointVector& of_joint) const noexcept {
        Vector6<S> result = Vector6<S>::Zero();
        for (int k = 0; k < dimension; ++k) {
            result[Eigen::Index(index(axes_[std::size_t(k)]))] = of_joint[k];
        }
        return result;
    }
    /// q_p of the joint's rows.
    [[nodiscard]] JointVector offset() const noexcept {
        if constexpr (one_axis) {
            return JointVector::Constant(joint_.state().plastic_offset);
        } else {
            return joint_.state().plastic_offset;
        }
    }
    void set_offset(const Vector6<S>& six) noexcept {
        auto state = joint_.state();
        if constexpr (one_axis) {
            state.plastic_offset = to_joint(six)[0];
        } else {
            state.plastic_offset = to_joint(six);
        }
        joint_.restore(state);
    }

    Joint joint_;
    Axes axes_;
    std::array<bool, 6> plastic_{};
    LinkPose<S> pose_;
    JointMatrix mass_ = JointMatrix::Zero(); ///< M, where it is read
    /// LinkPose::rest_changes that it stays right for; the largest: that of the last prepare alone
    unsigned mass_at_ = std::numeric_limits<unsigned>::max();

    // between prepare and commit, and what the last step did
    Limits limits_{};
    JointVector offset_ = JointVector::Zero(); ///< q_p at the start of the step
    Vector6<S> force_ = Vector6<S>::Zero();    ///< axes of frame B [N | N m]
    Step last_{};
    S rigid_residual_ = 0;
    bool rigid_unsolved_ = false;
};

} // namespace ductile
