// SPDX-License-Identifier: MIT
//
// The core's joints for a joint under test, the same for every engine. Axes lie as in PlasticHinge
// and PlasticSlider: what turns is torsion, what slides is axial.
#pragma once

#include "ductile/ductile.hpp"
#include "scenes/scene.hpp"

namespace bench {

using OneAxis = ductile::OneAxisJoint<ductile::Perfect<double>>;
using SixAxes = ductile::CoupledJoint<ductile::Ellipsoid<double, 6>, ductile::Perfect<double>>;

[[nodiscard]] inline OneAxis one_axis(const JointSpec& joint, double stiffness) {
    return OneAxis(ductile::Perfect<double>({.strength = joint.strength}),
                   ductile::TravelLimit<double>({.limit = joint.limit}), {.stiffness = stiffness});
}

/// The axis under test and five that are a hundred times as strong, on arms of a metre.
[[nodiscard]] inline SixAxes six_axes(const JointSpec& joint) {
    const bool turns = joint.motion == Motion::turns;
    const auto axis = turns ? ductile::JointAxis::torsion : ductile::JointAxis::axial;
    ductile::CoupledParameters<double, 6> rows;
    ductile::Vector6<double> capacity = ductile::Vector6<double>::Constant(100 * joint.strength);
    capacity[Eigen::Index(index(axis))] = joint.strength;
    rows.stiffness[Eigen::Index(index(axis))] = joint.stiffness;
    return SixAxes(ductile::Ellipsoid<double, 6>({.capacity = capacity}),
                   ductile::Perfect<double>({.strength = joint.strength}),
                   ductile::TravelLimit<double>({.limit = joint.limit}), rows);
}

} // namespace bench
