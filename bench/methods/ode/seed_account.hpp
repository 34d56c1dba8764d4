// SPDX-License-Identifier: MIT
//
// ODE's motor with the seed's account.
#pragma once

#include "methods/ode/engine_joints.hpp"
#include "methods/seed_account.hpp"

namespace bench::ode_methods {

class Accounted final : public Motor {
  public:
    explicit Accounted(const OdeSite& site)
        : Motor(site),
          a_(site.a),
          b_(site.b),
          travel_(site.joint, state_of(a_), state_of(b_)),
          account_(site.joint) {}

    void after_step(double /*dt*/) override {
        account_.book(travel_.update(state_of(a_), state_of(b_)));
        if (account_.broken()) disable();
    }
    [[nodiscard]] std::optional<double> absorbed() override { return account_.absorbed(); }

  private:
    dBodyID a_, b_;
    Travel travel_;
    SeedAccount account_;
};

} // namespace bench::ode_methods
