// SPDX-License-Identifier: MIT
//
// Ours in ODE: hinge and slider, rigid-plastic or with the joint's elastic stiffness, and the joint
// of six axes, whose other five are a hundred times as strong.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "engines/ode_site.hpp"
#include "methods/holder.hpp"
#include "methods/plastic_joints.hpp"

namespace bench::ode_methods {

/// Constraint: any of ours. Owns it and takes it out of the world again.
template <class Constraint>
class Plastic final : public Holder {
  public:
    template <class... Arguments>
    explicit Plastic(const OdeSite& site, Arguments&&... arguments)
        : stepper_(site.stepper),
          joint_(site.joint),
          constraint_(site.world, site.a, site.b, std::forward<Arguments>(arguments)...) {
        constraint_.add_to(stepper_);
    }
    ~Plastic() override { constraint_.remove_from(stepper_); }

    [[nodiscard]] std::optional<double> absorbed() override {
        return constraint_.absorbed_energy();
    }
    [[nodiscard]] std::optional<double> peak() override {
        return joint_.strength / joint_.stiffness + constraint_.joint().state().plastic_travel;
    }
    [[nodiscard]] bool broken() override { return constraint_.broken(); }
    [[nodiscard]] bool unreliable() override {
        const auto report = constraint_.report();
        return report.outcome == ductile::Outcome::unreliable || report.coarse;
    }

  private:
    ductile::ode::World& stepper_;
    JointSpec joint_;
    Constraint constraint_;
};

inline std::unique_ptr<Holder> plastic(const OdeSite& site, double stiffness) {
    const auto joint = one_axis(site.joint, stiffness);
    if (!site.turns()) {
        return std::make_unique<Plastic<ductile::ode::PlasticSlider<>>>(site, site.joint.axis,
                                                                        joint);
    }
    return std::make_unique<Plastic<ductile::ode::PlasticHinge<>>>(
        site, ductile::ode::HingeFrame{.anchor = site.joint.anchor, .axis = site.joint.axis},
        joint);
}
inline std::unique_ptr<Holder> rigid_plastic(const OdeSite& site) {
    return plastic(site, infinity);
}
inline std::unique_ptr<Holder> elastic_plastic(const OdeSite& site) {
    return plastic(site, site.joint.stiffness);
}
inline std::unique_ptr<Holder> plastic_joint(const OdeSite& site) {
    // z to the axis by the shortest turn
    const Vector z = Vector::UnitZ(), axis = site.joint.axis.normalized();
    const Vector across = axis.z() > -1 ? z.cross(axis).stableNormalized() : Vector::UnitX();
    const double angle = std::atan2(z.cross(axis).norm(), axis.z());
    const ductile::JointFrame<double> frame{
        .origin = site.joint.anchor,
        .axes = Eigen::AngleAxisd(angle, across).toRotationMatrix()};
    return std::make_unique<Plastic<ductile::ode::PlasticJoint<SixAxes>>>(site, frame,
                                                                          six_axes(site.joint));
}

} // namespace bench::ode_methods
