// SPDX-License-Identifier: MIT
//
// A plastic joint between two bodies of an engine, as six rows: the part of an adapter that knows
// no engine. Some rows are ruled by a plastic joint of the core (OneAxisJoint, CoupledJoint), the
// others hold rigidly.
//
//   before the solve   prepare(a, b, dt, rate)  -> six LinkRows
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
#include <Eigen/Geometry>
#include <Eigen/LU>
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
    using Rows = std::array<LinkRow<S>, 6>;
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
        : joint_(std::move(joint)), axes_(axes), in_a_(in_a), in_b_(in_b) {
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
        locate(a, b);
        rest_.setIdentity();
        const Vector6<S> q = strain();
        set_offset(q);
        turn_rest(q.template tail<3>());
    }

    /// Only looks where the bodies are now.
    void look(const BodyState<S>& a, const BodyState<S>& b) noexcept { locate(a, b); }

    // ---- around the solve

    /// The rows for a step of `dt` > 0 [s]; `rate`: share of the rigid rows' error to be removed
    /// per second, >= 0 [1/s]. A broken joint asks for no force at all.
    const Rows& prepare(const BodyState<S>& a, const BodyState<S>& b, S dt, S rate) noexcept {
        locate(a, b);
        const Vector6<S> error = strain();
        const Vector6<S> velocity = twist_in_b(a, b);
        for (const JointAxis axis : all_joint_axes) {
            const std::size_t i = index(axis);
            const Vector3<S> direction = frame_b_.col(Eigen::Index(i % 3));
            rows_[i] = {.direction = direction, .turns = turns(axis), .limits = {}};
            rows_[i].limits.bias = -rate * error[Eigen::Index(i)];
            if (broken()) rows_[i].limits = {.lower = 0, .upper = 0};
        }
        offset_ = offset();
        const Vector6<S> position = error + from_joint(offset_);
        if constexpr (one_axis) {
            const auto i = Eigen::Index(index(axes_[0]));
            const bool rigid = joint_.parameters().stiffness == std::numeric_limits<S>::infinity();
            const S mass = rigid ? S(0) : row_mass(a, b)(0, 0);
            rows_[std::size_t(i)].limits = joint_.prepare({position[i], velocity[i], mass}, dt);
        } else {
            const auto limits =
                joint_.prepare({to_joint(position), to_joint(velocity), row_mass(a, b)}, dt);
            for (std::size_t k = 0; k < limits.size(); ++k)
                rows_[index(axes_[k])].limits = limits[k];
        }
        return rows_;
    }

    /// Books the step that `prepare` opened, with the bodies as they are after it; same `dt` [s].
    /// `wrench` is what all six rows put on body A, about the joint as `prepare` saw it.
    const Step& commit(const BodyState<S>& a, const BodyState<S>& b, const JointWrench<S>& wrench,
                       S dt) noexcept {
        // velocities belong to the rows that were solved, positions to where the bodies are now
        const Vector6<S> velocity = twist_in_b(a, b);
        force_ << frame_b_.transpose() * wrench.force, frame_b_.transpose() * wrench.moment;
        certify_rigid_rows(a, velocity);
        locate(a, b);
        const Vector6<S> position = strain() + from_joint(offset_);
        const Vector6<S> turned = twist_in_b(a, b); // the same velocities, as the next step sees them
        if constexpr (one_axis) {
            const auto i = Eigen::Index(index(axes_[0]));
            last_ = joint_.commit({force_[i], velocity[i], position[i]}, dt);
            joint_.carry(turned[i]);
            flow_ = Vector6<S>::Unit(i);
        } else {
            last_ = joint_.commit({to_joint(force_), to_joint(velocity), to_joint(position)}, dt);
            joint_.carry(to_joint(turned));
            flow_ = from_joint(last_.direction);
        }
        const Vector6<S> flowed = from_joint(offset() - offset_);
        turn_rest(flowed.template tail<3>());
        return last_;
    }

    /// What the bodies must be given back after a break, as they are now; see break_release. Zero
    /// energy: nothing.
    [[nodiscard]] BreakRelease<S> release(const BodyState<S>& a,
                                          const BodyState<S>& b) const noexcept {
        if (!(last_.release > 0)) return {};
        return break_release(at_joint(a), at_joint(b), flow_in_world(), twist_in_world(a, b),
                             last_.release);
    }

    /// The same as an impulse on A at the joint, for engines that take it as six given forces.
    [[nodiscard]] JointImpulse<S> release_impulse(const BodyState<S>& a,
                                                  const BodyState<S>& b) const noexcept {
        if (!(last_.release > 0)) return {};
        return ductile::release_impulse(at_joint(a), at_joint(b), flow_in_world(),
                                        twist_in_world(a, b), last_.release);
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
    [[nodiscard]] const JointFrame<S>& frame_in_a() const noexcept { return in_a_; }
    [[nodiscard]] const JointFrame<S>& frame_in_b() const noexcept { return in_b_; }
    [[nodiscard]] const Rows& rows() const noexcept { return rows_; } ///< of the last prepare
    [[nodiscard]] const Step& last() const noexcept { return last_; }
    [[nodiscard]] bool broken() const noexcept { return joint_.state().broken; }
    [[nodiscard]] bool is_plastic(JointAxis axis) const noexcept { return plastic_[index(axis)]; }

    /// Where the joint was when last looked at, world axes [m].
    [[nodiscard]] const Vector3<S>& point() const noexcept { return joint_point_; }
    /// Axes of frame B when last looked at: columns, world.
    [[nodiscard]] const Matrix3<S>& axes_in_world() const noexcept { return frame_b_; }

    /// Velocities of the six rows if the bodies moved as these do, at the joint and along the axes
    /// of the last look [m/s | rad/s].
    [[nodiscard]] Vector6<S> velocities(const BodyState<S>& a,
                                        const BodyState<S>& b) const noexcept {
        return twist_in_b(a, b);
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

    [[nodiscard]] State state() const noexcept { return {joint_.state(), rest_}; }
    void restore(const State& state) noexcept {
        joint_.restore(state.joint);
        rest_ = state.rest;
    }

  private:
    static constexpr bool one_axis = !requires { Joint::dimension; };
    using JointVector = Eigen::Matrix<S, dimension, 1>;
    using JointMatrix = Eigen::Matrix<S, dimension, dimension>;

    /// Frames and arms from the bodies' present transforms.
    void locate(const BodyState<S>& a, const BodyState<S>& b) noexcept {
        frame_b_ = b.orientation * in_b_.axes;
        arm_a_ = a.orientation * in_a_.origin;
        joint_point_ = a.position + arm_a_;
        arm_b_ = joint_point_ - b.position;
        displacement_ = frame_b_.transpose() * (arm_b_ - b.orientation * in_b_.origin);
        orientation_ = frame_b_.transpose() * (a.orientation * in_a_.axes);
    }

    /// How far each axis is from rest: of a translation from q_p, of a rotation from R_p [m | rad].
    [[nodiscard]] Vector6<S> strain() const noexcept {
        Vector6<S> result;
        result << displacement_, rotation_vector<S>(orientation_ * rest_.transpose());
        const Vector6<S> offset_now = from_joint(offset());
        result.template head<3>() -= offset_now.template head<3>();
        return result;
    }

    /// Twist of A minus B at the joint, along the axes of frame B of the last look [m/s, rad/s].
    [[nodiscard]] Vector6<S> twist_in_b(const BodyState<S>& a,
                                        const BodyState<S>& b) const noexcept {
        Vector6<S> result;
        result << frame_b_.transpose() *
                      (a.velocity + a.spin.cross(arm_a_) - b.velocity - b.spin.cross(arm_b_)),
            frame_b_.transpose() * (a.spin - b.spin);
        return result;
    }

    [[nodiscard]] Vector6<S> in_world(const Vector6<S>& of_frame_b) const noexcept {
        Vector6<S> result;
        result << frame_b_ * of_frame_b.template head<3>(),
            frame_b_ * of_frame_b.template tail<3>();
        return result;
    }
    [[nodiscard]] Vector6<S> flow_in_world() const noexcept { return in_world(flow_); }
    [[nodiscard]] Vector6<S> twist_in_world(const BodyState<S>& a,
                                            const BodyState<S>& b) const noexcept {
        return in_world(twist_in_b(a, b));
    }

    [[nodiscard]] BodyAtJoint<S> at_joint(const BodyState<S>& body) const noexcept {
        return {body.inverse_mass, body.inverse_inertia, joint_point_ - body.position};
    }

    /// M; the identity where the bodies cannot tell (both without mass on some axis).
    [[nodiscard]] JointMatrix row_mass(const BodyState<S>& a,
                                       const BodyState<S>& b) const noexcept {
        const Matrix6<S> mass =
            inverse_mass_of_rows(a, b, joint_point_, frame_b_).partialPivLu().inverse();
        JointMatrix result;
        for (int i = 0; i < dimension; ++i) {
            for (int j = 0; j < dimension; ++j) {
                result(i, j) = mass(Eigen::Index(index(axes_[std::size_t(i)])),
                                    Eigen::Index(index(axes_[std::size_t(j)])));
            }
        }
        if (!result.allFinite()) result.setIdentity();
        return result;
    }

    void certify_rigid_rows(const BodyState<S>& a, const Vector6<S>& velocity) noexcept {
        const S moving = (a.velocity + a.spin.cross(arm_a_)).norm();
        const S turning = a.spin.norm();
        rigid_residual_ = 0;
        rigid_unsolved_ = false;
        for (std::size_t i = 0; i < rows_.size(); ++i) {
            if (plastic_[i]) continue;
            const S residual = std::abs(velocity[Eigen::Index(i)] - rows_[i].limits.bias);
            const S allowed =
                joint_.parameters().absolute_residual +
                joint_.parameters().relative_residual * (rows_[i].turns ? turning : moving);
            rigid_residual_ = std::max(rigid_residual_, residual);
            rigid_unsolved_ = rigid_unsolved_ || residual > allowed;
        }
    }

    /// Turns the rest orientation by what flowed about the plastic axes [rad].
    void turn_rest(const Vector3<S>& flow) noexcept {
        Vector3<S> turn = Vector3<S>::Zero();
        for (int i = 0; i < 3; ++i) {
            if (plastic_[std::size_t(3 + i)]) turn[i] = flow[i];
        }
        const S angle = turn.norm();
        if (!(angle > 0)) return;
        const Eigen::Quaternion<S> turned =
            Eigen::AngleAxis<S>(angle, turn / angle) * Eigen::Quaternion<S>(rest_);
        rest_ = turned.normalized().toRotationMatrix();
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
    JointFrame<S> in_a_, in_b_;
    Matrix3<S> rest_ = Matrix3<S>::Identity(); ///< R_p

    // as last looked at
    Matrix3<S> frame_b_ = Matrix3<S>::Identity(); ///< axes of frame B, world
    Vector3<S> joint_point_ = Vector3<S>::Zero(); ///< world [m]
    Vector3<S> arm_a_ = Vector3<S>::Zero();       ///< joint minus centre of mass, world [m]
    Vector3<S> arm_b_ = Vector3<S>::Zero();
    Vector3<S> displacement_ = Vector3<S>::Zero();    ///< d
    Matrix3<S> orientation_ = Matrix3<S>::Identity(); ///< R

    // between prepare and commit, and what the last step did
    Rows rows_{};
    JointVector offset_ = JointVector::Zero(); ///< q_p at the start of the step
    Vector6<S> force_ = Vector6<S>::Zero();    ///< axes of frame B [N | N m]
    Vector6<S> flow_ = Vector6<S>::Zero();     ///< direction of the last flow, axes of frame B
    Step last_{};
    S rigid_residual_ = 0;
    bool rigid_unsolved_ = false;
};

} // namespace ductile
