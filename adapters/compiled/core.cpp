// SPDX-License-Identifier: MIT
//
// What of the core is compiled once (DUCTILE_COMPILED).
#include <ductile/frame/frame_control.ipp>
#include <ductile/frame/frame_report.ipp>
#include <ductile/joint/usual_joints.hpp>
#include <ductile/numeric/block_ldlt.hpp>
#include <ductile/numeric/block_ldlt.ipp>
#include <ductile/solve/forest_solver.ipp>
#include <ductile/solve/interior_point.ipp>
#include <ductile/solve/island.ipp>
#include <ductile/solve/island_solver.ipp>
#include <ductile/solve/island_system.ipp>
#include <ductile/structure/built_structure.ipp>
#include <ductile/structure/structure_course.ipp>
#include <ductile/structure/structure_model.ipp>
#include <ductile/structure/structure_plan.ipp>
#include <ductile/world/energy_meter.hpp>
#include <ductile/world/energy_meter.ipp>
#include <ductile/world/island_joint.ipp>
#include <ductile/world/kept_joint.ipp>
#include <ductile/world/stepped_world.ipp>
#include <ductile/world/supervisor.ipp>
#include <ductile/world/waiting_joints.ipp>

namespace ductile {

template class Ellipsoid<double, 6>;
template class OneAxisJoint<Perfect<double>, TravelLimit<double>>;
template class CoupledJoint<Ellipsoid<double, 6>, Perfect<double>, TravelLimit<double>>;
template class AnyLink<double>;
template class Link<UsualAxisJoint>;
template class Link<UsualSixAxisJoint>;
template class AxisJointOf<UsualAxisJoint>;

} // namespace ductile
