// SPDX-License-Identifier: MIT
//
// The plastic joints of a Charpy specimen in any engine: their laws from the scenario, and what all of
// them together report.
//
//   plastic-hinge      bending yields at M_p, the other five axes are rigid (the source's 2.8)
//   elastic-plastic    six axes, each a spring up to its own capacity, then flowing at it; no axis
//                      knows of the others (2.9)
//   elastic-plastic-2  six axes, springs inside one surface that bending, torsion, shear and axial
//                      force share (2.10, and what it leaves for later)
// Stiffness and capacity are those of the section over the length between the centres of two parts.
// Where the step does not resolve a spring its row is implicit: the source's switch that leaves the
// elastic part out (2.9) and its softening to four steps a period (2.10) are not needed.
#pragma once

#include <algorithm>
#include <memory>
#include <variant>
#include <vector>

#include "ductile/ductile.hpp"
#include "scenario.hpp"

namespace charpy {

using HingeLaw = ductile::OneAxisJoint<ductile::Perfect<double>>;
using AxesLaw = ductile::CoupledJoint<ductile::IndependentAxes<double, 6>, ductile::Perfect<double>>;
using SurfaceLaw = ductile::SectionJoint<double>;

[[nodiscard]] inline HingeLaw hinge_law(const Scenario& s, bool notched) {
    return HingeLaw(
        ductile::Perfect<double>({.strength = notched ? s.notched_moment() : s.full_moment()}),
        ductile::TravelLimit<double>({.limit = s.max_plastic_rotation}));
}

/// Section axes: x along the specimen's width, y against the blow, z along the specimen.
[[nodiscard]] inline SurfaceLaw surface_law(const Scenario& s, bool notched) {
    const ductile::SectionJointParameters<double> parameters{
        .length = s.joint_length(), .largest_bending = s.max_plastic_rotation, .elastic = true};
    return notched ? ductile::section_joint(s.notched_section(), s.steel(), parameters)
                   : ductile::section_joint(s.full_section(), s.steel(), parameters);
}

[[nodiscard]] inline AxesLaw axes_law(const Scenario& s, bool notched) {
    const SurfaceLaw of = surface_law(s, notched);
    return AxesLaw(ductile::IndependentAxes<double, 6>({.capacity = of.surface().capacity()}),
                   of.law(), of.criterion(), of.parameters());
}

/// `Hinge` and `Joint`: an engine's adapter for one plastic axis and for six.
template <template <class> class Hinge, template <class> class Joint>
class SpecimenJoints {
    using Any = std::variant<std::unique_ptr<Hinge<HingeLaw>>, std::unique_ptr<Joint<AxesLaw>>,
                             std::unique_ptr<Joint<SurfaceLaw>>>;

  public:
    template <class T>
    T& add(std::unique_ptr<T> joint) {
        T& added = *joint;
        joints_.emplace_back(std::move(joint));
        return added;
    }
    void clear() { joints_.clear(); }
    [[nodiscard]] bool empty() const { return joints_.empty(); }

    template <class Visit>
    void for_each(const Visit& visit) const {
        for (const Any& any : joints_) {
            std::visit([&visit](const auto& joint) { visit(*joint); }, any);
        }
    }

    /// Dissipated by flow [J].
    [[nodiscard]] double absorbed() const {
        return sum([](auto& joint) { return joint.absorbed_energy(); });
    }
    /// Elastic [J].
    [[nodiscard]] double stored() const {
        return sum([](auto& joint) { return joint.stored_energy(); });
    }
    /// Plastic rotation, of six axes the equivalent one [rad].
    [[nodiscard]] double travel() const {
        return sum([](auto& joint) { return joint.plastic_travel(); });
    }
    [[nodiscard]] bool broken() const {
        return sum([](auto& joint) { return joint.broken() ? 1.0 : 0.0; }) > 0;
    }
    /// True where a joint says that the last step's solve should not be believed.
    [[nodiscard]] bool unreliable() const {
        return sum([](auto& joint) {
                   return joint.outcome() == ductile::Outcome::unreliable ? 1.0 : 0.0;
               }) > 0;
    }

  private:
    template <class Figure>
    [[nodiscard]] double sum(const Figure& figure) const {
        double total = 0;
        for_each([&](auto& joint) { total += figure(joint); });
        return total;
    }

    std::vector<Any> joints_;
};

} // namespace charpy
