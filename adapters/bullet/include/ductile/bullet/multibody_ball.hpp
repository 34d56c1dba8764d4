// SPDX-License-Identifier: MIT
//
// A spherical link of a btMultiBody whose two bending moments and torsion share one yield surface.
//
//   using Ball = ductile::bullet::MultiBodyPlasticBall<>;
//   Ball ball(body, link, ductile::CoupledJoint(ductile::Ellipsoid<double, 3>({.capacity =
//   capacity}),
//                                               ductile::Perfect<double>({.strength = 64})));
//   ball.add_to(world);
//
// Axes, moments and velocities are those of Bullet's spherical joint: the axes of the link's own
// frame, which turn with it. Rotation is the sum of increments of the rotation vector
// (joint/rotation.hpp); it may turn many times, at less than π/4 a step, beyond which the joint is
// unreliable. See multibody_constraint.hpp for signs, committing, the break and Bullet's traps,
// multibody_hinge.hpp for elastic rows.
#pragma once

#include <algorithm>
#include <span>
#include <utility>

#include "ductile/bullet/multibody_constraint.hpp"
#include "ductile/joint/coupled_joint.hpp"
#include "ductile/joint/rotation.hpp"
#include "ductile/joint/work_share.hpp"
#include "ductile/law/perfect.hpp"
#include "ductile/numeric/lu.hpp"
#include "ductile/surface/ellipsoid.hpp"
#include "ductile/vocabulary/angle.hpp"

namespace ductile::bullet {

template <class Joint = CoupledJoint<Ellipsoid<double, 3>, Perfect<double>>>
class MultiBodyPlasticBall final : public MultiBodyPlasticConstraint {
    using Base = MultiBodyPlasticConstraint;
    static_assert(Joint::dimension == 3, "a ball has three plastic axes");

  public:
    /// All that a ball remembers. Plain value: copy, compare, save and restore it.
    struct State {
        typename Joint::State joint;
        RotationTracker<double> rotation;

        bool operator==(const State&) const = default;
    };

    /// `body` has all its links; where the link is now is the ball's rest position, rotation 0.
    /// @throws std::invalid_argument where the link is not spherical.
    MultiBodyPlasticBall(btMultiBody& body, int link, Joint joint)
        : Base(body, link, 3, btMultibodyLink::eSpherical, "a spherical link of the multibody"),
          joint_(std::move(joint)) {
        tracker_.last = orientation();
    }

    /// Sum of the rotations of the link relative to its parent, link axes [rad].
    [[nodiscard]] const Vector3<double>& rotation() const noexcept { return tracker_.total; }
    /// Equivalent plastic rotation p, work-conjugate, never decreases [rad of the law].
    [[nodiscard]] double plastic_rotation() const noexcept { return joint_.state().plastic_travel; }
    /// Moment on the link in the last tick, link axes [N m].
    [[nodiscard]] const Vector3<double>& moment() const noexcept { return moment_; }
    /// Energy dissipated by plastic flow [J].
    [[nodiscard]] double absorbed_energy() const noexcept override {
        return joint_.state().plastic_work;
    }
    [[nodiscard]] bool broken() const noexcept override { return joint_.state().broken; }
    /// Unreliable where the solver left a row unsolved, or out.
    [[nodiscard]] Outcome outcome() const noexcept {
        const bool believed = !left_out() && !(unseen_turn_ > 0);
        return believed || broken() ? last().outcome : Outcome::unreliable;
    }
    /// Certificate: largest violation of a row in the last tick, and so far [rad/s].
    [[nodiscard]] double residual() const noexcept { return last().residual; }
    [[nodiscard]] double residual_max() const noexcept { return joint_.state().residual_max; }

    [[nodiscard]] const Joint& joint() const noexcept { return joint_; }
    [[nodiscard]] State state() const noexcept { return {joint_.state(), tracker_}; }
    [[nodiscard]] JointReport<double> report() const noexcept override {
        auto now = Base::report_of(joint_, last(), outcome());
        now.unseen_turn = unseen_turn_;
        return now;
    }
    /// For a joint re-created from a saved state.
    void restore(const State& state) noexcept {
        joint_.restore(state.joint);
        tracker_ = state.rotation;
    }

  private:
    using typename Base::Tick;
    using typename Base::Values;

    /// Turns the link's axes to the parent's, relative to the link's zero.
    [[nodiscard]] Matrix3<double> orientation() const noexcept {
        const btScalar* q = body().getJointPosMultiDof(link());
        return ductile::detail::to_matrix(ductile::detail::UnitQuaternion<double>{
            double(q[3]), {double(q[0]), double(q[1]), double(q[2])}});
    }

    void prepare(const Tick& tick, std::span<RowLimits<double>> limits) override {
        // somebody may have turned it between the ticks
        const auto rows = joint_.prepare({.position = tracker_.follow(orientation()),
                                          .velocity = tick.velocity,
                                          .mass = numeric::inverse(tick.response)},
                                         tick.dt);
        std::copy(rows.begin(), rows.end(), limits.begin());
    }
    void commit(const Values& force, const Values& velocity, double dt) override {
        moment_ = force;
        const Vector3<double> before = tracker_.total, due = scaled(dt, velocity);
        const Vector3<double> missed =
            difference(difference(tracker_.follow(orientation()), before), due);
        unseen_turn_ = turned_otherwise(norm(due), norm(due) + norm(missed)) ? norm(due) : 0;
        booked_.commit(joint_, typename Joint::Reaction{force, velocity, tracker_.total}, dt);
    }
    [[nodiscard]] const typename BookedStep<Joint>::JointStep& last() const noexcept override {
        return booked_.step();
    }
    void let_go() override {
        moment_ = {0, 0, 0};
        if (last().release > 0) hand_back(last().release, last().direction);
    }
    void grant(double share) noexcept override { booked_.grant(joint_, share); }

    Joint joint_;
    RotationTracker<double> tracker_;
    BookedStep<Joint> booked_;
    double unseen_turn_ = 0; ///< as JointReport's
    Vector3<double> moment_ = Vector3<double>::Zero();
};

} // namespace ductile::bullet
