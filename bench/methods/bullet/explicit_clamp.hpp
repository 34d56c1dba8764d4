// SPDX-License-Identifier: MIT
//
// The tutorial's explicit spring over Bullet's free hinge or slider.
#pragma once

#include "methods/bullet/engine_joints.hpp"
#include "methods/explicit_clamp.hpp"

namespace bench::bullet_methods {

/// Joint: btHingeConstraint or btSliderConstraint, free along its axis.
template <class Joint>
class Clamped final : public EngineJoint<Joint> {
  public:
    Clamped(const BulletSite& site, std::unique_ptr<Joint> joint)
        : EngineJoint<Joint>(site.world, std::move(joint)),
          a_(site.a),
          b_(site.b),
          joint_(site.joint),
          travel_(joint_, state_of(a_), state_of(b_)),
          rule_(joint_, site.effective_mass) {}

    void before_step(double dt) override {
        if (rule_.broken()) return;
        const BodyState a = state_of(a_), b = state_of(b_);
        const Vector force = rule_.force(travel_.update(a, b), dt) * (b.rotation * joint_.axis);
        if (rule_.broken()) this->constraint().setEnabled(false);
        const btVector3 on_a = ductile::bullet::to_bullet(force);
        if (joint_.motion == Motion::turns) {
            a_.applyTorque(on_a);
            b_.applyTorque(-on_a);
        } else {
            a_.applyCentralForce(on_a);
            b_.applyCentralForce(-on_a);
        }
    }
    [[nodiscard]] std::optional<double> absorbed() override { return rule_.absorbed(); }

  private:
    btRigidBody &a_, &b_;
    JointSpec joint_;
    Travel travel_;
    ExplicitClamp rule_;
};

} // namespace bench::bullet_methods
