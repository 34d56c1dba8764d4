// SPDX-License-Identifier: MIT
//
// The joint of a link: AnyLink's rows ruled by a plastic joint of the core (OneAxisJoint,
// CoupledJoint). any_link.hpp has frames, symbols and the course of a step.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

#include "ductile/joint/any_link.hpp"
#include "ductile/joint/work_share.hpp"
#include "ductile/surface/any_surface.hpp"
#include "ductile/vocabulary/on_demand.hpp"

namespace ductile {

/// Number of axes that a joint rules; asked of what is no joint, too, while a constructor's
/// arguments are sorted out.
template <class Joint>
inline constexpr std::size_t ruled_axes = [] {
    if constexpr (requires { Joint::dimension; }) {
        return std::size_t(Joint::dimension);
    } else {
        return std::size_t(1);
    }
}();

/// The surface of a joint for a solver that meets it by its closest point.
template <class Joint>
struct MetSurface {
    explicit MetSurface(const Joint& /*joint*/) noexcept {}
    [[nodiscard]] const AnySurface* get() const noexcept { return nullptr; }
};
template <class Joint>
requires requires(const Joint& joint) {
    AnySurfaceOf(joint.surface());
    requires !requires { joint.surface().semi_axes(); }; // else the solver knows the ellipsoid
}
struct MetSurface<Joint> {
    explicit MetSurface(const Joint& joint) : surface(joint.surface()) {}
    [[nodiscard]] const AnySurface* get() const noexcept { return &surface; }
    AnySurfaceOf<std::remove_cvref_t<decltype(std::declval<const Joint&>().surface())>> surface;
};

/// Copyable. Not thread-safe. After construction nothing but the first `keep` allocates or throws;
/// O(1).
template <class Joint>
class Link final : public AnyLink<typename Joint::Scalar> {
  public:
    using S = typename Joint::Scalar;
    using Axes = std::array<JointAxis, ruled_axes<Joint>>;
    using JointStep = typename BookedStep<Joint>::JointStep;

    /// Plain value: copy, compare, save and restore it.
    struct State {
        typename Joint::State joint;
        Matrix3<S> rest = Matrix3<S>::Identity(); ///< R_p
        SwingState<S> swing{};

        bool operator==(const State&) const = default;
    };

    /// `axes`: which axis of the link each row of the joint is, none twice; the others are rigid.
    /// @throws std::invalid_argument where an axis is given twice.
    Link(Joint joint, const Axes& axes, const JointFrame<S>& in_a, const JointFrame<S>& in_b)
        : AnyLink<S>(in_a, in_b, one_axis, all_rigid(joint),
                     {joint.parameters().absolute_residual, joint.parameters().relative_residual,
                      joint.parameters().allowed_step_error}),
          joint_(std::move(joint)),
          surface_(joint_),
          axes_(axes) {
        for (std::size_t i = 0; i < axes_.size(); ++i) {
            if (plastic_[index(axes_[i])]) {
                throw std::invalid_argument("Link.axes[" + std::to_string(i) +
                                            "] = " + std::string(to_string(axes_[i])) +
                                            ": must differ from the axes before it");
            }
            plastic_[index(axes_[i])] = true;
        }
        this->choose_rows();
    }

    [[nodiscard]] const Joint& joint() const noexcept { return joint_; }
    [[nodiscard]] State state() const noexcept { return {joint_.state(), pose_.rest(), swing_}; }
    void restore(const State& state) noexcept {
        joint_.restore(state.joint);
        pose_.set_rest(state.rest);
        swing_ = state.swing;
        this->forget_velocities();
        if constexpr (one_axis) {
            force_ = from_joint(JointVector::Constant(state.joint.force));
        } else {
            force_ = from_joint(state.joint.force);
        }
    }

    [[nodiscard]] std::span<const JointAxis> axes() const noexcept override { return axes_; }
    [[nodiscard]] const JointTotals<S>& totals() const noexcept override { return joint_.state(); }
    [[nodiscard]] const JointStep& last() const noexcept override { return booked_.step(); }
    void grant(S share) noexcept override { booked_.grant(joint_, share); }
    [[nodiscard]] std::optional<FractureEvent<S>> fracture() const noexcept override {
        return joint_.fracture();
    }
    [[nodiscard]] S utilisation() const noexcept override {
        if constexpr (one_axis) {
            return joint_.utilisation(this->force(axes_[0]));
        } else {
            return joint_.utilisation();
        }
    }
    [[nodiscard]] Vector6<S> section_stiffness() const noexcept override {
        Vector6<S> result = Vector6<S>::Constant(std::numeric_limits<S>::infinity());
        for (int k = 0; k < dimension; ++k) {
            S& of_axis = result[Eigen::Index(index(axes_[std::size_t(k)]))];
            if constexpr (one_axis) {
                of_axis = joint_.parameters().stiffness;
            } else {
                of_axis = std::min(joint_.parameters().stiffness[k],
                                   joint_.parameters().section_stiffness[k]);
            }
        }
        return result;
    }
    [[nodiscard]] Vector6<S> shared_strength() const noexcept override {
        if (joint_.state().broken) return Vector6<S>::Zero();
        if constexpr (requires { joint_.surface().semi_axes(); }) {
            return from_joint(joint_.surface().semi_axes() * joint_.reach());
        } else if constexpr (requires { surface_.surface; }) {
            return from_joint(surface_.surface.strength() * joint_.reach());
        }
        return Vector6<S>::Zero();
    }
    [[nodiscard]] const AnySurface* surface() const noexcept override { return surface_.get(); }

    bool meet_surface(S dt, bool passes) noexcept override {
        if constexpr (!one_axis) {
            if (joint_.state().broken) return false;
            const auto rows = joint_.meet_surface(dt, passes);
            if (!rows) return false;
            for (std::size_t k = 0; k < rows->size(); ++k) {
                RowLimits<S>& limits = limits_[index(axes_[k])];
                limits = (*rows)[k];
                limits.bias += back_[Eigen::Index(k)];
            }
            this->on_surface_ = true;
            return true;
        } else {
            return false;
        }
    }
    [[nodiscard]] S strength(JointAxis axis) const noexcept override {
        const auto i = Eigen::Index(index(axis));
        if (joint_.state().broken) return 0;
        if constexpr (one_axis) {
            return joint_.strength(force_[i] > 0 ? -1 : 1);
        } else {
            const S shared = shared_strength()[i];
            const RowLimits<S>& limits = limits_[index(axis)];
            return shared > 0 ? shared : std::max(limits.upper, -limits.lower);
        }
    }
    [[nodiscard]] bool snaps() const noexcept override { return joint_.snaps(); }
    [[nodiscard]] S least_travel() const noexcept override {
        return joint_.parameters().least_travel;
    }

  private:
    static constexpr bool one_axis = !requires { Joint::dimension; };
    static constexpr int dimension = int(ruled_axes<Joint>);
    using JointVector = Eigen::Matrix<S, dimension, 1>;
    using JointMatrix = Eigen::Matrix<S, dimension, dimension>;
    using Base = AnyLink<S>;
    using Base::force_;
    using Base::limits_;
    using Base::plastic_;
    using Base::pose_;
    using Base::swing_;

    [[nodiscard]] static bool all_rigid(const Joint& joint) noexcept {
        constexpr S rigid = std::numeric_limits<S>::infinity();
        if constexpr (one_axis) {
            return joint.parameters().stiffness == rigid;
        } else {
            bool all = true;
            for (int k = 0; k < dimension; ++k) {
                all = all && joint.parameters().stiffness[k] == rigid;
            }
            return all;
        }
    }
    [[nodiscard]] Vector6<S> offset() const noexcept override { return from_joint(joint_offset()); }
    void set_offset(const Vector6<S>& six) noexcept override {
        auto state = joint_.state();
        if constexpr (one_axis) {
            state.plastic_offset = to_joint(six)[0];
        } else {
            state.plastic_offset = to_joint(six);
        }
        joint_.restore(state);
    }
    [[nodiscard]] Vector6<S> flow() const noexcept override {
        if constexpr (one_axis) {
            return from_joint(JointVector::Constant(1));
        } else {
            return from_joint(last().direction);
        }
    }
    void take_mass(const Matrix6<S>& k) noexcept override { mass_ = mass_of_rows(k, axes_); }
    void prepare_joint(const typename Base::RowsAtStart& rows, S dt, bool ahead) noexcept override;
    void commit_joint(const Vector6<S>& velocity, const BodyState<S>& a, const BodyState<S>& b,
                      S dt) noexcept override;
    void leave_unbooked() noexcept override { booked_.leave_unbooked(); }
    void pause_joint() noexcept override {
        auto state = joint_.state();
        if constexpr (one_axis) {
            state.velocity = state.start_velocity = 0;
        } else {
            state.velocity.setZero();
            state.start_velocity.setZero();
        }
        state.flowing = false;
        joint_.restore(state);
        booked_.clear();
    }

    void keep_joint() override { kept_joint_.set({joint_.state(), booked_}); }
    void put_joint_back() noexcept override {
        joint_.restore(kept_joint_->state);
        booked_ = kept_joint_->booked;
    }
    /// Of the joint, what AnyLink::keep keeps.
    struct KeptJoint {
        typename Joint::State state;
        BookedStep<Joint> booked;
    };

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
    /// q of the joint's rows, from where they rested at the start of the step.
    [[nodiscard]] JointVector from_rest(const Vector6<S>& strain) const noexcept {
        JointVector result = to_joint(strain);
        for (int k = 0; k < dimension; ++k) result[k] += offset_[k];
        return result;
    }
    /// q_p of the joint's rows.
    [[nodiscard]] JointVector joint_offset() const noexcept {
        if constexpr (one_axis) {
            return JointVector::Constant(joint_.state().plastic_offset);
        } else {
            return joint_.state().plastic_offset;
        }
    }
    /// One entry of the strain, of a joint with one axis.
    [[nodiscard]] S strain_along(std::size_t axis) const noexcept {
        if (axis >= 3) return pose_.elastic_rotation()[Eigen::Index(axis - 3)];
        return pose_.displacement()[Eigen::Index(axis)] - joint_offset()[0];
    }

    Joint joint_;
    MetSurface<Joint> surface_;
    Axes axes_;
    JointMatrix mass_ = JointMatrix::Zero();   ///< M, where it is read
    JointVector offset_ = JointVector::Zero(); ///< q_p at the start of the step
    JointVector back_ = JointVector::Zero();   ///< of the bias: the rows' turning before the solve
    BookedStep<Joint> booked_;
    OnDemand<KeptJoint> kept_joint_;
};

template <class Joint>
void Link<Joint>::prepare_joint(const typename Base::RowsAtStart& rows, S dt, bool ahead) noexcept {
    offset_ = joint_offset();
    const RowTurning<S>& turning = rows.turning;
    const JointVector position = from_rest(rows.strain), before = from_rest(rows.before),
                      velocity = to_joint(rows.velocity), drift = to_joint(turning.drift());
    back_ = to_joint(turning.before(Vector6<S>::Zero()));
    const S speed = this->turning_speed(), damping = this->damping_;
    if constexpr (one_axis) {
        RowLimits<S>& limits = limits_[index(axes_[0])];
        limits = joint_.prepare({.position = position[0],
                                 .velocity = velocity[0],
                                 .mass = mass_(0, 0),
                                 .ahead = ahead,
                                 .before = before[0],
                                 .turning = speed,
                                 .drift = drift[0],
                                 .damping = damping},
                                dt);
        limits.bias += back_[0];
    } else {
        const auto limits = joint_.prepare({.position = position,
                                            .velocity = velocity,
                                            .mass = mass_,
                                            .ahead = ahead,
                                            .before = before,
                                            .turning = speed,
                                            .drift = drift,
                                            .damping = damping},
                                           dt);
        for (std::size_t k = 0; k < limits.size(); ++k) {
            limits_[index(axes_[k])] = limits[k];
            limits_[index(axes_[k])].bias += back_[Eigen::Index(k)];
        }
    }
}

template <class Joint>
void Link<Joint>::commit_joint(const Vector6<S>& velocity, const BodyState<S>& a,
                               const BodyState<S>& b, S dt) noexcept {
    if constexpr (one_axis) {
        const std::size_t axis = index(axes_[0]);
        const auto i = Eigen::Index(axis);
        booked_.commit(joint_, Reaction<S>{force_[i], velocity[i], strain_along(axis) + offset_[0]},
                       dt);
    } else {
        const typename Joint::Reaction reaction{to_joint(force_), to_joint(velocity),
                                                from_rest(this->strain()), this->on_surface_};
        booked_.commit(joint_, reaction, dt);
    }
    JointVector flowed = joint_offset();
    bool flows = false;
    for (int k = 0; k < dimension; ++k) {
        flowed[k] -= offset_[k];
        flows = flows || flowed[k] != 0;
    }
    if (flows) this->turn_rest(angular(from_joint(flowed)));
    // the same velocity, as the next step sees it
    if constexpr (one_axis) {
        joint_.carry(pose_.twist_along(index(axes_[0]), a, b));
    } else {
        joint_.carry(to_joint(pose_.twist(a, b)));
    }
}

} // namespace ductile
