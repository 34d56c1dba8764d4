// SPDX-License-Identifier: MIT
//
// What of the core is compiled once (DUCTILE_COMPILED).
#include <ductile/joint/row_sweep.hpp>
#include <ductile/joint/usual_joints.hpp>
#include <ductile/world/energy_meter.hpp>
#include <ductile/world/energy_meter.ipp>

namespace ductile {

template class Ellipsoid<double, 6>;
template class OneAxisJoint<Perfect<double>, TravelLimit<double>>;
template class CoupledJoint<Ellipsoid<double, 6>, Perfect<double>, TravelLimit<double>>;
template class AnyLink<double>;
template class Link<UsualAxisJoint>;
template class Link<UsualSixAxisJoint>;
template class AxisJointOf<UsualAxisJoint>;
template class RowSweep<double>;

} // namespace ductile
