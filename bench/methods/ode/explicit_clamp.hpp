// SPDX-License-Identifier: MIT
//
// The tutorial's explicit spring over ODE's free hinge or slider.
#pragma once

#include "methods/explicit_clamp.hpp"
#include "methods/ode/engine_joints.hpp"

namespace bench::ode_methods {

class Clamped final : public EngineJoint {
  public:
    explicit Clamped(const OdeSite& site)
        : EngineJoint(site),
          a_(site.a),
          b_(site.b),
          joint_(site.joint),
          travel_(joint_, state_of(a_), state_of(b_)),
          rule_(joint_, site.effective_mass) {}

    void before_step(double dt) override {
        if (rule_.broken()) return;
        const BodyState a = state_of(a_), b = state_of(b_);
        const Vector force = rule_.force(travel_.update(a, b), dt) * (b.rotation * joint_.axis);
        if (rule_.broken()) disable();
        add(a_, force);
        if (b_ != nullptr) add(b_, -force);
    }
    [[nodiscard]] std::optional<double> absorbed() override { return rule_.absorbed(); }

  private:
    void add(dBodyID body, const Vector& f) const {
        const auto add = joint_.motion == Motion::turns ? dBodyAddTorque : dBodyAddForce;
        add(body, dReal(f.x()), dReal(f.y()), dReal(f.z()));
    }

    dBodyID a_, b_;
    JointSpec joint_;
    Travel travel_;
    ExplicitClamp rule_;
};

} // namespace bench::ode_methods
