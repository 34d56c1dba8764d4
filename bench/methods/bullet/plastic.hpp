// SPDX-License-Identifier: MIT
//
// Ours in Bullet: hinge and slider, rigid-plastic or with the joint's elastic stiffness, and the
// joint of six axes, whose other five are a hundred times as strong.
#pragma once

#include <memory>
#include <optional>
#include <utility>

#include "engines/bullet_site.hpp"
#include "methods/holder.hpp"
#include "methods/plastic_joints.hpp"

namespace bench::bullet_methods {

/// Constraint: any of ours. Owns it and takes it out of the world again.
template <class Constraint>
class Plastic final : public Holder {
  public:
    template <class... Arguments>
    explicit Plastic(const BulletSite& site, Arguments&&... arguments)
        : world_(site.world),
          joint_(site.joint),
          constraint_(site.a, site.b, site.in_a, site.in_b, std::forward<Arguments>(arguments)...) {
        if (site.keeper != nullptr) {
            site.keeper->add(constraint_);
        } else {
            constraint_.add_to(world_);
        }
    }
    ~Plastic() override { constraint_.remove_from(world_); }

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
    btDiscreteDynamicsWorld& world_;
    JointSpec joint_;
    Constraint constraint_;
};

inline std::unique_ptr<Holder> plastic(const BulletSite& site, double stiffness) {
    const auto joint = one_axis(site.joint, stiffness);
    if (!site.turns()) {
        return std::make_unique<Plastic<ductile::bullet::PlasticSlider<>>>(site, joint);
    }
    return std::make_unique<Plastic<ductile::bullet::PlasticHinge<>>>(site, joint);
}
inline std::unique_ptr<Holder> rigid_plastic(const BulletSite& site) {
    return plastic(site, infinity);
}
inline std::unique_ptr<Holder> elastic_plastic(const BulletSite& site) {
    return plastic(site, site.joint.stiffness);
}
inline std::unique_ptr<Holder> plastic_joint(const BulletSite& site) {
    return std::make_unique<Plastic<ductile::bullet::PlasticJoint<SixAxes>>>(site,
                                                                             six_axes(site.joint));
}

} // namespace bench::bullet_methods
