// SPDX-License-Identifier: MIT
//
// ODE's own joints as a user would set them: hinge and slider as a spring, or with a motor. ODE's
// joints do not break by themselves.
#pragma once

#include "engines/ode_site.hpp"
#include "methods/holder.hpp"

namespace bench::ode_methods {

/// One joint of ODE's, in the world as long as this lives.
class EngineJoint : public Holder {
  public:
    explicit EngineJoint(const OdeSite& site)
        : turns_(site.turns()),
          joint_(free_joint(site.world, site.a, site.b, site.joint.motion, site.joint.anchor,
                            site.joint.axis)) {}
    ~EngineJoint() override { dJointDestroy(joint_); }

    [[nodiscard]] bool broken() override { return dJointIsEnabled(joint_) == 0; }

  protected:
    void set(int parameter, double value) {
        if (turns_) {
            dJointSetHingeParam(joint_, parameter, dReal(value));
        } else {
            dJointSetSliderParam(joint_, parameter, dReal(value));
        }
    }
    void disable() { dJointDisable(joint_); }

  private:
    bool turns_;
    dJointID joint_;
};

class Rigid final : public Holder {
  public:
    explicit Rigid(const OdeSite& site) : joint_(dJointCreateFixed(site.world, nullptr)) {
        dJointAttach(joint_, site.a, site.b);
        dJointSetFixed(joint_);
    }
    ~Rigid() override { dJointDestroy(joint_); }

  private:
    dJointID joint_;
};

/// A stop with lo = hi and, by ODE's manual, ERP = dt k/(dt k + c) and CFM = 1/(dt k + c), with no
/// damping, c = 0.
class Spring final : public EngineJoint {
  public:
    explicit Spring(const OdeSite& site) : EngineJoint(site), stiffness_(site.spring_stiffness()) {
        set(dParamLoStop, 0);
        set(dParamHiStop, 0);
        set(dParamStopERP, 1);
    }
    void before_step(double dt) override { set(dParamStopCFM, 1 / (dt * stiffness_)); }

  private:
    double stiffness_;
};

class Motor : public EngineJoint {
  public:
    explicit Motor(const OdeSite& site) : EngineJoint(site) {
        set(dParamVel, 0);
        set(dParamFMax, site.joint.strength);
    }
};

} // namespace bench::ode_methods
