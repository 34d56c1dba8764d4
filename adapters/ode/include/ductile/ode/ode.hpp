// SPDX-License-Identifier: MIT
//
// The front door of the ODE adapter. Link ductile::ode.
#pragma once

#include "ductile/ductile.hpp"
#include "ductile/ode/divisible.hpp"
#include "ductile/ode/energy_meter.hpp"
#include "ductile/ode/held_forces.hpp"
#include "ductile/ode/joint_axes.hpp"
#include "ductile/ode/joint_constraint.hpp"
#include "ductile/ode/member.hpp"
#include "ductile/ode/member_geoms.hpp"
#include "ductile/ode/member_snapshot.hpp"
#include "ductile/ode/members.hpp"
#include "ductile/ode/motor_axis.hpp"
#include "ductile/ode/plastic_constraint.hpp"
#include "ductile/ode/plastic_hinge.hpp"
#include "ductile/ode/plastic_joint.hpp"
#include "ductile/ode/plastic_motor.hpp"
#include "ductile/ode/plastic_slider.hpp"
#include "ductile/ode/point_rows.hpp"
#include "ductile/ode/stepped_constraint.hpp"
#include "ductile/ode/structure.hpp"
#include "ductile/ode/structure_in_time.hpp"
#include "ductile/ode/thread_pool.hpp"
#include "ductile/ode/world.hpp"
