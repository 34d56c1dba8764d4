// SPDX-License-Identifier: MIT
//
// Bullet's motor with the seed's account.
#pragma once

#include "methods/bullet/engine_joints.hpp"
#include "methods/seed_account.hpp"

namespace bench::bullet_methods {

/// Motor: HingeMotor or SliderMotor.
template <class Motor>
class Accounted final : public Motor {
  public:
    explicit Accounted(const BulletSite& site)
        : Motor(site),
          a_(site.a),
          b_(site.b),
          travel_(site.joint, state_of(a_), state_of(b_)),
          account_(site.joint) {}

    void after_step(double /*dt*/) override {
        account_.book(travel_.update(state_of(a_), state_of(b_)));
        if (account_.broken()) Motor::constraint().setEnabled(false);
    }
    [[nodiscard]] std::optional<double> absorbed() override { return account_.absorbed(); }

  private:
    btRigidBody &a_, &b_;
    Travel travel_;
    SeedAccount account_;
};

} // namespace bench::bullet_methods
