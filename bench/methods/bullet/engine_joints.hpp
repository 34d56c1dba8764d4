// SPDX-License-Identifier: MIT
//
// Bullet's own joints as a user would set them: fixed, fixed with a breaking impulse, two kinds of
// spring, hinge and slider with a motor.
#pragma once

#include <memory>
#include <utility>

#include "engines/bullet_site.hpp"
#include "methods/holder.hpp"

namespace bench::bullet_methods {

/// One constraint of Bullet's, in the world as long as this lives.
template <class Constraint>
class EngineJoint : public Holder {
  public:
    EngineJoint(btDiscreteDynamicsWorld& world, std::unique_ptr<Constraint> constraint)
        : world_(world), constraint_(std::move(constraint)) {
        world_.addConstraint(constraint_.get(), true);
    }
    ~EngineJoint() override { world_.removeConstraint(constraint_.get()); }

    [[nodiscard]] bool broken() override { return !constraint_->isEnabled(); }
    [[nodiscard]] Constraint& constraint() { return *constraint_; }

  private:
    btDiscreteDynamicsWorld& world_;
    std::unique_ptr<Constraint> constraint_;
};

/// Index of the axis along which the joint moves, of six: translation 0-2, rotation 3-5.
[[nodiscard]] inline int free_axis(const BulletSite& site) { return site.turns() ? 5 : 2; }

class Rigid final : public EngineJoint<btFixedConstraint> {
  public:
    explicit Rigid(const BulletSite& site)
        : EngineJoint(site.world,
                      std::make_unique<btFixedConstraint>(site.a, site.b, site.in_a, site.in_b)) {}
};

class ZeroLimits final : public EngineJoint<btGeneric6DofConstraint> {
  public:
    explicit ZeroLimits(const BulletSite& site)
        : EngineJoint(site.world, std::make_unique<btGeneric6DofConstraint>(
                                      site.a, site.b, site.in_a, site.in_b, true)),
          strength_(site.joint.strength) {
        for (int axis = 0; axis < 6; ++axis) constraint().setLimit(axis, 0, 0);
    }
    void before_step(double dt) override {
        constraint().setBreakingImpulseThreshold(btScalar(strength_ * dt));
    }

  private:
    double strength_;
};

class Spring final : public EngineJoint<btGeneric6DofSpringConstraint> {
  public:
    explicit Spring(const BulletSite& site)
        : EngineJoint(site.world, std::make_unique<btGeneric6DofSpringConstraint>(
                                      site.a, site.b, site.in_a, site.in_b, true)) {
        const int free = free_axis(site);
        for (int axis = 0; axis < 6; ++axis) constraint().setLimit(axis, axis == free ? 1 : 0, 0);
        constraint().enableSpring(free, true);
        constraint().setStiffness(free, btScalar(site.spring_stiffness()));
        constraint().setDamping(free, 1); // Bullet: 1 is no damping
        constraint().setEquilibriumPoint();
    }
};

class Spring2 final : public EngineJoint<btGeneric6DofSpring2Constraint> {
  public:
    Spring2(const BulletSite& site, bool limited)
        : EngineJoint(site.world, std::make_unique<btGeneric6DofSpring2Constraint>(
                                      site.a, site.b, site.in_a, site.in_b)) {
        const int free = free_axis(site);
        for (int axis = 0; axis < 6; ++axis) constraint().setLimit(axis, axis == free ? 1 : 0, 0);
        constraint().enableSpring(free, true);
        constraint().setStiffness(free, btScalar(site.spring_stiffness()), limited);
        constraint().setDamping(free, 0, limited);
        constraint().setEquilibriumPoint();
    }
};

class HingeMotor : public EngineJoint<btHingeConstraint> {
  public:
    explicit HingeMotor(const BulletSite& site)
        : EngineJoint(site.world, std::make_unique<btHingeConstraint>(site.a, site.b, site.in_a,
                                                                      site.in_b, true)),
          moment_(site.joint.strength) {}
    /// btHingeConstraint takes an impulse.
    void before_step(double dt) override {
        constraint().enableAngularMotor(true, 0, btScalar(moment_ * dt));
    }

  private:
    double moment_;
};

class SliderMotor : public EngineJoint<btSliderConstraint> {
  public:
    explicit SliderMotor(const BulletSite& site)
        : EngineJoint(site.world, free_slider(site.a, site.b, site.in_a, site.in_b)) {
        constraint().setPoweredLinMotor(true);
        constraint().setTargetLinMotorVelocity(0);
        constraint().setMaxLinMotorForce(btScalar(site.joint.strength));
    }
};

} // namespace bench::bullet_methods
