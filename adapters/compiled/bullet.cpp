// SPDX-License-Identifier: MIT
//
// What of the adapter for Bullet is compiled once (DUCTILE_COMPILED), in either precision.
#include <ductile/bullet/bullet.hpp>

#include <ductile/bullet/closing_contacts.ipp>
#include <ductile/bullet/constraint_stops.ipp>
#include <ductile/bullet/front_solver.ipp>
#include <ductile/bullet/island_solver.ipp>
#include <ductile/bullet/joint_constraint.ipp>
#include <ductile/bullet/member.ipp>
#include <ductile/bullet/member_snapshot.ipp>
#include <ductile/bullet/members.ipp>
#include <ductile/bullet/multibody_constraint.ipp>
#include <ductile/bullet/plastic_constraint.ipp>
#include <ductile/bullet/plastic_motor.ipp>
#include <ductile/bullet/structure.ipp>
#include <ductile/bullet/structure_in_time.ipp>
#include <ductile/bullet/tick_account.ipp>
#include <ductile/bullet/world.ipp>
#include <ductile/bullet/world_parts.ipp>

namespace ductile::bullet {

template class PlasticHinge<UsualAxisJoint>;
template class PlasticSlider<UsualAxisJoint>;
template class PlasticMotor<UsualAxisJoint>;
template class PlasticJoint<UsualSixAxisJoint>;

} // namespace ductile::bullet
