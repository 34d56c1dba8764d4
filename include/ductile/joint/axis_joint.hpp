// SPDX-License-Identifier: MIT
//
// A joint of one axis, whatever its law: what an adapter that rules one row of an engine's own
// joint, a motor for one, is compiled against once.
#pragma once

#include <limits>
#include <optional>
#include <utility>

#include "ductile/fracture/event.hpp"
#include "ductile/joint/joint_totals.hpp"
#include "ductile/joint/work_share.hpp"
#include "ductile/vocabulary/on_demand.hpp"
#include "ductile/vocabulary/row.hpp"

namespace ductile {

/// Not thread-safe. Nothing allocates or throws after construction. Meanings as in OneAxisJoint.
class AxisJoint {
  public:
    [[nodiscard]] virtual RowLimits<double> prepare(const Motion<double>& motion,
                                                    double dt) noexcept = 0;
    virtual const Step<double>& commit(const Reaction<double>& reaction, double dt) noexcept = 0;
    /// Books the step again, for a share of its flow (work_share.hpp).
    virtual void grant(double share) noexcept = 0;
    virtual void carry(double velocity) noexcept = 0;

    [[nodiscard]] virtual const JointTotals<double>& totals() const noexcept = 0;
    [[nodiscard]] virtual const Step<double>& last() const noexcept = 0; ///< the step last booked
    [[nodiscard]] virtual std::optional<FractureEvent<double>> fracture() const noexcept = 0;
    [[nodiscard]] virtual double strength(double direction) const noexcept = 0;
    [[nodiscard]] virtual double utilisation(double force) const noexcept = 0;
    [[nodiscard]] virtual double stiffness() const noexcept = 0; ///< infinite: rigid below yield
    /// What a row may be off by at `speed` [m/s | rad/s].
    [[nodiscard]] virtual double allowed_residual(double speed) const noexcept = 0;
    /// q_p, and velocity after the last step's solve.
    [[nodiscard]] virtual double plastic_offset() const noexcept = 0;
    [[nodiscard]] virtual double velocity() const noexcept = 0;
    /// Velocity at the start of the last step [m/s | rad/s].
    [[nodiscard]] virtual double start_velocity() const noexcept = 0;
    /// Plastic travel that nobody misses [m | rad].
    [[nodiscard]] virtual double least_travel() const noexcept = 0;
    /// Keeps all that a step changes, for one put_back or more.
    virtual void keep() = 0;
    virtual void put_back() noexcept = 0;
    /// The rest position is elsewhere, without any deformation.
    virtual void set_plastic_offset(double offset) noexcept = 0;
    /// The engine left the row out of a step: what the bodies did meanwhile is not to be taken for
    /// what the last booked step did.
    virtual void pause() noexcept = 0;

    [[nodiscard]] bool rigid() const noexcept {
        return stiffness() == std::numeric_limits<double>::infinity();
    }
    [[nodiscard]] bool broken() const noexcept { return totals().broken; }

  protected:
    AxisJoint() = default;
    AxisJoint(const AxisJoint&) = default;
    AxisJoint& operator=(const AxisJoint&) = default;
    ~AxisJoint() = default;
};

/// `Joint`: OneAxisJoint of any law and criterion.
template <class Joint>
class AxisJointOf final : public AxisJoint {
  public:
    explicit AxisJointOf(Joint joint) : joint_(std::move(joint)) {}

    [[nodiscard]] const Joint& joint() const noexcept { return joint_; }
    void restore(const typename Joint::State& state) noexcept { joint_.restore(state); }

    [[nodiscard]] RowLimits<double> prepare(const Motion<double>& motion,
                                            double dt) noexcept override {
        return joint_.prepare(motion, dt);
    }
    const Step<double>& commit(const Reaction<double>& reaction, double dt) noexcept override {
        return booked_.commit(joint_, reaction, dt);
    }
    void grant(double share) noexcept override { booked_.grant(joint_, share); }
    void carry(double velocity) noexcept override { joint_.carry(velocity); }

    [[nodiscard]] const JointTotals<double>& totals() const noexcept override {
        return joint_.state();
    }
    [[nodiscard]] const Step<double>& last() const noexcept override { return booked_.step(); }
    [[nodiscard]] std::optional<FractureEvent<double>> fracture() const noexcept override {
        return joint_.fracture();
    }
    [[nodiscard]] double strength(double direction) const noexcept override {
        return joint_.strength(direction);
    }
    [[nodiscard]] double utilisation(double force) const noexcept override {
        return joint_.utilisation(force);
    }
    [[nodiscard]] double stiffness() const noexcept override {
        return joint_.parameters().stiffness;
    }
    [[nodiscard]] double allowed_residual(double speed) const noexcept override {
        return joint_.parameters().absolute_residual +
               joint_.parameters().relative_residual * speed;
    }
    [[nodiscard]] double plastic_offset() const noexcept override {
        return joint_.state().plastic_offset;
    }
    [[nodiscard]] double velocity() const noexcept override { return joint_.state().velocity; }
    [[nodiscard]] double start_velocity() const noexcept override {
        return joint_.state().start_velocity;
    }
    [[nodiscard]] double least_travel() const noexcept override {
        return joint_.parameters().least_travel;
    }
    void keep() override { kept_.set({joint_.state(), booked_}); }
    void put_back() noexcept override {
        joint_.restore(kept_->state);
        booked_ = kept_->booked;
    }
    void set_plastic_offset(double offset) noexcept override {
        auto state = joint_.state();
        state.plastic_offset = offset;
        joint_.restore(state);
    }
    void pause() noexcept override {
        auto state = joint_.state();
        state.start_velocity = state.velocity = 0;
        state.flowing = false;
        joint_.restore(state);
        booked_.clear();
    }

  private:
    struct Kept {
        typename Joint::State state;
        BookedStep<Joint> booked;
    };
    Joint joint_;
    BookedStep<Joint> booked_;
    OnDemand<Kept> kept_;
};

} // namespace ductile
