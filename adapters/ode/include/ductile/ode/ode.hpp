// SPDX-License-Identifier: MIT
//
// The front door of the ODE adapter: joints and the World that steps them. Members and structures
// are other doors: members.hpp, structure.hpp, structure_in_time.hpp. Link ductile::ode.
#pragma once

#include "ductile/ductile.hpp"
#include "ductile/ode/joint_axes.hpp"
#include "ductile/ode/joint_constraint.hpp"
#include "ductile/ode/motor_axis.hpp"
#include "ductile/ode/plastic_constraint.hpp"
#include "ductile/ode/plastic_hinge.hpp"
#include "ductile/ode/plastic_joint.hpp"
#include "ductile/ode/plastic_motor.hpp"
#include "ductile/ode/plastic_slider.hpp"
#include "ductile/ode/stepped_constraint.hpp"
#include "ductile/ode/thread_pool.hpp"
#include "ductile/ode/world.hpp"
