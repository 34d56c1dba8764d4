// SPDX-License-Identifier: MIT
//
// A revolute link of a btMultiBody that holds below its plastic moment, rigidly or elastically,
// turns at it, keeps the turn and breaks.
//
//   ductile::bullet::MultiBodyPlasticHinge hinge(
//       body, link, ductile::OneAxisJoint(ductile::Perfect<double>({.strength = 64})));
//   hinge.add_to(world);
//
// Below the plastic moment the joint is one row, not a fixed joint: see multibody_constraint.hpp
// for signs, committing, the break and Bullet's traps. Angles are Bullet's joint positions, which
// are not wrapped. An elastic row feels the mass 1/(J M⁻¹ Jᵀ) of its degree of freedom, the other
// joints of the multibody being free. Where the step does not resolve it, the row is soft, which
// the iterative solver honours and Bullet's direct one does not: use MultiBodyMlcpSolver.
#pragma once

#include <span>
#include <utility>

#include "ductile/bullet/multibody_constraint.hpp"
#include "ductile/joint/one_axis_joint.hpp"
#include "ductile/joint/work_share.hpp"
#include "ductile/law/perfect.hpp"

namespace ductile::bullet {

template <class Joint = OneAxisJoint<Perfect<double>>>
class MultiBodyPlasticHinge final : public MultiBodyPlasticConstraint {
    using Base = MultiBodyPlasticConstraint;

  public:
    /// `body` has all its links; where the link is now is the hinge's rest position.
    /// @throws std::invalid_argument where the link is not revolute.
    MultiBodyPlasticHinge(btMultiBody& body, int link, Joint joint)
        : Base(body, link, 1, btMultibodyLink::eRevolute, "a revolute link of the multibody"),
          joint_(std::move(joint)) {
        auto state = joint_.state();
        state.plastic_offset = rotation();
        joint_.restore(state);
    }

    /// Angle of the link relative to its parent, not wrapped [rad].
    [[nodiscard]] double rotation() const noexcept { return double(body().getJointPos(link())); }
    /// Accumulated plastic rotation p, work-conjugate, never decreases [rad].
    [[nodiscard]] double plastic_rotation() const noexcept { return joint_.state().plastic_travel; }
    /// Moment on the link about its axis in the last tick [N m].
    [[nodiscard]] double moment() const noexcept { return moment_; }
    /// Energy dissipated by plastic flow [J].
    [[nodiscard]] double absorbed_energy() const noexcept override {
        return joint_.state().plastic_work;
    }
    [[nodiscard]] bool broken() const noexcept override { return joint_.state().broken; }
    /// Unreliable where the solver left the row unsolved, or out.
    [[nodiscard]] Outcome outcome() const noexcept {
        return left_out() && !broken() ? Outcome::unreliable : last().outcome;
    }
    /// Certificate: violation of the row in the last tick, and the largest so far [rad/s].
    [[nodiscard]] double residual() const noexcept { return last().residual; }
    [[nodiscard]] double residual_max() const noexcept { return joint_.state().residual_max; }

    [[nodiscard]] const Joint& joint() const noexcept { return joint_; }
    [[nodiscard]] JointReport<double> report() const noexcept override {
        return Base::report_of(joint_, last(), outcome());
    }
    /// For a joint re-created from what was saved as joint().state().
    void restore(const typename Joint::State& state) noexcept { joint_.restore(state); }

  private:
    using typename Base::Tick;
    using typename Base::Values;

    void prepare(const Tick& tick, std::span<RowLimits<double>> limits) override {
        limits[0] = joint_.prepare(
            {.position = rotation(), .velocity = tick.velocity[0], .mass = 1 / tick.response(0, 0)},
            tick.dt);
    }
    void commit(const Values& force, const Values& velocity, double dt) override {
        moment_ = force[0];
        booked_.commit(joint_, typename Joint::Reaction{moment_, velocity[0], rotation()}, dt);
    }
    [[nodiscard]] const typename BookedStep<Joint>::JointStep& last() const noexcept override {
        return booked_.step();
    }
    void let_go() override {
        moment_ = 0;
        if (last().release > 0) hand_back(last().release, {1, 0, 0});
    }
    void grant(double share) noexcept override { booked_.grant(joint_, share); }

    Joint joint_;
    BookedStep<Joint> booked_;
    double moment_ = 0;
};

} // namespace ductile::bullet
