// SPDX-License-Identifier: MIT
//
// What of the adapter for ODE is compiled once (DUCTILE_COMPILED).
#include <ductile/ode/ode.hpp>

#include <ductile/ode/closing_contacts.ipp>
#include <ductile/ode/island_solver.ipp>
#include <ductile/ode/joint_constraint.ipp>
#include <ductile/ode/member.ipp>
#include <ductile/ode/member_snapshot.ipp>
#include <ductile/ode/members.ipp>
#include <ductile/ode/motor_axis.ipp>
#include <ductile/ode/own_joint.ipp>
#include <ductile/ode/plastic_motor.ipp>
#include <ductile/ode/structure.ipp>
#include <ductile/ode/structure_in_time.ipp>
#include <ductile/ode/world.ipp>
#include <ductile/ode/world_parts.ipp>

namespace ductile::ode {

template class PlasticHinge<UsualAxisJoint>;
template class PlasticSlider<UsualAxisJoint>;
template class PlasticMotor<UsualAxisJoint>;
template class PlasticJoint<UsualSixAxisJoint>;

} // namespace ductile::ode
